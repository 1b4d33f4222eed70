"""The bare body as a field: trunk, neck, arms and legs, by the measures of a person; and the rest pose it is made in.

At rest arms and legs are bent a little, half-way between a person who stands and one who sits, so that no joint is
ever turned far from rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from coopera.simulation.bodies.humanoid import ANKLE, SIDES, SIZE, SLICES, Frames, Side, forward
from coopera.simulation.people.fields import Array, Loft, ball, cone, join, join_all, loft
from coopera.simulation.shapes.rotations import about_x, about_y, quaternion

_ARM_OUT, _ARM_AHEAD, _ELBOW = 32.0, 16.0, 32.0
_LEG_OUT, _LEG_AHEAD, _KNEE = 7.0, 24.0, 36.0


@dataclass(frozen=True, slots=True)
class Measures:
    """What differs between bodies; 1 is usual for the three factors, the rest goes from 0 to 1."""

    girth: float = 1.0
    """Of trunk and limbs."""
    shoulders: float = 1.0
    """Width."""
    hips: float = 1.0
    """Width."""
    curves: float = 0.0
    """Bust and waist."""
    belly: float = 0.0


@lru_cache(maxsize=1)
def rest_frames() -> Frames:
    """The frames of the rest pose, the pelvis at the origin."""
    pose = np.zeros(SIZE)
    for name in ("turn", "chest", "neck", *(f"{side}_ankle" for side in SIDES)):
        pose[SLICES[name]] = (0.0, 0.0, 0.0, 1.0)
    for side in SIDES:
        sign = 1.0 if side == "left" else -1.0
        arm = about_x(sign * math.radians(_ARM_OUT)) @ about_y(-math.radians(_ARM_AHEAD))
        leg = about_x(sign * math.radians(_LEG_OUT)) @ about_y(-math.radians(_LEG_AHEAD))
        pose[SLICES[f"{side}_shoulder"]] = quaternion(arm)
        pose[SLICES[f"{side}_elbow"]] = math.radians(_ELBOW)
        pose[SLICES[f"{side}_hip"]] = quaternion(leg)
        pose[SLICES[f"{side}_knee"]] = -math.radians(_KNEE)
    return forward(pose)


def rows_scaled(rows: tuple[tuple[float, ...], ...], deep: float, wide: float) -> list[list[float]]:
    """A loft's rows with the sections made deeper and wider."""
    return [[z, x, front * deep, back * deep, side * wide] for z, x, front, back, side in rows]


_TRUNK = (
    (-0.11, -0.005, 0.060, 0.085, 0.110),
    (-0.05, -0.005, 0.092, 0.108, 0.150),
    (0.02, -0.005, 0.100, 0.108, 0.158),
    (0.09, -0.003, 0.100, 0.092, 0.147),
    (0.16, 0.000, 0.097, 0.082, 0.133),
    (0.23, 0.002, 0.098, 0.086, 0.134),
    (0.31, 0.000, 0.108, 0.100, 0.150),
    (0.38, -0.006, 0.104, 0.104, 0.160),
    (0.43, -0.014, 0.084, 0.092, 0.156),
    (0.465, -0.022, 0.062, 0.072, 0.125),
    (0.495, -0.024, 0.048, 0.056, 0.072),
)
_NECK = (
    (-0.03, -0.012, 0.052, 0.056, 0.058),
    (0.03, -0.006, 0.049, 0.052, 0.052),
    (0.08, 0.000, 0.047, 0.052, 0.049),
    (0.14, 0.005, 0.048, 0.056, 0.050),
)
_UPPER_ARM = (
    (-0.025, 0.0, 0.043, 0.045, 0.038),
    (-0.06, 0.0, 0.049, 0.049, 0.044),
    (-0.12, 0.002, 0.047, 0.045, 0.042),
    (-0.20, 0.002, 0.042, 0.041, 0.037),
    (-0.275, 0.0, 0.039, 0.038, 0.035),
)
_FOREARM = (
    (0.0, 0.0, 0.038, 0.037, 0.035),
    (-0.05, 0.0, 0.042, 0.040, 0.037),
    (-0.12, 0.0, 0.037, 0.036, 0.032),
    (-0.20, 0.0, 0.030, 0.029, 0.024),
    (-0.262, 0.0, 0.027, 0.027, 0.019),
)
_THIGH = (
    (0.03, 0.0, 0.080, 0.085, 0.078),
    (-0.05, 0.0, 0.084, 0.086, 0.080),
    (-0.15, 0.002, 0.079, 0.077, 0.074),
    (-0.30, 0.002, 0.066, 0.063, 0.061),
    (-0.42, 0.0, 0.051, 0.054, 0.052),
)
_SHIN = (
    (0.0, 0.0, 0.050, 0.052, 0.051),
    (-0.06, -0.004, 0.048, 0.056, 0.052),
    (-0.13, -0.008, 0.046, 0.060, 0.053),
    (-0.25, -0.006, 0.040, 0.046, 0.041),
    (-0.36, 0.0, 0.034, 0.036, 0.032),
    (-0.41, 0.0, 0.035, 0.038, 0.034),
)


