"""A robot's arm on its base: forward kinematics of a chain of joints, and postures that reach for a point.

Frames: x forward, y to the left, z up, the origin on the floor under the base's middle; metres and radians.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from coopera.core.randomness import rng_at
from coopera.simulation.bodies.urdf import Hinge
from coopera.simulation.shapes.rotations import Array, about_x, about_y, about_z, wrapped

_TURNS = (about_x, about_y, about_z)
_ARRIVED = 0.005
_RESTARTS = 12
_STEPS, _SETTLED = 60, 40
_STRIDE = 0.25
_REMEMBERED = 256


class Joint(NamedTuple):
    """One joint that moves: its frame in that of the joint before it (an offset, then a turn), its axis and limits.

    The turn is None where there is none; the axis, of length 1, is in the joint's own frame.
    """

    name: str
    origin: Array
    turn: Array | None
    axis: Array
    low: float
    high: float
    slides: bool = False


class Gripper(NamedTuple):
    """Where the gripper's middle is, how it is turned, the Jacobian (3, n), and the joints' places and axes (n, 3)."""

    place: Array
    turn: Array
    jacobian: Array
    joints: Array
    axes: Array


@dataclass(frozen=True, eq=False)
class Chain:
    """Joints from the base to the gripper, and the point between its fingers in the last joint's frame.

    Attributes:
        joints: In order from the base.
        tip: The gripper's middle in the last joint's frame.
        end: How the gripper's frame is turned there; None where it is not.
        pan: Index of the joint that turns the arm to the side, None if none does, and where its axis stands (x, y).
        lift: How far the first joint, where it slides, is raised for a point at a height of 0; None: as far as the
            resting posture would have to be.
    """

    joints: tuple[Joint, ...]
    tip: Array
    end: Array | None = None
    pan: tuple[int | None, float, float] = (None, 0.0, 0.0)
    lift: float | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Go to another process without what was remembered."""
        return type(self), (self.joints, self.tip, self.end, self.pan, self.lift)

    @cached_property
    def low(self) -> Array:
        """Lower limits."""
        return np.array([joint.low for joint in self.joints])

    @cached_property
    def high(self) -> Array:
        """Upper limits."""
        return np.array([joint.high for joint in self.joints])

    @cached_property
    def _weights(self) -> Array:
        return np.array([0.2 if joint.slides else 1.0 for joint in self.joints])

    @cached_property
    def _axes(self) -> list[tuple[int | None, float, Callable[[float], Array]]]:
        """Of each joint: the index of its axis (None if it is oblique), which way it points, and its turns."""
        found: list[tuple[int | None, float, Callable[[float], Array]]] = []
        for joint in self.joints:
            one = int(np.abs(joint.axis).argmax())
            straight = np.count_nonzero(joint.axis) == 1
            found.append((one, float(joint.axis[one]), _TURNS[one]) if straight else (None, 1.0, _about(joint.axis)))
        return found

    @cached_property
    def _arrive(self) -> Callable[[bytes, bytes, bytes], Array | None]:
        """Where `servo` ends, by its arguments: who hands over ten things does so from the same place."""

        def work_out(start: bytes, target: bytes, rest: bytes) -> Array | None:
            way = self.servo(np.frombuffer(start), np.frombuffer(target), np.frombuffer(rest))
            return None if way is None else way[-1]

        return lru_cache(maxsize=_REMEMBERED)(work_out)

    def forward(self, posture: Array) -> Gripper:
        """Place the gripper; only the chain's own joints of the posture matter."""
        place, turn = np.zeros(3), np.eye(3)
        starts, axes = [], []
        for joint, (axis, way, about), value in zip(self.joints, self._axes, posture.tolist(), strict=False):
            place = place + turn @ joint.origin
            if joint.turn is not None:
                turn = turn @ joint.turn
            along = turn @ joint.axis if axis is None else way * turn[:, axis]
            starts.append(place)
            axes.append(along)
            if joint.slides:
                place = place + along * value
            else:
                turn = turn @ about(way * value)
        end = place + turn @ self.tip
        turn = turn if self.end is None else turn @ self.end
        at, along = np.array(starts), np.array(axes)
        jacobian = _cross(along, end - at).T
        for i, joint in enumerate(self.joints):
            if joint.slides:
                jacobian[:, i] = along[i]
        return Gripper(end, turn, jacobian, at, along)

    def servo(self, start: Array, target: Array, rest: Array, stride: float = _STRIDE) -> list[Array] | None:
        """Move the gripper to a point in Cartesian steps, drawn towards a resting posture in the null space.

        Args:
            start: The posture to start from (the chain's joints).
            target: The point.
            rest: A comfortable posture (the chain's joints).
            stride: Longest step of the gripper, in metres.

        Returns:
            The postures of all steps, the last within 5 mm of the point and all within the joints' limits; None if
            the arm gets stuck on the way.
        """
        posture, way = start.copy(), [start]
        most = _STEPS if stride >= _STRIDE else math.ceil(2.5 / stride)
        for step in range(most):
            at = self.forward(posture)
            error = target - at.place
            distance = math.sqrt(float(error @ error))
            if distance < _ARRIVED:
                return way
            jacobian = at.jacobian * self._weights
            inverse = jacobian.T @ np.linalg.inv(jacobian @ jacobian.T + 1e-3 * np.eye(3))
            drawn = (rest - posture) * (0.05 if step < most - _STEPS + _SETTLED else 0.0)
            move = inverse @ (error * min(1.0, stride / distance)) + drawn - inverse @ (jacobian @ drawn)
            move = np.minimum(np.maximum(move * self._weights, -0.35), 0.35)
            posture = np.minimum(np.maximum(posture + move, self.low), self.high)
            way.append(posture)
        return None

    def reach(self, target: Array, rest: Array) -> Iterator[Array]:
        """Yield postures that put the gripper within 5 mm of a point, each from another start.

        The first start is the resting posture turned towards the point, the others are random but follow from the
        point alone: the same point always gives the same postures.
        """
        rng = rng_at(0, "arm", self.joints[-1].name, *(round(float(value), 3) for value in target))
        start = self.start(target, rest)
        for _ in range(_RESTARTS):
            found = self._arrive(start.tobytes(), target.tobytes(), rest.tobytes())
            if found is not None:
                yield found
            start = rng.uniform(self.low, self.high)

    def start(self, target: Array, rest: Array) -> Array:
        """The resting posture, turned and raised to a point."""
        start, (turning, x, y) = rest.copy(), self.pan
        at_rest = self._at_rest(rest.tobytes())
        if turning is not None:
            way = self._axes[turning][1]
            ahead = round(math.atan2(float(at_rest[1]) - y, float(at_rest[0]) - x), 9)
            side = wrapped(math.atan2(float(target[1]) - y, float(target[0]) - x) - ahead)
            start[turning] = min(max(rest[turning] + way * side, self.low[turning]), self.high[turning])
        if self.joints[0].slides:
            lift = rest[0] - at_rest[2] if self.lift is None else self.lift
            start[0] = min(max(float(target[2]) + lift, self.low[0]), self.high[0])
        return start

    @cached_property
    def _at_rest(self) -> Callable[[bytes], Array]:
        """Where the gripper is in a resting posture: there are few of them."""
        return lru_cache(maxsize=_REMEMBERED)(lambda rest: self.forward(np.frombuffer(rest)).place)


