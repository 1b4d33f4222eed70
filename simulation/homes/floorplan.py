"""Lines and rectangles on the floor: where walls run and what they leave open."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias

PARALLEL = 0.01
"""Lines whose slopes differ by less run along each other."""
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

    @property
    def middle(self) -> Point:
        """Its middle."""
        return (self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2

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


class Block(NamedTuple):
    """A rectangle on the floor that may be turned: its middle, half its sides in its own frame, and its yaw."""

    x: float
    y: float
    half_x: float
    half_y: float
    yaw: float = 0.0


class Line(NamedTuple):
    """An endless line that is nearer to `axis` than to the other: the other coordinate is at + slope * along."""

    axis: Literal["x", "y"]
    at: float
    slope: float = 0.0

    def across(self, along: float) -> float:
        """The other coordinate of the line's point."""
        return self.at + self.slope * along if self.slope else self.at

    def aside(self, x: float, y: float) -> float:
        """How far a point lies from the line's point beside it, along the other axis."""
        return abs(y - self.across(x)) if self.axis == "x" else abs(x - self.across(y))


class Wall(NamedTuple):
    """A straight piece of wall: it runs along `axis` ("x" or "y") at `at` on the other axis.

    A slanted one begins at `at` and ends at `at + rise`; it rises by no more than it is long.
    """

    axis: Literal["x", "y"]
    at: float
    start: float
    end: float
    rise: float = 0.0

    @property
    def line(self) -> Line:
        """The line it stands on; slopes are rounded, so that pieces of one line share it."""
        if not self.rise:
            return Line(self.axis, self.at)
        slope = round(self.rise / (self.end - self.start), 4)
        return Line(self.axis, self.at - slope * self.start, slope)

    @property
    def ends(self) -> tuple[Point, Point]:
        """Where it begins and ends."""
        if self.axis == "x":
            return (self.start, self.at), (self.end, self.at + self.rise)
        return (self.at, self.start), (self.at + self.rise, self.end)

    def distance(self, x: float, y: float) -> float:
        """Distance from a point to the middle line of the wall."""
        (x0, y0), (x1, y1) = self.ends
        dx, dy = x1 - x0, y1 - y0
        share = min(max(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0), 1.0)
        return math.hypot(x0 + share * dx - x, y0 + share * dy - y)

    @property
    def bounds(self) -> Bounds:
        """The upright rectangle around what a wall covers on the floor; its ends are as long as the wall."""
        half = WALL_THICKNESS / 2
        low, high = (self.at, self.at) if not self.rise else sorted((self.at, self.at + self.rise))
        if self.axis == "x":
            return Bounds(self.start, low - half, self.end, high + half)
        return Bounds(low - half, self.start, high + half, self.end)

    @property
    def block(self) -> Block:
        """What it covers on the floor."""
        if self.rise:
            (x0, y0), (x1, y1) = self.ends
            return Block(
                (x0 + x1) / 2,
                (y0 + y1) / 2,
                math.dist((x0, y0), (x1, y1)) / 2,
                WALL_THICKNESS / 2,
                math.atan2(y1 - y0, x1 - x0),
            )
        b = self.bounds
        return Block((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, (b.x1 - b.x0) / 2, (b.y1 - b.y0) / 2)


def wall_on(line: Line, start: float, end: float) -> Wall:
    """The piece of wall on a line between two of its points."""
    if not line.slope:
        return Wall(line.axis, line.at, start, end)
    return Wall(line.axis, line.across(start), start, end, line.slope * (end - start))


def wall_between(a: Point, b: Point) -> Wall:
    """The piece of wall between two points; what is aslant by less than a millimetre is straight."""
    axis: Literal["x", "y"] = "x" if abs(b[0] - a[0]) >= abs(b[1] - a[1]) else "y"
    (start, at), (end, over) = sorted((p, q) if axis == "x" else (q, p) for p, q in (a, b))
    return Wall(axis, at, start, end, over - at if abs(over - at) >= 1e-3 else 0.0)


class Edge(NamedTuple):
    """One side of a room's floor: where its wall stands, and the unit vector that points into the room.

    `turns_in` says for the wall's start and its end whether the room goes on beyond it, around a corner.
    """

    wall: Wall
    inward: Point
    turns_in: tuple[bool, bool] = (False, False)


def edges_of(outline: Sequence[Point]) -> tuple[Edge, ...]:
    """The sides of a simple polygon, whose points go counter-clockwise."""
    count, found = len(outline), []
    for number, a in enumerate(outline):
        b = outline[(number + 1) % count]
        wall, length = wall_between(a, b), math.dist(a, b)
        inward = ((a[1] - b[1]) / length, (b[0] - a[0]) / length)
        turns = _turns_in(outline[number - 1], a, b), _turns_in(a, b, outline[(number + 2) % count])
        along = 0 if wall.axis == "x" else 1
        found.append(Edge(wall, inward, turns if a[along] < b[along] else turns[::-1]))
    return tuple(found)


def _turns_in(a: Point, b: Point, c: Point) -> bool:
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) < 0.0


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
