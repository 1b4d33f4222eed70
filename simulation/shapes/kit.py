"""What things look like: each class is built of a few coloured primitives, parametric in its size.

A recipe draws into a `Kit` in the object's own frame: width along x, depth along y, base at z = 0 and the front
towards +y. Lengths are metres. A body of the engine takes at most `MOST_PARTS` parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from coopera.simulation.shapes.rotations import matrix

MOST_PARTS = 16
"""pybullet crashes on a visual shape array of more parts (measured on 3.2.7)."""

_THIN = 5e-4
"""No part is thinner, however odd the proportions of an imported thing."""

Colour: TypeAlias = tuple[float, float, float]
Size: TypeAlias = tuple[float, float, float]
Axis: TypeAlias = Literal["x", "y", "z"]

WHITE: Colour = (0.95, 0.95, 0.94)
CREAM: Colour = (0.93, 0.89, 0.8)
BLACK: Colour = (0.09, 0.09, 0.1)
DARK: Colour = (0.24, 0.24, 0.26)
STEEL: Colour = (0.68, 0.7, 0.73)
WOOD: Colour = (0.6, 0.43, 0.27)
DARK_WOOD: Colour = (0.38, 0.25, 0.15)
GLASS: Colour = (0.7, 0.85, 0.92)
SCREEN: Colour = (0.12, 0.17, 0.26)
BLUE: Colour = (0.2, 0.4, 0.75)
GREEN: Colour = (0.25, 0.55, 0.22)
RED: Colour = (0.8, 0.17, 0.15)
YELLOW: Colour = (0.95, 0.8, 0.2)
PAPER: Colour = (0.96, 0.95, 0.9)

_TURN: dict[Axis, tuple[float, float, float, float]] = {
    "z": (0.0, 0.0, 0.0, 1.0),
    "x": (0.0, math.sin(math.pi / 4), 0.0, math.cos(math.pi / 4)),
    "y": (-math.sin(math.pi / 4), 0.0, 0.0, math.cos(math.pi / 4)),
}


class Part(NamedTuple):
    """One primitive in its object's frame.

    `half` are a box's half extents; `radius` and `length` are of the round kinds (a cylinder's or capsule's
    length runs along its own z; a capsule's does not count the caps). `orientation` is a quaternion x, y, z, w.
    """

    kind: Literal["box", "cylinder", "sphere", "capsule"]
    half: tuple[float, float, float]
    radius: float
    length: float
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    rgba: tuple[float, float, float, float]

    @property
    def around(self) -> tuple[float, float, float]:
        """Half extents of the box around it, along the axes of its object."""
        if self.kind == "box":
            half = self.half
        else:
            long = self.length / 2 + (self.radius if self.kind == "capsule" else 0.0)
            half = (self.radius, self.radius, self.radius if self.kind == "sphere" else long)
        if abs(self.orientation[3]) > 1 - 1e-9:
            return half
        x, y, z = (np.abs(matrix(self.orientation)) @ np.array(half)).tolist()
        return x, y, z


class Kit:
    """The box of bricks a recipe draws with; `w`, `d`, `h` are the object's size, `colour` its main colour."""

    def __init__(self, size: Size, colour: Colour) -> None:
        """Start an empty object."""
        self.w, self.d, self.h = size
        self.colour = colour
        self.parts: list[Part] = []

    def box(
        self,
        at: tuple[float, float, float],
        size: Size,
        colour: Colour | None = None,
        *,
        tilt: float = 0.0,
        yaw: float = 0.0,
    ) -> None:
        """Add a box by the centre of its base; `tilt` (radians) leans it about x, its top to -y; or `yaw` turns it."""
        half = (max(size[0] / 2, _THIN), max(size[1] / 2, _THIN), max(size[2] / 2, _THIN))
        turn = (math.sin(tilt / 2), 0.0, math.sin(yaw / 2), math.cos((tilt or yaw) / 2))
        middle = (at[0], at[1], at[2] + half[2])
        self._add("box", middle, turn, colour, half=half)

    def tube(
        self,
        at: tuple[float, float, float],
        radius: float,
        length: float,
        colour: Colour | None = None,
        axis: Axis = "z",
    ) -> None:
        """Add a cylinder: upright ones by the centre of their base, lying ones (axis x or y) by their centre."""
        middle = (at[0], at[1], at[2] + length / 2) if axis == "z" else at
        self._add("cylinder", middle, _TURN[axis], colour, radius=radius, length=length)

    def rod(
        self,
        at: tuple[float, float, float],
        radius: float,
        length: float,
        colour: Colour | None = None,
        axis: Axis = "z",
    ) -> None:
        """Add a capsule by its centre; `length` is from tip to tip."""
        self._add("capsule", at, _TURN[axis], colour, radius=radius, length=length - 2 * radius)

    def bar(
        self,
        first: tuple[float, float, float],
        second: tuple[float, float, float],
        radius: float,
        colour: Colour | None = None,
    ) -> None:
        """Add a capsule from one point to another that is neither before nor behind it (the same y)."""
        (x, y, z), (to_x, _, to_z) = first, second
        lean = math.atan2(to_x - x, to_z - z) / 2
        turn = (0.0, math.sin(lean), 0.0, math.cos(lean))
        middle = ((x + to_x) / 2, y, (z + to_z) / 2)
        self._add("capsule", middle, turn, colour, radius=radius, length=math.hypot(to_x - x, to_z - z))

    def ball(self, at: tuple[float, float, float], radius: float, colour: Colour | None = None) -> None:
        """Add a sphere by its centre."""
        self._add("sphere", at, _TURN["z"], colour, radius=radius)

    def legs(self, height: float, thickness: float, colour: Colour | None = None, *, inset: float = 0.0) -> None:
        """Add four square legs at the corners."""
        x, y = self.w / 2 - thickness / 2 - inset, self.d / 2 - thickness / 2 - inset
        for sx, sy in ((-x, -y), (x, -y), (-x, y), (x, y)):
            self.box((sx, sy, 0), (thickness, thickness, height), colour)

    def _add(
        self,
        kind: Literal["box", "cylinder", "sphere", "capsule"],
        position: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        colour: Colour | None,
        *,
        half: tuple[float, float, float] = (0.01, 0.01, 0.01),
        radius: float = 0.01,
        length: float = 0.01,
    ) -> None:
        radius, length = max(radius, _THIN), max(length, _THIN)
        rgba = (*(self.colour if colour is None else colour), 1.0)
        self.parts.append(Part(kind, half, radius, length, position, orientation, rgba))


Recipe: TypeAlias = Callable[[Kit], None]


def shade(colour: Colour, factor: float) -> Colour:
    """Return the colour darkened (factor < 1) or lightened (factor > 1)."""
    if factor <= 1:
        return colour[0] * factor, colour[1] * factor, colour[2] * factor
    mix = min(factor - 1, 1.0)
    red, green, blue = (channel + (1 - channel) * mix for channel in colour)
    return red, green, blue
