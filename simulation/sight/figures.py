"""People and robots as a scenery shows them: each posture becomes triangles in the world."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.drawing.geometry import Mesh
from coopera.simulation.drawing.materials import Material
from coopera.simulation.drawing.robots import links_of
from coopera.simulation.drawing.scenery import Scenery
from coopera.simulation.people.appearance import Appearance, Outfit
from coopera.simulation.people.paints import PAINTS, painted
from coopera.simulation.people.palettes import Colour
from coopera.simulation.people.skin import MATERIALS, Skin, posed, skinned
from coopera.simulation.shapes.rotations import about_z, matrix
from coopera.simulation.sight.engine import pybullet

_MADE_OF = {
    "skin": Material.SKIN,
    "hair": Material.HAIR,
    "cloth": Material.CLOTH,
    "shoe": Material.PLAIN,
    "eye": Material.PLAIN,
    "glasses": Material.GLASS,
}


class Person:
    """One person in a scenery."""

    def __init__(self, scenery: Scenery, agent: AgentId, body: int) -> None:
        """Bring a person in, out of sight."""
        self._scenery, self._agent, self._body = scenery, agent, body
        self._skin: Skin | None = None
        self._placed: tuple[Any, ...] = ()

    def put(self, person: Placed, looks: Appearance, outfit: Outfit = "day") -> None:
        """Show the person in a posture, as somebody, and in clothes."""
        skin = skinned(looks, outfit)
        placed = (person.x, person.y, person.yaw, person.pose.tobytes(), id(skin))
        if placed == self._placed:
            return
        if skin is not self._skin:
            self._scenery.remove(self._agent)
            self._scenery.add(self._agent, _mesh(skin), self._body, "person", closed=looks.model is None)
            self._skin = skin
        vertices, normals = posed(skin, forward(person.pose))
        turn = about_z(person.yaw).astype(np.float32).T
        place = np.array((person.x, person.y, 0.0), dtype=np.float32)
        self._scenery.shape(self._agent, vertices @ turn + place, normals @ turn)
        self._placed = placed


def _mesh(skin: Skin) -> Mesh:
    made = np.array([_MADE_OF[name] for name in MATERIALS], dtype=np.uint8)
    uv = np.stack((skin.vertices[:, 2], skin.vertices[:, 0] + skin.vertices[:, 1]), axis=1)
    return Mesh(skin.vertices, skin.normals, uv, skin.colours, made[skin.material], skin.faces)


class Balls:
    """One person as pybullet draws people: of balls and rods, in their own colours."""

    def __init__(self, body: int, client: int) -> None:
        """Take a person's body."""
        self._body, self._client = body, client
        materials = {colour: name for name, colour in PAINTS.items()}
        shapes: dict[int, int] = {}
        self._paints: list[tuple[int, int, str]] = []
        for shape in pybullet.getVisualShapeData(body, physicsClientId=client):
            link, colour = shape[1], tuple(round(value, 2) for value in shape[7][:3])
            number = shapes[link] = shapes.get(link, -1) + 1
            self._paints.append((link, number, materials[colour]))
        self._painted: dict[str, Colour] = {}

    def put(self, looks: Appearance, outfit: Outfit = "day") -> None:
        """Show the person as somebody and in clothes; pybullet has their posture."""
        paints = painted(looks, outfit)
        if paints == self._painted:
            return
        for link, number, material in self._paints:
            colour = [*paints[material], 1.0]
            pybullet.changeVisualShape(self._body, link, number, rgbaColor=colour, physicsClientId=self._client)
        self._painted = paints


class Robot:
    """One robot in a scenery; its links are where pybullet has them."""

    def __init__(self, scenery: Scenery, agent: AgentId, body: int, client: int, looks: RobotBody) -> None:
        """Bring a robot in, out of sight."""
        self._scenery, self._agent, self._body, self._client = scenery, agent, body, client
        joints = range(pybullet.getNumJoints(body, physicsClientId=client))
        links = {pybullet.getJointInfo(body, i, physicsClientId=client)[12].decode(): i for i in joints}
        self._links: list[tuple[str, int]] = []
        for link, mesh in links_of(looks.urdf).items():
            name = f"{agent}/{link}"
            scenery.add(name, mesh, body, "robot", closed=False)
            self._links.append((name, links.get(link, -1)))

    def put(self, robot: Placed) -> None:
        """Show the robot where its joints have been set to be."""
        count = pybullet.getNumJoints(self._body, physicsClientId=self._client)
        states = pybullet.getLinkStates(
            self._body, list(range(count)), computeForwardKinematics=1, physicsClientId=self._client
        )
        base = ((robot.x, robot.y, 0.0), (0.0, 0.0, math.sin(robot.yaw / 2), math.cos(robot.yaw / 2)))
        for name, link in self._links:
            place, turn = base if link < 0 else states[link][4:6]
            self._scenery.put(name, place, matrix(turn))
