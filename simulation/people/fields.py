"""Fields of signed distances, about: lofts, ellipsoids and round cones, and how they are joined smoothly.

Joins are polynomial smooth minima (I. Quilez, "Smooth minimum", 2013). Points have shape (N, 3), distances (N,).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Field: TypeAlias = Callable[[Array], Array]

_SAMPLES = 96


def join(a: Array, b: Array, width: float) -> Array:
    """The union of two fields, blended where they differ by less than `width` (metres)."""
    share = np.maximum(width - np.abs(a - b), 0.0) / width
    found: Array = np.minimum(a, b) - share * share * (width / 4)
    return found


def join_all(fields: Sequence[Array], width: float) -> Array:
    """The union of several fields, one after the other."""
    found = fields[0]
    for other in fields[1:]:
        found = join(found, other, width)
    return found


def within(a: Array, b: Array) -> Array:
    """What is in both fields, with a sharp edge."""
    found: Array = np.maximum(a, b)
    return found


def carve(a: Array, b: Array, width: float) -> Array:
    """What is left of `a` outside `b`, with a rounded edge."""
    return -join(-a, b, width)


def ball(points: Array, centre: Sequence[float], radii: Sequence[float]) -> Array:
    """An ellipsoid; the distance is exact on it and near enough around."""
    away = (points - np.asarray(centre)) / np.asarray(radii)
    size, steep = _length(away), _length(away / np.asarray(radii))
    found: Array = size * (size - 1.0) / np.maximum(steep, 1e-9)
    return found


def cone(points: Array, ends: tuple[Sequence[float], Sequence[float]], radii: tuple[float, float]) -> Array:
    """A rod with round ends that tapers."""
    first, last = np.asarray(ends[0], dtype=float), np.asarray(ends[1], dtype=float)
    line = last - first
    share = np.clip((points - first) @ line / float(line @ line), 0.0, 1.0)
    away = points - first - share[:, None] * line
    found: Array = _length(away) - (radii[0] + share * (radii[1] - radii[0]))
    return found


def _length(vectors: Array) -> Array:
    """Lengths of vectors (N, 3); numpy's own sum over three takes several times as long."""
    x, y, z = vectors.T
    found: Array = np.sqrt(x * x + y * y + z * z)
    return found


@dataclass(frozen=True, eq=False)
class Loft:
    """Cross-sections along z, joined smoothly: half-ovals that are `front` deep ahead, `back` behind and `side` wide.

    `knots` are rows of (z, x of the middle, front, back, side), z rising; `power` 2 is an oval, more is squarer. The
    ends are rounded by `caps` (metres).
    """

    knots: Array
    power: float = 2.0
    caps: tuple[float, float] = (0.03, 0.03)

    @cached_property
    def table(self) -> Array:
        """The cross-sections at evenly spaced heights, as columns: shape (5, n)."""
        from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 - heavy, and a run without pictures draws none

        heights = np.linspace(self.knots[0, 0], self.knots[-1, 0], _SAMPLES)
        found: Array = np.vstack((heights, PchipInterpolator(self.knots[:, 0], self.knots[:, 1:])(heights).T))
        return found

    def at(self, points: Array) -> Array:
        """The distances of points from it."""
        table = self.table
        low, high = table[0, 0], table[0, -1]
        where = np.clip((points[:, 2] - low) / (high - low), 0.0, 1.0) * (_SAMPLES - 1)
        first = np.minimum(where.astype(np.intp), _SAMPLES - 2)
        share = where - first
        under, over = table[1:].take(first, axis=1), table[1:].take(first + 1, axis=1)
        middle, front, back, side = under * (1 - share) + over * share
        ahead = points[:, 0] - middle
        deep = np.where(ahead > 0, front, back)
        x, y = np.abs(ahead) / deep, np.abs(points[:, 1]) / side
        across = x * x + y * y if self.power == 2 else (x**self.power + y**self.power) ** (2 / self.power)
        below, above = np.maximum(low - points[:, 2], 0.0), np.maximum(points[:, 2] - high, 0.0)
        beyond, end = below + above, below / self.caps[0] + above / self.caps[1]
        across = np.sqrt(across + end * end)
        away = np.sqrt(ahead * ahead + points[:, 1] ** 2 + beyond * beyond)
        found: Array = np.where(across > 1e-3, away - away / np.maximum(across, 1e-3), -np.minimum(deep, side))
        return found


def loft(rows: Sequence[Sequence[float]], power: float = 2.0, caps: tuple[float, float] = (0.03, 0.03)) -> Loft:
    """A loft of rows as its knots are."""
    return Loft(np.array(sorted(rows, key=lambda row: row[0]), dtype=float), power, caps)


def slopes(field: Field, points: Array, step: float = 0.002) -> Array:
    """The field's slopes at points (N, 3), by differences at the corners of a tetrahedron."""
    corners = np.array(((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)), dtype=float)
    count = len(points)
    values = field((points[None] + step * corners[:, None]).reshape(-1, 3)).reshape(4, count)
    found: Array = np.einsum("kn,kj->nj", values, corners) / (4 * step)
    return found
