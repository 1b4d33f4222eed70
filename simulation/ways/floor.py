"""The free floor between the centres of a grid's cells: how much space there is, and what can be walked straight."""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter

from coopera.simulation.homes.floorplan import Point

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

CELL = 0.05
RADIUS = 0.30  # PAPER App. A uses Habitat's agents, whose radius this is
FAR = 2.0
"""Clearance is known up to this, in metres."""
_ROUNDING = 1e-9
_GALLOP = 8
_NOWHERE = 255
"""-1 as a byte."""


class Disc(NamedTuple):
    """A round obstacle, such as another agent."""

    x: float
    y: float
    radius: float = RADIUS


Discs: TypeAlias = tuple[Disc, ...]


class Floor:
    """The clearance of a grid of cells, and what follows from it."""

    def __init__(self, clear: Array, corner: Point) -> None:
        """Take the distance of each cell's centre to the nearest obstacle, and the first cell's centre."""
        self._space = clear
        self._x0, self._y0 = corner

    def clearance(self, x: float, y: float) -> float:
        """Distance from a point to the nearest obstacle, in metres up to 2."""
        return float(self._between(*self._corners(np.array([x]), np.array([y])))[0])

    def _corners(self, x: Array, y: Array) -> tuple[Array, Array, Nodes]:
        """Where points lie among the cell centres, in cells, and the number of the cell centre below each."""
        rows, columns = self._space.shape
        u = np.minimum(np.maximum((x - self._x0) / CELL, 0.0), rows - 1.001)
        v = np.minimum(np.maximum((y - self._y0) / CELL, 0.0), columns - 1.001)
        return u, v, u.astype(np.intp) * columns + v.astype(np.intp)

    def _between(self, u: Array, v: Array, corner: Nodes) -> Array:
        """Clearance between cell centres, bilinear."""
        s, t = u % 1.0, v % 1.0
        flat, columns = self._space.ravel(), self._space.shape[1]
        low = flat[corner] * (1 - s) + flat[corner + columns] * s
        high = flat[corner + 1] * (1 - s) + flat[corner + columns + 1] * s
        return np.asarray(low * (1 - t) + high * t)

    @cached_property
    def _surely(self) -> NDArray[np.int8]:
        """For each cell centre and the three after it: 1 if a body fits anywhere between them, -1 if nowhere, else 0.

        Nearly all of what is asked about the clearance between cell centres is answered by that.
        """
        lowest, highest = minimum_filter(self._space, 2, origin=-1), maximum_filter(self._space, 2, origin=-1)
        fits = np.where(lowest >= RADIUS + _ROUNDING, 1, 0)
        return np.where(highest < RADIUS - _ROUNDING, -1, fits).astype(np.int8).ravel()

    @cached_property
    def _surely_bytes(self) -> bytes:
        return self._surely.tobytes()

    def straight(self, a: Point, b: Point, avoid: Discs) -> bool:
        """Whether a body can walk straight from one point to another, clear of obstacles and of some discs."""
        dx, dy = b[0] - a[0], b[1] - a[1]
        steps = max(1, math.ceil(math.hypot(dx, dy) / (CELL / 2)))
        columns, surely_at = self._space.shape[1], self._surely_bytes
        for k in (steps // 2, steps // 4, 3 * steps // 4):  # most of what is in the way is in the middle of it
            i, j = (a[0] + dx * (k / steps) - self._x0) / CELL, (a[1] + dy * (k / steps) - self._y0) / CELL
            if surely_at[int(i) * columns + int(j)] == _NOWHERE:
                return False
        share = np.arange(steps + 1) / steps
        x, y = a[0] + dx * share, a[1] + dy * share
        u, v, corner = self._corners(x, y)
        surely = self._surely[corner]
        if int(surely.min()) < 0:
            return False
        if any((np.hypot(x - disc.x, y - disc.y) < disc.radius + RADIUS).any() for disc in avoid):
            return False
        unsure = surely == 0
        return float(self._between(u[unsure], v[unsure], corner[unsure]).min(initial=FAR)) >= RADIUS

    def pulled(self, points: list[Point], avoid: Discs) -> list[Point]:
        """Drop every corner that a straight walk can skip (greedy from the start, galloping ahead)."""
        pulled, here, last = [points[0]], 0, len(points) - 1
        while here < last:
            if self.straight(points[here], points[last], avoid):
                return [*pulled, points[last]]
            step, good = _GALLOP, here + 1
            while here + step <= last and self.straight(points[here], points[here + step], avoid):
                good = here + step
                step *= 2
            low, high = good, min(here + step, last)
            while low < high:
                middle = (low + high + 1) // 2
                if self.straight(points[here], points[middle], avoid):
                    low = middle
                else:
                    high = middle - 1
            here = low
            pulled.append(points[here])
        return pulled
