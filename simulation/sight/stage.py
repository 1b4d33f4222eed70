"""The pybullet side of a home: bodies are put where the truth says, rays are cast, pictures are taken.

Nothing here is truth: poses go in and are never read back. One stage is one pybullet client (DIRECT, no window).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import ConfigError
from coopera.core.household import AgentId, plain
from coopera.simulation.sight.engine import load_urdf, pybullet, quiet, start_renderer  # isort: split

from coopera.simulation.acts.plans import Placed
from coopera.simulation.acts.workplace import thing_of
from coopera.simulation.bodies.humanoid import JOINTS, SLICES
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.bodies.urdf import read_urdf
from coopera.simulation.drawing.context import Renderer, chosen
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.renderer import Renderer as Drawer
from coopera.simulation.drawing.renderer import bodies_of
from coopera.simulation.drawing.view import View
from coopera.simulation.homes.magic_box import Point3, Shape, shape_of
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.holding import held_at
from coopera.simulation.motions.worn import worn_at
from coopera.simulation.people.appearance import Appearance, Outfit, appearance_of
from coopera.simulation.shapes.rotations import Array, about_z, matrix, quaternion
from coopera.simulation.sight.build import build, staged  # after the engine: who imports pybullet first makes it print
from coopera.simulation.sight.doors import OPEN, Doors
from coopera.simulation.sight.figures import Balls, Person, Robot
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stances import Held
from coopera.simulation.state.home_state import HomeState, ThingState

BODIES = Path(__file__).parents[1] / "bodies"
_AWAY = (0.0, 0.0, -50.0)
_KEPT = 8
_NEAR, _FAR = 0.05, 30.0
Image = NDArray[np.uint8]
__all__ = ["Camera", "Image", "Stage"]


class Stage:
    """All bodies of a home in one pybullet client; `close` it after use."""

    def __init__(
        self,
        scene: Scene,
        people: Sequence[AgentId],
        robots: Mapping[AgentId, RobotBody],
        renderer: Renderer | None = "auto",
        looks: Mapping[AgentId, Appearance] | None = None,
    ) -> None:
        """Build the home, its people and its robots: about 0.3 s, or 0.05 s without a renderer, for rays alone.

        `looks` says how people look, and may change; who is not in it looks as the id has it.
        """
        self.scene, self.robots = scene, robots
        name = None if renderer is None else chosen(renderer)
        self.client: int = pybullet.connect(pybullet.DIRECT)
        self.renderer = None if name is None else start_renderer(name, self.client)
        drawn = name in ("tiny", "egl")
        self.home = build(scene, self.client, drawn=drawn)
        self.bodies = {who: load_urdf(read_urdf(BODIES / "person.urdf"), self.client, drawn=drawn) for who in people}
        self.bodies |= {agent: load_urdf(body.urdf, self.client, drawn=drawn) for agent, body in robots.items()}
        names = dict.fromkeys(people, [name for name, _ in JOINTS])
        names |= {agent: list(body.joints) for agent, body in robots.items()}
        self._joints = {agent: self._joints_of(body, names[agent]) for agent, body in self.bodies.items()}
        self.drawer: Drawer | None = None
        """Our own renderer, where that is the one."""
        self._people: dict[AgentId, Person] = {}
        self._balls: dict[AgentId, Balls] = {}
        self._figures: dict[AgentId, Robot] = {}
        self._looks = {} if looks is None else looks
        self._can_draw = self._draws = name is not None
        if drawn:
            self._balls = {agent: Balls(self.bodies[agent], self.client) for agent in people}
        if name == "gl":
            scenery = staged(self.home, scene)
            self._people = {agent: Person(scenery, agent, self.bodies[agent]) for agent in people}
            self._figures = {
                agent: Robot(scenery, agent, self.bodies[agent], self.client, body) for agent, body in robots.items()
            }
            self.drawer = Drawer(scenery)
        self._shown: dict[str, ThingState] = {
            thing.name: ThingState(position=thing.position, yaw=thing.yaw, on=thing.on) for thing in scene.movable
        }
        self._box: dict[str, Shape] = {}
        self._carried: set[str] = set()
        self._unused: set[str] = set()
        self._doors = Doors(scene, self.home, robots)

    def close(self) -> None:
        """Give the client back; a second time does nothing."""
        if self.drawer is not None:
            self.drawer.close()
            self.drawer = None
        if self.client >= 0:
            with quiet():
                pybullet.disconnect(self.client)
            self.client = -1

    def _joints_of(self, body: int, names: Sequence[str]) -> list[int]:
        count = pybullet.getNumJoints(body, physicsClientId=self.client)
        known = {pybullet.getJointInfo(body, i, physicsClientId=self.client)[1].decode(): i for i in range(count)}
        return [known[name] for name in names]

    def show(self, state: HomeState, moment: Moment, *, for_rays: bool = False) -> None:
        """Put everything where it is at a moment, or where pictures show it, if this stage draws and not for rays."""
        self._draws = self._can_draw and not for_rays
        bodies = {**moment.bodies, **(moment.drawn if self._draws else {})}
        for agent, placed in bodies.items():
            if agent in self.robots:
                self._put_robot(agent, placed)
            else:
                self._put_person(agent, placed)
            if self._draws:
                self._show_body(moment, agent, placed)
        self._unused, self._carried = self._carried, set()
        held = {held.name for held in moment.held.values()}
        self._things(state, moment, held.union(*moment.worn.values()))
        for agent, placed in bodies.items():
            if agent in moment.held:
                self._carry(state, moment.held[agent], agent, placed)
            for name in moment.worn.get(agent, ()):
                self._wear(state, name, placed)
        for name in sorted(self._unused - self._carried):
            self.home.move(name, _AWAY, 0.0)
        if not for_rays:
            self._doors.show(moment.opened, bodies)

    def _show_body(self, moment: Moment, agent: AgentId, placed: Placed) -> None:
        """Draw a person or a robot where they have been put."""
        if agent in self._people:
            self._people[agent].put(placed, *self._dressed(moment, agent))
        elif agent in self._balls:
            self._balls[agent].put(*self._dressed(moment, agent))
        elif agent in self._figures:
            self._figures[agent].put(placed)

    def _dressed(self, moment: Moment, agent: AgentId) -> tuple[Appearance, Outfit]:
        """How a person looks, and what they wear."""
        return self._looks.get(agent) or appearance_of("", agent), moment.outfits.get(agent, "day")

    def _things(self, state: HomeState, moment: Moment, with_people: set[str]) -> None:
        """Put down all that nobody has: the things of the scene, and those out of the magic box.

        What is in a hand but not shown there is out of sight, and so is what is inside a thing that is carried.
        """
        borne = {name for body in state.agents.values() for name in (body.thing, *body.worn) if name}
        borne = borne - {*moment.moved} | with_people
        for thing in state.objects(self.scene):
            name = thing.name
            where = moment.moved.get(name) or (None if name in borne else state.thing(thing))
            if where is not None and (where.inside in borne or (self._draws and name in moment.unseen)):
                where = None
            if name in with_people or (name in state.box and where is None):
                continue
            if where is None:
                self._shown.pop(name, None)
                self.home.move(name, _AWAY, 0.0)
            elif name in state.box:
                self.home.move(self._body(state, name)[0], where.position, where.yaw)
            elif self._shown.get(name) != where:
                self.home.move(name, where.position, where.yaw)
                self._shown[name] = where

    def _wear(self, state: HomeState, name: str, placed: Placed) -> None:
        """Show a hat or headphones on the head; other clothes are not shown, neither on the body nor elsewhere."""
        thing = thing_of(self.scene, state, name)
        worn = worn_at(placed.pose, _looks(state, thing), thing.size)
        if worn is not None:
            self._attach(self._body(state, name)[0], placed, *worn)
        elif name in self.home.bodies:
            self.home.move(name, _AWAY, 0.0)
            self._shown.pop(name, None)

    def _put_person(self, agent: AgentId, person: Placed) -> None:
        heading = about_z(person.yaw)
        place = heading @ person.pose[SLICES["place"]] + np.array((person.x, person.y, 0.0))
        turn = quaternion(heading @ matrix(person.pose[SLICES["turn"]]))
        body = self.bodies[agent]
        pybullet.resetBasePositionAndOrientation(body, place.tolist(), turn, physicsClientId=self.client)
        pybullet.resetJointStatesMultiDof(
            body,
            self._joints[agent],
            [person.pose[SLICES[name]].tolist() for name, _ in JOINTS],
            physicsClientId=self.client,
        )

    def _put_robot(self, agent: AgentId, robot: Placed) -> None:
        turn = (0.0, 0.0, math.sin(robot.yaw / 2), math.cos(robot.yaw / 2))
        body = self.bodies[agent]
        pybullet.resetBasePositionAndOrientation(body, (robot.x, robot.y, 0.0), turn, physicsClientId=self.client)
        pybullet.resetJointStatesMultiDof(
            body, self._joints[agent], [[float(v)] for v in robot.pose], physicsClientId=self.client
        )

    def _carry(self, state: HomeState, held: Held, agent: AgentId, placed: Placed) -> None:
        """Attach a thing to a hand or the gripper: it just follows."""
        name, size = self._body(state, held.name)
        if agent in self.robots:
            self._attach(name, placed, *self._in_gripper(agent, placed, size))
            return
        drawn = held.drawn if self._draws else None
        grip = held.grip if drawn is None else drawn.grip
        if grip is None:
            self.home.move(name, _AWAY, 0.0)
        else:
            self._attach(name, placed, *held_at(placed.pose, size, grip))
        for aid in (*held.aids, *(drawn.props if drawn else ())):
            name, size = self._body(state, f"{agent} {aid.thing}")
            self._attach(name, placed, *held_at(placed.pose, size, aid.grip))

    def _attach(self, name: str, placed: Placed, place: Array, turn: Array) -> None:
        heading = about_z(placed.yaw)
        at = heading @ place + np.array((placed.x, placed.y, 0.0))
        self.home.move_to(name, (float(at[0]), float(at[1]), float(at[2])), quaternion(heading @ turn))

    def _in_gripper(self, agent: AgentId, robot: Placed, size: Point3) -> tuple[Array, Array]:
        place = self.robots[agent].gripper(robot.pose).place
        return place - np.array((0.0, 0.0, min(0.6 * size[2], 0.5 * size[2] + 0.03))), np.eye(3)

    def _body(self, state: HomeState, name: str) -> tuple[str, Point3]:
        """The body of a thing, by its name, to be put somewhere at once; those of the magic box are made when needed.

        The newest few of the magic box are kept.
        """
        thing = self.scene.object(name)
        if thing is not None and name not in state.box:
            self._shown.pop(name, None)
            return name, thing.size
        known = state.box.get(name)
        shape = shape_of(known.text if known else plain(name))
        if self._box.get(name) != shape:
            self._forget(name)
            self.home.add(name, shape.cls, shape.size, shape.rgb)
            self._box[name] = shape
            for old in [one for one in self._box if one not in self._carried and one != name][:-_KEPT]:
                self._forget(old)
        self._carried.add(name)
        return name, shape.size

    def _forget(self, name: str) -> None:
        if self._box.pop(name, None) is not None:
            self._unused.discard(name)
            self.home.remove(name)

    def hide(self, names: Sequence[str]) -> None:
        """Move furniture out of the way of rays; `unhide` brings it back."""
        for name in names:
            self.home.move(name, _AWAY, 0.0)

    def unhide(self, names: Sequence[str]) -> None:
        """Put hidden furniture back."""
        for name in names:
            thing = self.scene.object(name)
            if thing is not None:
                self.home.move(name, thing.position, thing.yaw)

    def small(self, body: int) -> bool:
        """Whether a body is a thing that can be carried, of the home or from the magic box."""
        name = self.home.names.get(body, "")
        thing = self.scene.object(name)
        return name in self._carried or (thing is not None and not thing.fixed)

    def rays(self, starts: Array, ends: Array) -> NDArray[np.int64]:
        """Body that each ray hits first, -1 for none; starts and ends have shape (n, 3)."""
        hits: list[int] = []
        batch = 64  # of a large one each ray takes pybullet several times as long
        for i in range(0, len(starts), batch):
            found = pybullet.rayTestBatch(
                starts[i : i + batch].tolist(), ends[i : i + batch].tolist(), physicsClientId=self.client
            )
            hits += [hit[0] for hit in found]
        return np.array(hits, dtype=np.int64)

    def colours(self, camera: Camera, size: tuple[int, int]) -> Image:
        """The colours of a picture alone, (height, width, 3)."""
        return self.picture(camera, size)[0] if self.drawer is None else self.drawer.draw(camera, size).colour

    def view(self, camera: Camera, size: tuple[int, int]) -> View:
        """All that a camera sees, as data.

        Raises:
            ConfigError: If this stage has another renderer than our own.
        """
        if self.drawer is None:
            raise ConfigError("renderer: depth and segmentation are drawn by gl alone.")
        names = {body: name for name, body in self.home.rooms.items()}
        names |= {body: name.partition(OPEN)[0] for name, body in self.home.bodies.items()}
        names |= {body: str(agent) for agent, body in self.bodies.items()}
        return self.drawer.view(camera, size, names)

    def picture(self, camera: Camera, size: tuple[int, int]) -> tuple[Image, NDArray[np.int64]]:
        """Render; Tiny and EGL draw no shadows.

        Returns:
            Colours (height, width, 3) and the body seen in each pixel (height, width), -1 for none.
        """
        if self.drawer is not None:
            drawn = self.drawer.draw(camera, size, tags=True)
            return drawn.colour, bodies_of(drawn.tags)
        width, height = size
        view = pybullet.computeViewMatrix(camera.eye, camera.target, (0.0, 0.0, 1.0))
        lens = pybullet.computeProjectionMatrixFOV(camera.fov, width / height, _NEAR, _FAR)
        with nullcontext() if self.renderer == pybullet.ER_TINY_RENDERER else quiet():
            _, _, colours, _, mask = pybullet.getCameraImage(
                width,
                height,
                view,
                lens,
                shadow=0,
                lightDirection=(2.0, -3.0, 6.0),
                renderer=self.renderer,
                physicsClientId=self.client,
            )
        image: Image = np.asarray(colours, dtype=np.uint8).reshape(height, width, 4)[:, :, :3]
        return image, np.asarray(mask, dtype=np.int64).reshape(height, width)


def _looks(state: HomeState, thing: SceneObject) -> str:
    """The class that a thing looks like."""
    known = state.box.get(thing.name)
    return thing.cls if known is None else shape_of(known.text).cls
