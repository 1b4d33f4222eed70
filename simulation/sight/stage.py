"""The pybullet side of a home: bodies are put where the truth says, rays are cast, pictures are taken.

Nothing here is truth: poses go in and are never read back. One stage is one pybullet client (DIRECT, no window).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.household import AgentId
from coopera.simulation.sight.engine import Renderer, load_urdf, pybullet, quiet, start_renderer  # isort: split

from coopera.simulation.acts.plans import Placed
from coopera.simulation.acts.state import HomeState, ThingState
from coopera.simulation.bodies.humanoid import JOINTS, SLICES, Frames, forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.magic_box import Point3, Shape, shape_of
from coopera.simulation.homes.scene import Scene
from coopera.simulation.shapes.rotations import Array, about_z, matrix, quaternion
from coopera.simulation.sight.build import build  # after the engine: whoever imports pybullet first makes it print
from coopera.simulation.sight.recording import Held, Moment

BODIES = Path(__file__).parents[1] / "bodies"
_FAR_BELOW = -50.0
_KEPT = 8
_THIN = 0.08
_TOOL = 0.17
_LONG = 0.7
_FINE = 0.125
_BULKY = 0.35
_NEAR, _FAR = 0.05, 30.0
Image = NDArray[np.uint8]


class Camera(NamedTuple):
    """Where a camera is, what it looks at, and its vertical field of view in degrees."""

    eye: Point3
    target: Point3
    fov: float = 58.0


class Stage:
    """All bodies of a home in one pybullet client; `close` it after use."""

    def __init__(
        self,
        scene: Scene,
        people: Sequence[AgentId],
        robots: Mapping[AgentId, RobotBody],
        renderer: Renderer | None = "tiny",
    ) -> None:
        """Build the home, its people and its robots: about 0.3 s, or 0.05 s without a renderer, for rays alone."""
        self.scene, self.robots = scene, robots
        self.client: int = pybullet.connect(pybullet.DIRECT)
        self.renderer = None if renderer is None else start_renderer(renderer, self.client)
        drawn = renderer is not None
        self.home = build(scene, self.client, drawn=drawn)
        self.bodies = {agent: load_urdf(BODIES / "person.urdf", self.client, drawn=drawn) for agent in people}
        self.bodies |= {agent: load_urdf(body.urdf, self.client, drawn=drawn) for agent, body in robots.items()}
        names = dict.fromkeys(people, [name for name, _ in JOINTS])
        names |= {agent: list(body.joints) for agent, body in robots.items()}
        self._joints = {agent: self._joints_of(body, names[agent]) for agent, body in self.bodies.items()}
        self._shown: dict[str, ThingState] = {
            thing.name: ThingState(position=thing.position, yaw=thing.yaw, on=thing.on) for thing in scene.movable
        }
        self._box: dict[str, Shape] = {}
        self._carried: set[str] = set()

    def close(self) -> None:
        """Give the client back; a second time does nothing."""
        if self.client >= 0:
            with quiet():
                pybullet.disconnect(self.client)
            self.client = -1

    def _joints_of(self, body: int, names: Sequence[str]) -> list[int]:
        count = pybullet.getNumJoints(body, physicsClientId=self.client)
        known = {pybullet.getJointInfo(body, i, physicsClientId=self.client)[1].decode(): i for i in range(count)}
        return [known[name] for name in names]

    def show(self, state: HomeState, moment: Moment) -> None:
        """Put everything where it is at a moment."""
        self._things(state, moment)
        for agent, placed in moment.bodies.items():
            if agent in self.robots:
                self._put_robot(agent, placed)
            else:
                self._put_person(agent, placed)
        for name in sorted(self._carried):
            self.home.move(name, (0.0, 0.0, _FAR_BELOW), 0.0)
        self._carried.clear()
        for agent, placed in moment.bodies.items():
            if agent in moment.held:
                self._carry(state, agent, moment.held[agent], placed)

    def _things(self, state: HomeState, moment: Moment) -> None:
        for thing in self.scene.movable:
            where = moment.moved.get(thing.name) or state.thing(thing)
            if self._shown.get(thing.name) != where:
                self.home.move(thing.name, where.position, where.yaw)
                self._shown[thing.name] = where

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

    def _carry(self, state: HomeState, agent: AgentId, held: Held, placed: Placed) -> None:
        """Attach a thing to a hand or the gripper: it just follows."""
        initial = state.find(self.scene, held.name)
        if initial is not None and held.name not in state.box:
            name, size = held.name, initial.size
            self._shown.pop(name, None)
        else:
            known = state.box.get(held.name)
            name, size = self._from_box(known.text if known else held.name)
            self._carried.add(name)
        place, turn = self._in_gripper(agent, placed, size) if agent in self.robots else _in_hand(placed, held, size)
        heading = about_z(placed.yaw)
        at = heading @ place + np.array((placed.x, placed.y, 0.0))
        self.home.move_to(name, (float(at[0]), float(at[1]), float(at[2])), quaternion(heading @ turn))

    def _in_gripper(self, agent: AgentId, robot: Placed, size: Point3) -> tuple[Array, Array]:
        place = self.robots[agent].gripper(robot.pose).place
        return place - np.array((0.0, 0.0, min(0.6 * size[2], 0.5 * size[2] + 0.03))), np.eye(3)

    def _from_box(self, text: str) -> tuple[str, Point3]:
        """A body of a thing from the magic box that nobody holds yet; the newest few are kept."""
        shape = shape_of(text)
        name, number = f"box:{shape.cls}", 1
        while name in self._carried:
            number += 1
            name = f"box:{shape.cls}:{number}"
        if name not in self._box:
            unused = [known for known in self._box if known not in self._carried]
            if len(self._box) >= _KEPT and unused:
                del self._box[unused[0]]
                self.home.remove(unused[0])
            self.home.add(name, shape.cls, shape.size, shape.rgb)
            self._box[name] = shape
        return name, self._box[name].size

    def hide(self, names: Sequence[str]) -> None:
        """Move furniture out of the way of rays; `unhide` brings it back."""
        for name in names:
            self.home.move(name, (0.0, 0.0, _FAR_BELOW), 0.0)

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
        batch = 8192  # pybullet takes at most 16384 rays at once
        for i in range(0, len(starts), batch):
            found = pybullet.rayTestBatch(
                starts[i : i + batch].tolist(), ends[i : i + batch].tolist(), physicsClientId=self.client
            )
            hits += [hit[0] for hit in found]
        return np.array(hits, dtype=np.int64)

    def picture(self, camera: Camera, size: tuple[int, int]) -> tuple[Image, NDArray[np.int64]]:
        """Render without shadows.

        Returns:
            Colours (height, width, 3) and the body seen in each pixel (height, width), -1 for none.
        """
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


def _in_hand(person: Placed, held: Held, size: Point3) -> tuple[Array, Array]:
    """Place and turn of a held thing in the body frame."""
    frames = forward(person.pose)
    right, left = frames.place["right_hand"], frames.place["left_hand"]
    ahead = np.array(((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))  # the thing's front away from the body
    if held.hold == "floor" and size[0] > _LONG:
        return _long_tool(right, left, size)
    if held.hold == "beside" and max(size) > _BULKY:
        return np.array((0.0, -0.75, 0.0)), ahead
    if held.hold == "head":
        return frames.point("head", 0.0, 0.0, 0.11 - 0.5 * size[2]), frames.turn["head"] @ ahead
    if held.hold == "surface" and max(size[:2]) > _TOOL:
        return _on_surface((right + left) / 2, size)
    if held.hold == "both":
        if size[0] > _LONG:
            return _across(right, left, size)
        return _before_eyes(frames, (right + left) / 2, size) if size[2] < _THIN else _between(right, left, size)
    if held.hold != "left" and size[0] > 1.7 * size[1] and size[2] < _FINE:
        return _handled(frames, size)
    hand = left if held.hold == "left" else right
    lower = min(0.6 * size[2], 0.5 * size[2] + 0.03)
    return hand + np.array((0.02 + 0.3 * min(size[1], 0.1), 0.0, -lower)), ahead


def _between(right: Array, left: Array, size: Point3) -> tuple[Array, Array]:
    """A bulky thing between the two hands; a long one points from the right hand past the left."""
    line = left - right
    if size[2] > 0.6 and float(line @ line) > 0.05:
        up = line / math.sqrt(float(line @ line))
        front = np.array((1.0, 0.0, 0.0)) - up * up[0]
        front /= math.sqrt(float(front @ front))
        turn = np.stack((np.cross(front, up), front, up), axis=1)
        return right - up * 0.22 * size[2], turn
    turn = np.array(((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    return (right + left) / 2 + np.array((0.03, 0.0, -0.5 * size[2])), turn


def _across(right: Array, left: Array, size: Point3) -> tuple[Array, Array]:
    """A long thing held like a guitar: its thick end (-x) at the right hand, its top away from the body."""
    across = left - right
    across = across / math.sqrt(float(across @ across))
    top = np.array((1.0, 0.0, 0.0)) - across * across[0]
    top = top / math.sqrt(float(top @ top))
    turn = np.stack((across, np.cross(top, across), top), axis=1)
    return right + across * (0.5 * size[0] - 0.5 * size[1]) - top * 0.6 * size[2], turn


def _handled(frames: Frames, size: Point3) -> tuple[Array, Array]:
    """A tool held at its handle (+x): a thin one goes on where the forearm points, a pan stays level."""
    arm = frames.turn["right_hand"] @ np.array((0.0, 0.0, -1.0))
    if size[1] > _FINE:
        arm = np.array((1.0, 0.0, 0.0))
    up = np.array((0.0, 0.0, 1.0)) if abs(float(arm[2])) < 0.95 else np.array((1.0, 0.0, 0.0))
    up = up - arm * float(up @ arm)
    up = up / math.sqrt(float(up @ up))
    turn = np.stack((-arm, np.cross(up, -arm), up), axis=1)
    return frames.place["right_hand"] + arm * (0.5 * size[0] - 0.07) - up * 0.5 * size[2], turn


def _on_surface(hands: Array, size: Point3) -> tuple[Array, Array]:
    """A thing that lies where the hands work, its front towards the person."""
    turn = np.array(((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    return np.array((float(hands[0]) + 0.02, 0.0, max(float(hands[2]) - 0.06 - min(size[2], 0.08) / 2, 0.0))), turn


def _before_eyes(frames: Frames, middle: Array, size: Point3) -> tuple[Array, Array]:
    """A thin thing held up between both hands, its top towards the face."""
    up = frames.place["head"] - middle
    up = up / math.sqrt(float(up @ up))
    across = np.array((0.0, 1.0, 0.0)) - up * up[1]
    across = across / math.sqrt(float(across @ across))
    turn = np.stack((across, np.cross(up, across), up), axis=1)
    return middle + 0.03 * up, turn


def _long_tool(right: Array, left: Array, size: Point3) -> tuple[Array, Array]:
    """A broom from both hands down to the floor in front; the end at -x sweeps."""
    low, high = (right, left) if right[2] < left[2] else (left, right)
    slope = (low - high) / max(float(high[2] - low[2]), 0.05)
    foot = low + slope * float(low[2])
    foot = np.array((min(max(float(foot[0]), 0.35), 0.9), float(foot[1]), 0.0))
    up = (high - foot) / math.sqrt(float((high - foot) @ (high - foot)))
    across = np.array((0.0, 1.0, 0.0)) - up * up[1]
    across = across / math.sqrt(float(across @ across))
    return foot + up * 0.5 * size[0], np.stack((up, across, np.cross(up, across)), axis=1)
