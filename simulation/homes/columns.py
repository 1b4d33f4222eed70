"""A mesh seen along upright lines: at which heights each line of a raster meets it, and what is free above."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.homes.glb import Array, Indices, Mesh

Mask = NDArray[np.bool_]

FLAT = 0.9
"""What is steeper than 25 degrees (the upward part of its normal is less than this) carries nothing."""
_LINES = 64  # along the longer side
_FINEST, _COARSEST = 0.008, 0.08  # metres between lines
_SAME = 1e-3
_MOST_PAIRS = 500_000  # of a line and a triangle, looked at together
_MOST_IN_ALL = 2_000_000


class Raster(NamedTuple):
    """Upright lines: `shape` of them along x and y, `step` metres apart, the first at `origin`."""

    origin: tuple[float, float]
    step: float
    shape: tuple[int, int]

    def holding(self, points: Array) -> Mask:
        """The lines whose cells hold some of the points, shape (n, 3)."""
        cells = np.round((points[:, :2] - self.origin) / self.step).astype(int)
        mask = np.zeros(self.shape, bool)
        mask[tuple(np.clip(cells, 0, np.array(self.shape) - 1).T)] = True
        return mask

    def x(self, number: int) -> float:
        """Where the lines of a row stand."""
        return self.origin[0] + number * self.step

    def y(self, number: int) -> float:
        """Where the lines of a row stand."""
        return self.origin[1] + number * self.step


class Meeting(NamedTuple):
    """Where lines meet a mesh, sorted by line and height; all of shape (n,).

    `line` is row * columns + column; `up` says that the surface faces up, `flat` that things could lie on it.
    """

    line: Indices
    z: Array
    up: Mask
    flat: Mask


class Free(NamedTuple):
    """Pieces of surface that face up with room above them; all of shape (n,), the lowest first.

    `clear` is infinite under the sky.
    """

    line: Indices
    z: Array
    clear: Array


def raster_of(mesh: Mesh) -> Raster:
    """The raster for a mesh: its lines run through the middles of equal cells."""
    low, high = mesh.corners[:, :2].min(axis=0), mesh.corners[:, :2].max(axis=0)
    side = np.maximum(high - low, 1e-6)
    step = float(np.clip(side.max() / _LINES, _FINEST, _COARSEST))
    count = np.maximum(np.round(side / step).astype(int), 1)
    first = (low + high) / 2 - (count - 1) * step / 2
    return Raster((float(first[0]), float(first[1])), step, (int(count[0]), int(count[1])))


def meetings(mesh: Mesh, raster: Raster) -> Meeting:
    """Where the lines of a raster meet the triangles of a mesh; of two with a common edge, a line on it meets one.

    Raises:
        ValueError: If the mesh would take too long.
    """
    triangles = mesh.corners[mesh.triangles]
    a, b, c = (triangles[:, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    kept = np.flatnonzero(np.abs(normal[:, 2]) > 1e-3 * np.maximum(length, 1e-12))
    low = np.ceil((triangles[kept, :, :2].min(axis=1) - raster.origin) / raster.step - 1e-9).astype(np.int64)
    high = np.floor((triangles[kept, :, :2].max(axis=1) - raster.origin) / raster.step + 1e-9).astype(np.int64)
    low, high = np.maximum(low, 0), np.minimum(high, np.array(raster.shape) - 1)
    spans = np.maximum(high - low + 1, 0)
    pairs = spans[:, 0] * spans[:, 1]
    if int(pairs.sum()) > _MOST_IN_ALL:
        raise ValueError("its triangles lie over each other too often to be measured")
    some = pairs > 0
    kept, low, spans, pairs = kept[some], low[some], spans[some], pairs[some]
    groups = np.flatnonzero(np.diff(np.cumsum(pairs) // _MOST_PAIRS, prepend=0)) if len(pairs) else np.zeros(0, int)
    found = [
        _met(triangles, normal, kept[part], low[part], spans[part], raster)
        for part in np.split(np.arange(len(kept)), groups)
        if len(part)
    ]
    line, z, number = (np.concatenate([one[i] for one in found] or [np.zeros(0)]) for i in range(3))
    line, number = line.astype(np.int64), number.astype(np.int64)
    up = normal[number, 2] > 0
    flat = np.abs(normal[number, 2]) >= FLAT * length[number]
    order = np.lexsort((up, np.round(z / _SAME), line))
    return Meeting(line[order], z[order], up[order], flat[order])


def _met(
    triangles: Array, normal: Array, kept: Indices, low: Indices, spans: Indices, raster: Raster
) -> tuple[Indices, Array, Indices]:
    """Lines, heights and triangles of all pairs that meet, of those in reach of each other."""
    count = spans[:, 0] * spans[:, 1]
    which = np.repeat(np.arange(len(kept)), count)
    within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    column = low[which, 0] + within // spans[which, 1]
    row = low[which, 1] + within % spans[which, 1]
    number = kept[which]
    x, y = raster.origin[0] + column * raster.step, raster.origin[1] + row * raster.step
    corners = triangles[number]
    turn = np.sign(normal[number, 2])
    inside = np.ones(len(number), bool)
    for i in range(3):
        p, q = corners[:, i, :2], corners[:, (i + 1) % 3, :2]
        back = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
        p, q = np.where(back[:, None], q, p), np.where(back[:, None], p, q)
        side = (q[:, 0] - p[:, 0]) * (y - p[:, 1]) - (q[:, 1] - p[:, 1]) * (x - p[:, 0])
        turned = np.where(back, -turn, turn)  # the same sum for both triangles of an edge, so that it is never both
        inside &= (side * turned > 0) | ((side == 0) & (turned > 0))
    number, x, y, corners = number[inside], x[inside], y[inside], corners[inside]
    n = normal[number]
    z = corners[:, 0, 2] - ((x - corners[:, 0, 0]) * n[:, 0] + (y - corners[:, 0, 1]) * n[:, 1]) / n[:, 2]
    return column[inside] * raster.shape[1] + row[inside], z, number


def free_above(met: Meeting, least: float) -> Free:
    """The pieces that face up and have at least so much room above them, which is not the inside of something solid.

    A line that does not go in and out of the mesh by turns, as through one of single sheets, tells no inside from
    outside: there, whatever it meets both carries and covers.
    """
    if not len(met.line):
        return Free(met.line, met.z, met.z)
    last = np.append(met.line[1:] != met.line[:-1], True)
    first = np.append(True, last[:-1])
    up = ~met.up if met.up[last].mean() < 0.5 else met.up  # mirrored
    _, number = np.unique(met.line, return_inverse=True)
    balance = np.bincount(number, np.where(up, 1, -1))
    whole = (balance == 0) & up[last] & ~up[first]
    told = whole[number]
    above = np.append(met.z[1:], np.inf)
    above[last] = np.inf
    deep = np.cumsum(np.where(up, -1, 1))  # how many solids a line is in, after what it meets
    deep -= np.concatenate([[0], deep[:-1]])[first][number]
    free = np.flatnonzero(met.flat & np.where(told, up & (deep == 0), True) & (above - met.z >= least))
    free = free[np.argsort(met.z[free], kind="stable")]
    return Free(met.line[free], met.z[free], (above - met.z)[free])


def tops(met: Meeting, raster: Raster) -> Array:
    """The highest that each line meets, 0 where it meets nothing; of the raster's shape."""
    highest = np.zeros(raster.shape[0] * raster.shape[1])
    np.maximum.at(highest, met.line, met.z)
    return highest.reshape(raster.shape)


def largest_rectangle(mask: Mask) -> tuple[int, int, int, int] | None:
    """The largest rectangle of true cells: first and last row, first and last column; None where all are false."""
    best: tuple[int, tuple[int, int, int, int]] | None = None
    heights = np.zeros(mask.shape[1], int)
    for row in range(mask.shape[0]):
        heights = np.where(mask[row], heights + 1, 0)
        waiting: list[tuple[int, int]] = []
        for column, height in enumerate([*heights.tolist(), 0]):
            start = column
            while waiting and waiting[-1][1] >= height:
                start, tall = waiting.pop()
                area = tall * (column - start)
                if tall and (best is None or area > best[0]):
                    best = (area, (row - tall + 1, row, start, column - 1))
            waiting.append((start, height))
    return best[1] if best else None
