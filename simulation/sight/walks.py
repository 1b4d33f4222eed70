"""Walks as they are filmed: the place and the heading after a distance, the pose of the legs, and what lies between."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import SLICES
from coopera.simulation.bodies.humanoid_reach import carrying
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.motions.poses import clip
from coopera.simulation.shapes.rotations import Array, smooth, wrapped

_ARMS = ("right_shoulder", "right_elbow")


class Track(NamedTuple):
    """A walk as a function of the distance gone: corner points and where each lies along the way."""

    points: list[Point]
    marks: list[float]

    @classmethod
    def along(cls, points: list[Point]) -> Track:
        """Measure a walk."""
        marks = [0.0]
        for a, b in zip(points, points[1:], strict=False):
            marks.append(marks[-1] + math.dist(a, b))
        return cls(points, marks)

    def at(self, gone: float) -> Point:
        """The place after a distance."""
        gone = min(max(gone, 0.0), self.marks[-1])
        for i in range(1, len(self.marks)):
            if gone <= self.marks[i] and self.marks[i] > self.marks[i - 1]:
                share = (gone - self.marks[i - 1]) / (self.marks[i] - self.marks[i - 1])
                (ax, ay), (bx, by) = self.points[i - 1], self.points[i]
                return ax + share * (bx - ax), ay + share * (by - ay)
        return self.points[-1]

    def heading(self, gone: float) -> float | None:
        """The direction of the walk, looking a little ahead; None for a walk of no length."""
        total = self.marks[-1]
        if total < 1e-6:
            return None
        back, ahead = self.at(min(gone, total - 0.02) - 0.1), self.at(min(gone, total - 0.02) + 0.2)
        return math.atan2(ahead[1] - back[1], ahead[0] - back[0])


def walking(gone: float, carries: bool) -> Array:
    """The pose after walking a distance: the shipped walk, with the right arm in front if it carries a thing."""
    walk = clip("walk")
    pose = walk.at(gone / walk.travel * walk.seconds).copy()
    if carries:
        arm = carrying()
        for name in _ARMS:
            pose[SLICES[name]] = arm[SLICES[name]]
    return pose


def mixed(first: Array, second: Array, share: float) -> Array:
    """A robot's posture between two others."""
    return first + share * (second - first)


def between_bodies(first: Placed, second: Placed, share: float, mix: Callable[[Array, Array, float], Array]) -> Placed:
    """Ease from one placed body to another."""
    share = smooth(share)
    turn = wrapped(second.yaw - first.yaw)
    pose = mix(first.pose, second.pose, share)
    x, y = (1 - share) * np.array(first[:2]) + share * np.array(second[:2])
    return Placed(float(x), float(y), first.yaw + share * turn, pose)
