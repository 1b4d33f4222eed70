"""A robot's arm on its base: forward kinematics of a chain of joints, and postures that reach for a point.

Frames: x forward, y to the left, z up, the origin on the floor under the base's middle; metres and radians.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal, NamedTuple

import numpy as np

from coopera.core.randomness import rng_at
from coopera.simulation.shapes.rotations import Array, about_x, about_y, about_z, wrapped

_TURNS = {"x": about_x, "y": about_y, "z": about_z}
_ARRIVED = 0.005
_RESTARTS = 12
_STEPS, _SETTLED = 60, 40
_STRIDE = 0.25
_REMEMBERED = 256


class Joint(NamedTuple):
    """One joint: its frame in that of the joint before it (an offset, then a turn about x), its axis and limits."""

    name: str
    origin: tuple[float, float, float]
    axis: Literal["x", "y", "z"]
    low: float
    high: float
    roll: float = 0.0
    slides: bool = False


class Gripper(NamedTuple):
    """Where the gripper's middle is, how it is turned, the Jacobian (3, n), and the joints' places (n, 3)."""

    place: Array
    turn: Array
    jacobian: Array
    joints: Array


@dataclass(frozen=True)
class Chain:
    """Joints from the base to the gripper, and the point between its fingers in the last joint's frame.

    Attributes:
        joints: In order from the base.
        tip: The gripper's middle in the last joint's frame.
        pan: Index of the joint that turns the arm to the side, and where its axis stands (x, in the body frame).
        lift: How far the first joint, where it slides, is raised for a point at a height of 0 (usually negative).
    """

    joints: tuple[Joint, ...]
    tip: tuple[float, float, float]
    pan: tuple[int, float]
    lift: float = 0.0

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
    def _fixed(self) -> list[tuple[Array, Array | None, int]]:
        """Of each joint: its offset, the turn before it (None where there is none), and the index of its axis."""
        return [(np.array(j.origin), about_x(j.roll) if j.roll else None, "xyz".index(j.axis)) for j in self.joints]

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
        for joint, (origin, before, axis), value in zip(self.joints, self._fixed, posture.tolist(), strict=False):
            place = place + turn @ origin
            if before is not None:
                turn = turn @ before
            starts.append(place)
            axes.append(turn[:, axis])
            if joint.slides:
                place = place + turn[:, axis] * value
            else:
                turn = turn @ _TURNS[joint.axis](value)
        end = place + turn @ np.array(self.tip)
        at, along = np.array(starts), np.array(axes)
        jacobian = _cross(along, end - at).T
        for i, joint in enumerate(self.joints):
            if joint.slides:
                jacobian[:, i] = along[i]
        return Gripper(end, turn, jacobian, at)

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
        start, (turning, axis_x) = rest.copy(), self.pan
        side = wrapped(math.atan2(float(target[1]), float(target[0]) - axis_x))
        start[turning] = min(max(side, self.low[turning]), self.high[turning])
        if self.joints[0].slides:
            start[0] = min(max(float(target[2]) + self.lift, self.low[0]), self.high[0])
        for _ in range(_RESTARTS):
            found = self._arrive(start.tobytes(), target.tobytes(), rest.tobytes())
            if found is not None:
                yield found
            start = rng.uniform(self.low, self.high)


def _cross(a: Array, b: Array) -> Array:
    """Row-wise cross product of (n, 3) arrays; numpy's own spends most of its time on looking at axes."""
    found: Array = np.empty_like(a)
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        found[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return found
