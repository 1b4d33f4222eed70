"""A mobile base with an arm, a camera and a gripper, as its description and a file of a few lines have it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coopera.simulation.bodies.arm import Chain, Gripper
from coopera.simulation.bodies.urdf import Urdf
from coopera.simulation.shapes.rotations import Array, about_z


@dataclass(frozen=True, eq=False)
class Eye:
    """A camera at the end of a chain that may have a joint to turn it aside and one to tilt it.

    Attributes:
        chain: From the base to the camera; the camera looks along x of the last frame.
        of: Of each of its joints the number in a posture.
        pan: Index in the chain of the joint that turns it aside; None where it cannot.
        tilt: Index of the joint that tilts it.
    """

    chain: Chain
    of: tuple[int, ...]
    pan: int | None
    tilt: int | None

    def camera(self, posture: Array) -> tuple[Array, Array]:
        """Its place and viewing direction in the body's frame."""
        at = self.chain.forward(posture[list(self.of)])
        return at.place, at.turn[:, 0]

    def look_at(self, posture: Array, target: Array) -> Array:
        """The posture with the camera turned towards a point, within its limits, as if all its axes met."""
        looking, low, high = posture.copy(), self.chain.low, self.chain.high
        ahead = posture[list(self.of)]
        for one in (self.pan, self.tilt):
            if one is not None:
                ahead[one] = 0.0
        at = self.chain.forward(ahead)
        x, y, z = at.turn[:, 0].tolist()
        heading, flat = math.atan2(y, x), math.hypot(x, y)
        neck = at.joints[self.tilt] if self.pan is None and self.tilt is not None else at.place
        neck = neck if self.pan is None else at.joints[self.pan]
        line = target - neck
        if self.pan is not None:
            side = self._way(at, self.pan, about_z(heading)[:, 2]) * (math.atan2(line[1], line[0]) - heading)
            looking[self.of[self.pan]] = _within(side, low[self.pan], high[self.pan])
        if self.tilt is not None:
            out = (at.joints[self.tilt] - neck) @ about_z(heading)[:, 0]
            away = max(math.hypot(float(line[0]), float(line[1])) - float(out), 0.05)
            drop = float(at.place[2] - neck[2]) - float(line[2])
            down = math.atan2(drop, away) - math.atan2(-z, flat)
            down *= self._way(at, self.tilt, about_z(heading)[:, 1])
            looking[self.of[self.tilt]] = _within(down, low[self.tilt], high[self.tilt])
        return looking

    def _way(self, at: Gripper, joint: int, about: Array) -> float:
        """1 if a joint turns about an axis, -1 if the other way round."""
        return 1.0 if float(at.axes[joint] @ about) >= 0.0 else -1.0


def _within(angle: float, low: float, high: float) -> float:
    """An angle within limits; a turn more or less where that brings it there."""
    for turned in (angle, angle - math.tau, angle + math.tau):
        if low <= turned <= high:
            return turned
    return float(min(max(angle, low), high))


@dataclass(frozen=True, eq=False)
class MobileManipulator:
    """A `RobotBody` given by a description: a chain to the gripper, a camera, postures.

    Attributes:
        name: What a configuration calls it.
        about: What it is, in a line.
        urdf: Its shapes.
        chain: From the base to the gripper.
        shoulder: Index of the joint at which the arm proper begins.
        eye: The camera.
        joints: Names of all joints that a posture sets: the chain's first.
        reaching: The arm raised in front: where each reach starts.
        tucked: Arm folded over the base.
        carrying: Gripper beside the body with a thing in it.
        farthest: Largest horizontal distance from the base's middle at which anything is tried for.
        side: Where it works best: a heading in the body's frame, 0 straight ahead.
    """

    name: str
    about: str
    urdf: Urdf
    chain: Chain
    shoulder: int
    eye: Eye
    joints: tuple[str, ...]
    reaching: Array
    tucked: Array
    carrying: Array
    farthest: float
    side: float = 0.0

    @cached_property
    def _arm(self) -> int:
        return len(self.chain.joints)

    def reach(self, target: Array) -> Iterator[Array]:
        """Yield postures that put the gripper within 5 mm of a point, the most comfortable first."""
        if math.hypot(float(target[0]), float(target[1])) > self.farthest or not 0.0 < float(target[2]) < 2.0:
            return
        rest = self.reaching[: self._arm]
        for found in self.chain.reach(target, rest):
            yield np.concatenate((found, self.reaching[self._arm :]))

    def gripper(self, posture: Array) -> Gripper:
        """Where the gripper and the arm's joints are."""
        return self.chain.forward(posture)

    def arm(self, posture: Array) -> Array:
        """Points along the arm from the shoulder to the gripper, at most 15 cm apart; shape (n, 3)."""
        at = self.chain.forward(posture)
        corners = np.concatenate((at.joints[self.shoulder :], at.place[None]))
        points = [corners[0]]
        for a, b in zip(corners, corners[1:], strict=False):
            count = max(1, math.ceil(math.sqrt(float((b - a) @ (b - a))) / 0.15))
            points += [a + (b - a) * k / count for k in range(1, count + 1)]
        return np.array(points)

    def camera(self, posture: Array) -> tuple[Array, Array]:
        """The camera's place and viewing direction in the body frame."""
        return self.eye.camera(posture)

    def look_at(self, posture: Array, target: Array) -> Array:
        """The posture with the camera turned towards a point, within its limits."""
        return self.eye.look_at(posture, target)