@dataclass(frozen=True, eq=False)
class Figure:
    """A body by its measures."""

    measures: Measures

    @cached_property
    def trunk_rows(self) -> list[list[float]]:
        """The cross-sections of the trunk, for the loft and for what is worn over it."""
        size, found = self.measures, []
        for z, x, front, back, side in _TRUNK:
            up = float(np.clip((z - 0.1) / 0.28, 0.0, 1.0))
            width = size.hips + up * (size.shoulders - size.hips)
            waist = 1.0 - 0.13 * size.curves * math.exp(-(((z - 0.17) / 0.09) ** 2))
            round_ = 1.0 + (size.girth - 1.0) * (1.0 - 0.6 * float(np.clip((z - 0.36) / 0.1, 0.0, 1.0)))
            found.append([z, x, front * round_, back * (1 + 0.7 * (round_ - 1)), side * width * waist * round_])
        return found

    @cached_property
    def trunk(self) -> Loft:
        """Hips, waist and chest, in the frame of the pelvis."""
        return loft(self.trunk_rows, 2.3, (0.05, 0.03))

    @cached_property
    def limbs(self) -> dict[str, Loft]:
        """Neck, arms and legs, each in its part's frame."""
        size = self.measures
        limb = 1.0 + 0.75 * (size.girth - 1.0)
        arm = limb * (1.0 - 0.10 * size.curves)
        neck = (1.0 + 0.5 * (size.girth - 1.0)) * (1.0 - 0.12 * size.curves)
        leg = limb * (1.0 + 0.03 * size.curves)
        return {
            "neck": loft(rows_scaled(_NECK, neck, neck)),
            "shoulder": loft(rows_scaled(_UPPER_ARM, arm, arm), caps=(0.035, 0.030)),
            "elbow": loft(rows_scaled(_FOREARM, arm, arm), caps=(0.02, 0.035)),
            "hip": loft(rows_scaled(_THIGH, leg, leg), caps=(0.05, 0.06)),
            "knee": loft(rows_scaled(_SHIN, leg, leg), caps=(0.03, 0.05)),
        }

    def balls(self) -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
        """Centre and radii of what rounds the trunk: buttocks, bust and belly."""
        size = self.measures
        girth = size.girth
        found = []
        for sign in (1.0, -1.0):
            found.append(((-0.062 * girth, sign * 0.070 * size.hips, -0.035), (0.070 * girth, 0.078 * girth, 0.085)))
            if size.curves > 0.05:
                bust = 0.030 + 0.030 * size.curves
                found.append(((0.070 * girth, sign * 0.068, 0.335), (bust + 0.012, 0.056 * girth, 0.054)))
        if size.belly > 0.05:
            deep = 0.07 + 0.075 * size.belly
            found.append(((0.035, 0.0, 0.10), (deep * girth, 0.128 * girth, 0.135)))
        return found


