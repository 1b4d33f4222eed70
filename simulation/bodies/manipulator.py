"""A mobile base with an arm, a head camera and two fingers, given by its measures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from coopera.simulation.bodies.arm import Chain, Gripper
from coopera.simulation.shapes.rotations import Array, about_y, about_z


@dataclass(frozen=True)
class Head:
    """A camera on a pan and a tilt joint: offsets from the base (`lifted`: from the arm's lift), pan, and tilt."""

    pan: tuple[float, float, float]
    tilt: tuple[float, float, float]
    camera: tuple[float, float, float]
    lifted: bool
    pan_limit: float = 1.57
    tilt_limits: tuple[float, float] = (-0.76, 1.45)


@dataclass(frozen=True, eq=False)
class MobileManipulator:
    """A `RobotBody` given by measures: a chain, a head, two fingers.

    Attributes:
        name: What a configuration calls it.
        about: What it is, in a line.
        urdf: Its shapes.
        chain: From the base to the gripper.
        shoulder: Index of the joint at which the arm proper begins.
        head: Pan, tilt, camera; its joints are "head_pan" and "head_tilt".
        fingers: Names of the finger joints.
        reaching: The arm raised in front (chain, head, fingers): where each reach starts.
        tucked: Arm folded over the base.
        carrying: Gripper beside the body with a thing in it.
        farthest: Largest horizontal distance from the base's middle at which anything is tried for.
    """

    name: str
    about: str
    urdf: Path
    chain: Chain
    shoulder: int
    head: Head
    fingers: tuple[str, str]
    reaching: Array
    tucked: Array
    carrying: Array
    farthest: float

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """The chain's joints, the head's, the fingers'."""
        return (*(joint.name for joint in self.chain.joints), "head_pan", "head_tilt", *self.fingers)

    @property
    def _pan(self) -> int:
        return len(self.chain.joints)

    def reach(self, target: Array) -> Iterator[Array]:
        """Yield postures that put the gripper within 5 mm of a point, the most comfortable first."""
        if math.hypot(float(target[0]), float(target[1])) > self.farthest or not 0.0 < float(target[2]) < 2.0:
            return
        rest = self.reaching[: self._pan]
        for found in self.chain.reach(target, rest):
            yield np.concatenate((found, self.reaching[self._pan :]))

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

    def _neck(self, posture: Array) -> Array:
        base = np.array(self.head.pan)
        return base + np.array((0.0, 0.0, float(posture[0]))) if self.head.lifted else base

    def camera(self, posture: Array) -> tuple[Array, Array]:
        """The head camera's place and viewing direction in the body frame."""
        pan = about_z(float(posture[self._pan]))
        head = pan @ about_y(float(posture[self._pan + 1]))
        place = self._neck(posture) + pan @ np.array(self.head.tilt) + head @ np.array(self.head.camera)
        return place, head[:, 0]

    def look_at(self, posture: Array, target: Array) -> Array:
        """Turn the head towards a point, within its limits."""
        looking, limit, (low, high) = posture.copy(), self.head.pan_limit, self.head.tilt_limits
        line = target - self._neck(posture)
        looking[self._pan] = min(max(math.atan2(float(line[1]), float(line[0])), -limit), limit)
        drop = self.head.tilt[2] + self.head.camera[2] - float(line[2])
        flat = max(math.hypot(float(line[0]), float(line[1])) - self.head.tilt[0], 0.05)
        looking[self._pan + 1] = min(max(math.atan2(drop, flat), low), high)
        return looking
