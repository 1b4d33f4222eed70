"""Lines and rectangles on the floor: where walls run and what they leave open."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple, TypeAlias

TOUCH = 0.02
"""Rooms whose edges lie within this distance share a wall."""
WALL_THICKNESS = 0.10

Point: TypeAlias = tuple[float, float]


class Bounds(NamedTuple):
    """An axis-aligned rectangle on the floor."""

    x0: float
    y0: float
    x1: float
    y1: float

    def distance(self, x: float, y: float) -> float:
        """Distance from a point to the rectangle; 0 inside."""
        return math.hypot(max(self.x0 - x, 0.0, x - self.x1), max(self.y0 - y, 0.0, y - self.y1))

    def gap(self, other: Bounds) -> float:
        """Distance between the two rectangles; 0 where they touch or overlap."""
        x = max(self.x0 - other.x1, other.x0 - self.x1, 0.0)
        return math.hypot(x, max(self.y0 - other.y1, other.y0 - self.y1, 0.0))

    def overlaps(self, other: Bounds, margin: float = 0.0) -> bool:
        """Whether the two rectangles come nearer than `margin` in both axes (touching is no overlap at 0)."""
        return (
            self.x0 < other.x1 + margin
            and other.x0 < self.x1 + margin
            and self.y0 < other.y1 + margin
            and other.y0 < self.y1 + margin
        )

    def encloses(self, other: Bounds, slack: float = 0.0) -> bool:
        """Whether the other rectangle lies within this one, or sticks out by no more than `slack` metres."""
        return (
            other.x0 >= self.x0 - slack
            and other.y0 >= self.y0 - slack
            and other.x1 <= self.x1 + slack
            and other.y1 <= self.y1 + slack
        )

    def grown(self, by: float) -> Bounds:
        """The rectangle with each side moved outwards by `by`."""
        return Bounds(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)


class Wall(NamedTuple):
    """A straight piece of wall: it runs along `axis` ("x" or "y") at `at` on the other axis."""

    axis: Literal["x", "y"]
    at: float
    start: float
    end: float

    @property
    def bounds(self) -> Bounds:
        """The rectangle a wall covers on the floor; its ends are as long as the wall."""
        half = WALL_THICKNESS / 2
        if self.axis == "x":
            return Bounds(self.start, self.at - half, self.end, self.at + half)
        return Bounds(self.at - half, self.start, self.at + half, self.end)


def merge(spans: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Join the stretches of one line that meet; the result is sorted."""
    merged: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if merged and start <= merged[-1][1] + TOUCH:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return merged


def cut(spans: list[tuple[float, float]], gaps: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Take gaps out of the stretches of one line; splinters are dropped."""
    for left, right in gaps:
        spans = [
            piece
            for start, end in spans
            for piece in ((start, min(end, left)), (max(start, right), end))
            if piece[1] - piece[0] > TOUCH
        ]
    return spans