class Near:
    """Points, and how far they are from the parts of a figure; each is worked out when it is first asked for."""

    def __init__(self, figure: Figure, points: Array, *, hems: bool = True) -> None:
        """Look at points of the rest pose; without `hems` nothing that is worn comes to an end."""
        self.figure, self.points, self._hems = figure, points, hems
        self._local: dict[str, Array] = {}
        self._known: dict[str, Array] = {}

    def local(self, part: str) -> Array:
        """The points in a part's own frame."""
        if part not in self._local:
            rest = rest_frames()
            self._local[part] = (self.points - rest.place[part]) @ rest.turn[part]
        return self._local[part]

    def cut(self, worn: Array, end: Array) -> Array:
        """What is worn, where `end` is negative."""
        return np.maximum(worn, end) if self._hems else worn

    def _once(self, name: str, value: Array) -> Array:
        self._known[name] = value
        return value

    @property
    def trunk(self) -> Array:
        """Hips, waist and chest."""
        if "trunk" in self._known:
            return self._known["trunk"]
        found = join(self.figure.trunk.at(self.points), self.girdle, 0.05)
        for centre, radii in self.figure.balls():
            found = join(found, ball(self.points, centre, radii), 0.05)
        return self._once("trunk", found)

    @property
    def girdle(self) -> Array:
        """From the neck to both shoulders."""
        if "girdle" not in self._known:
            size = self.figure.measures
            thick = 0.046 * (1 + 0.5 * (size.girth - 1)) * (1 - 0.08 * size.curves)
            half = np.column_stack((self.points[:, 0], np.abs(self.points[:, 1]), self.points[:, 2]))
            ends = ((-0.022, 0.03, 0.482), (-0.024, 0.152 * size.shoulders, 0.446))
            self._once("girdle", cone(half, ends, (thick, 0.92 * thick)))
        return self._known["girdle"]

    @property
    def neck(self) -> Array:
        """The neck."""
        if "neck" not in self._known:
            self._once("neck", self.figure.limbs["neck"].at(self.local("neck")))
        return self._known["neck"]

    def limb(self, side: Side, part: str) -> Array:
        """One of shoulder (the upper arm), elbow (the forearm), hip (the thigh) and knee (the shin)."""
        name = f"{side}_{part}"
        if name not in self._known:
            points = self.local(name)
            if side == "right":
                points = points * np.array((1.0, -1.0, 1.0))
            self._once(name, self.figure.limbs[part].at(points))
        return self._known[name]

    def arm(self, side: Side) -> Array:
        """Upper arm and forearm."""
        return self._limbs(f"{side}_arm", lambda: join(self.limb(side, "shoulder"), self.limb(side, "elbow"), 0.02))

    def leg(self, side: Side) -> Array:
        """Thigh and shin."""
        return self._limbs(f"{side}_leg", lambda: join(self.limb(side, "hip"), self.limb(side, "knee"), 0.02))

    @property
    def arms(self) -> Array:
        """Both arms."""
        return self._limbs("arms", lambda: np.minimum(self.arm("left"), self.arm("right")))

    @property
    def legs(self) -> Array:
        """Both legs."""
        return self._limbs("legs", lambda: join(self.leg("left"), self.leg("right"), 0.012))

    def _limbs(self, name: str, find: Callable[[], Array]) -> Array:
        if name not in self._known:
            self._known[name] = find()
        return self._known[name]

    @property
    def body(self) -> Array:
        """All of the bare body but head, hands and feet."""
        if "body" not in self._known:
            self._once("body", join_all([join(self.trunk, self.neck, 0.05), self.arms, self.legs], 0.05))
        return self._known["body"]

    def sole(self, side: Side) -> Array:
        """Height above the ground on which a foot stands."""
        return self.local(f"{side}_ankle")[:, 2] + ANKLE