def chain_of(
    hinges: Sequence[Hinge], moving: Sequence[str], offset: Sequence[float] = (0.0, 0.0, 0.0)
) -> tuple[tuple[Joint, ...], Array, Array | None]:
    """Those joints of a way through a description that move, the others being fixed where they are at 0.

    Args:
        hinges: The way from the base to a link.
        moving: Names of joints on it.
        offset: A point in the link's frame.

    Returns:
        The joints, the point in the last one's frame, and how the link is turned there (None where it is not).
    """
    joints: list[Joint] = []
    place, turn = np.zeros(3), None
    for hinge in hinges:
        place = place + (hinge.place if turn is None else turn @ hinge.place)
        turn = hinge.turn if turn is None else turn if hinge.turn is None else turn @ hinge.turn
        if hinge.name in moving:
            slides = hinge.kind == "prismatic"
            joints.append(Joint(hinge.name, place, turn, hinge.axis, hinge.low, hinge.high, slides))
            place, turn = np.zeros(3), None
    tip = place + (np.array(offset) if turn is None else turn @ np.array(offset))
    return tuple(joints), tip, turn


def _about(axis: Array) -> Callable[[float], Array]:
    """Turns about an oblique axis, as Rodrigues has them."""
    x, y, z = axis.tolist()
    cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    return lambda angle: np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)


def _cross(a: Array, b: Array) -> Array:
    """Row-wise cross product of (n, 3) arrays; numpy's own spends most of its time on looking at axes."""
    found: Array = np.empty_like(a)
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        found[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return found
