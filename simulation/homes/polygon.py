"""The floor of a room that is no rectangle: a simple polygon. What is asked of it is answered by shapely."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from coopera.simulation.homes.floorplan import Bounds, Point

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_STRIP = 0.1
"""A slanted edge is covered by upright rectangles of this width, in metres."""
_SPECK = 1e-6


def tidy(points: Sequence[Point]) -> list[Point]:
    """Points of a polygon counter-clockwise, without repeated ones and those on a straight side."""
    ring = [(float(x), float(y)) for x, y in points]
    ring = [point for number, point in enumerate(ring) if point != ring[number - 1]] or ring[:1]
    if sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*ring, ring[0]])) < 0:
        ring.reverse()
    return [b for a, b, c in zip([ring[-1], *ring], ring, [*ring[1:], ring[0]], strict=False) if not _straight(a, b, c)]


def _straight(a: Point, b: Point, c: Point) -> bool:
    """Whether a corner is none: the way goes on in the same direction."""
    (ux, uy), (vx, vy) = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    return abs(ux * vy - uy * vx) < _SPECK and ux * vx + uy * vy > 0


def fault(points: Sequence[Point]) -> str:
    """What is wrong with a polygon, or nothing."""
    if len(points) < 3:
        return "has fewer than three corners"
    shape = shapely.Polygon(points)
    if shape.is_valid:
        return ""
    what, _, where = shapely.is_valid_reason(shape).partition("[")
    crosses = what.strip() in ("Self-intersection", "Ring Self-intersection")
    return f"crosses or touches itself at ({', '.join(where.rstrip(']').split())})" if crosses else "encloses nothing"


class Polygon:
    """A simple polygon on the floor, in metres."""

    def __init__(self, points: Sequence[Point]) -> None:
        """Take its corners."""
        self._shape = shapely.Polygon(points)
        shapely.prepare(self._shape)

    @property
    def area(self) -> float:
        """In square metres."""
        return float(self._shape.area)

    @property
    def centre(self) -> Point:
        """The point farthest from all edges, to the centimetre."""
        middle = shapely.maximum_inscribed_circle(self._shape, tolerance=0.01).coords[0]
        return round(middle[0], 3), round(middle[1], 3)

    def depth(self, x: Array, y: Array) -> Array:
        """Distance of each point within it to its edge; 0 outside; any shape in, same out."""
        found: Array = shapely.distance(self._shape.exterior, shapely.points(x, y))
        return np.where(self.covers(x, y), found, 0.0)

    def away(self, x: Array, y: Array) -> Array:
        """Distance of each point; 0 inside; any shape in, same out."""
        found: Array = shapely.distance(self._shape, shapely.points(x, y))
        return found

    def covers(self, x: Array, y: Array, inset: float = 0.0) -> Mask:
        """Which points lie in it, its edge included, at least `inset` metres from the edge; any shape in, same out."""
        found: Mask = shapely.intersects_xy(self._inset(inset), x, y)
        return found

    def encloses(self, bounds: Bounds, slack: float = 0.0) -> bool:
        """Whether a rectangle lies within it, or sticks out by no more than `slack` metres."""
        return bool(self._inset(-slack).covers(shapely.box(*bounds)))

    def overlaps(self, other: Polygon, margin: float) -> bool:
        """Whether they share more than a strip of `margin` metres."""
        return bool(self._inset(margin / 2).intersects(other._inset(margin / 2)))

    def corners(self, inset: float) -> list[Point]:
        """The corners of what lies at least `inset` metres from the edge."""
        parts = [part for part in shapely.get_parts(self._inset(inset)) if not part.is_empty]
        return [point for part in parts for point in part.exterior.coords[:-1]]

    def rectangles(self) -> list[Bounds]:
        """Upright rectangles that cover it: exactly, but at slanted edges."""
        return _rectangles(self._shape)

    def outside(self, around: Bounds) -> list[Bounds]:
        """Upright rectangles that cover what of a rectangle lies outside."""
        return _rectangles(shapely.box(*around).difference(self._shape))

    def triangles(self, cell: float) -> Array:
        """Triangles that cover it exactly, none wider than a cell of a raster; shape (n, 3, 2), counter-clockwise."""
        x0, y0, x1, y1 = self._shape.bounds
        xs, ys = (np.linspace(low, high, int(np.ceil((high - low) / cell)) + 1) for low, high in ((x0, x1), (y0, y1)))
        cells = [shapely.box(a, c, b, d) for a, b in pairwise(xs) for c, d in pairwise(ys)]
        pieces = shapely.get_parts(shapely.intersection(self._shape, cells))
        pieces = pieces[shapely.area(pieces) > _SPECK]
        found = shapely.get_parts(shapely.constrained_delaunay_triangles(pieces))
        corners = shapely.get_coordinates(found).reshape(-1, 4, 2)[:, :3]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        clockwise = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
        corners[clockwise] = corners[clockwise, ::-1]
        return np.asarray(corners)

    def _inset(self, by: float) -> Any:
        with np.errstate(all="ignore"):  # GEOS divides by 0 where two sides nearly run along each other
            return self._shape.buffer(-by, join_style="mitre") if by else self._shape


def _rectangles(shape: Any) -> list[Bounds]:
    points = shapely.get_coordinates(shape)
    if not len(points):
        return []
    stops = sorted(set(points[:, 0].tolist()))
    found: list[Bounds] = []
    for a, b in pairwise(stops):
        slice_ = _parts(shape, a, b)
        slanted = any(not np.isclose(part.area, shapely.box(*part.bounds).area) for part in slice_)
        count = max(1, int(np.ceil((b - a) / _STRIP))) if slanted else 1
        strips = [_parts(shape, *span) for span in pairwise(np.linspace(a, b, count + 1))] if slanted else [slice_]
        for part in (part for strip in strips for part in strip):
            one = Bounds(*part.bounds)
            before = next(
                (k for k, was in enumerate(found) if (was.x1, was.y0, was.y1) == (one.x0, one.y0, one.y1)), -1
            )
            if before < 0:
                found.append(one)
            else:
                found[before] = found[before]._replace(x1=one.x1)
    return found


def _parts(shape: Any, start: float, end: float) -> list[Any]:
    """The connected parts of a shape between two places on the x axis."""
    _, low, _, high = shape.bounds
    cut = shapely.get_parts(shape.intersection(shapely.box(start, low - 1, end, high + 1)))
    return [part for part in cut if part.area > _SPECK]
