"""Measure on a mesh where things go on and within it, where a body sits or lies, and where it is solid.

Nothing is known of the object beforehand but what it is for. Levels are found along upright lines (`columns`): pieces
that face up at one height are taken together, and the largest rectangles of them are places for things. What has a
ceiling and a closed front is inside, as in a drawer; an open shelf is not.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from coopera.simulation.homes.columns import (
    Free,
    Mask,
    Raster,
    free_above,
    largest_rectangle,
    meetings,
    raster_of,
    tops,
)
from coopera.simulation.homes.glb import Array, Indices, Mesh
from coopera.simulation.homes.measured import MOST_LEVELS, MOST_SOLIDS, OPEN, Block, Level, Measured, Resting

_LEAST_CLEAR = 0.06
_LEVEL = 0.02
"""Pieces whose heights differ by no more than this are one level (metres)."""
_NARROWEST, _LEAST_AREA = 0.06, 0.008
_PER_LEVEL = 6
_BRIDGED = 0.045
"""Gaps up to this, as between slats, are bridged (metres)."""
_PARTITION = (0.03, 0.15)
"""What stands so high above a level, from and to, parts it (metres)."""
_REACHED = (0.35, 1.4)
"""Places at these heights come first (metres above the object's base)."""
_SEATS, _SOFT, _SEAT_SIDE, _HEADROOM = (0.03, 0.85), 0.03, 0.2, 0.5
_FROM_EDGE = 0.26
"""Who sits has the front edge of a deep seat this far before the middle of the body."""
_BACK = 0.08
_BEDS, _ON_BED, _BED_SIDES = (0.03, 0.95), 0.35, (0.5, 1.3)
_HEAD = 0.03
_DENSE = 0.03
"""Points on the surface are about so far from each other (metres)."""
_MOST_POINTS = 400_000
_CLOSED = 0.5


class Use(NamedTuple):
    """What an object is for: whether bodies sit or lie on it, and whether it is carried about with what is in it."""

    sits: bool = False
    lies: bool = False
    carried: bool = False


def measure(mesh: Mesh, use: Use) -> Measured:
    """Measure an object.

    Args:
        mesh: Metres, Z up, the middle of the base at the origin, the front towards +y.
        use: What it is for.

    Raises:
        ValueError: If the mesh would take too long.
    """
    if not len(mesh.triangles):
        return Measured()
    raster = raster_of(mesh)
    met = meetings(mesh, raster)
    free = free_above(met, _LEAST_CLEAR)
    points = surface_points(mesh)
    high = tops(met, raster)
    levels = [row for height, at in _levels(free, raster) for row in _rectangles(free, at, height, raster, points)]
    if use.carried:
        return Measured(inside=_cavity(levels, mesh))
    seat = _seat(free, high, raster) if use.sits else None
    lie = _lie(free, high, raster) if use.lies else None
    closed = [level[5] < OPEN and _is_closed(level, points, mesh) for level in levels]
    inside = [] if use.sits or use.lies else [level for level, shut in zip(levels, closed, strict=True) if shut]
    surfaces = [level for level, shut in zip(levels, closed, strict=True) if not shut]
    return Measured(
        surfaces=sorted(surfaces, key=_usual)[:MOST_LEVELS],
        inside=sorted(inside, key=_usual)[:MOST_LEVELS],
        seat=seat,
        lie=lie,
        solids=_solids(points),
    )


def _usual(level: Level) -> tuple[bool, float, float]:
    """Places within easy reach first, the largest of them first."""
    z, x0, x1, y0, y1, _ = level
    return not _REACHED[0] <= z <= _REACHED[1], -round((x1 - x0) * (y1 - y0), 3), z


def _levels(free: Free, raster: Raster) -> list[tuple[float, Mask]]:
    """Heights at which much faces up, and which pieces lie there, those with most of it first."""
    left = np.ones(len(free.z), bool)
    found: list[tuple[float, Mask]] = []
    least = _LEAST_AREA / raster.step**2
    while left.any() and len(found) < MOST_LEVELS:
        z = free.z[left]
        until = np.searchsorted(z, z + _LEVEL, side="right")
        most = int((until - np.arange(len(z))).argmax())
        low = float(z[most])
        at = left & (free.z >= low) & (free.z <= low + _LEVEL)
        if at.sum() < least:
            break
        found.append((float(np.median(free.z[at])), at))
        left &= ~at
    return found


def _rectangles(free: Free, at: Mask, height: float, raster: Raster, points: Array) -> list[Level]:
    """Rectangles of one level: those under the sky first, then those under a ceiling; none goes through a partition."""
    rows: list[Level] = []
    sky = np.isinf(free.clear)
    for under in (at & sky, at & ~sky):
        if not under.any():
            continue
        over = height + min(0.8 * float(np.median(free.clear[under])), _PARTITION[1])
        standing = points[(points[:, 2] > height + _PARTITION[0]) & (points[:, 2] < over)]
        mask = _bridged(_mask(free.line[under], raster), raster) & ~raster.holding(standing)
        clear = np.full(raster.shape[0] * raster.shape[1], np.inf)
        np.minimum.at(clear, free.line[under], free.clear[under])
        for _ in range(_PER_LEVEL):
            found = largest_rectangle(mask)
            if found is None:
                break
            i0, i1, j0, j1 = found
            wide, deep = (i1 - i0) * raster.step, (j1 - j0) * raster.step
            if min(wide, deep) < _NARROWEST or wide * deep < _LEAST_AREA:
                break
            mask[i0 : i1 + 1, j0 : j1 + 1] = False
            ceiling = clear.reshape(raster.shape)[i0 : i1 + 1, j0 : j1 + 1]
            lower = ceiling[np.isfinite(ceiling)]
            room = min(float(np.quantile(lower, 0.05)), OPEN) if lower.size else OPEN
            rows.append(
                (
                    round(height, 4),
                    round(raster.x(i0), 4),
                    round(raster.x(i1), 4),
                    round(raster.y(j0), 4),
                    round(raster.y(j1), 4),
                    round(room, 4),
                )
            )
    return rows


def _mask(line: Indices, raster: Raster) -> Mask:
    mask = np.zeros(raster.shape[0] * raster.shape[1], bool)
    mask[line] = True
    return mask.reshape(raster.shape)


def _bridged(mask: Mask, raster: Raster) -> Mask:
    """A mask without its small gaps."""
    size = 2 * math.ceil(_BRIDGED / raster.step / 2) + 1
    wide = np.pad(mask, size)
    closed = ndimage.binary_closing(wide, np.ones((size, size), bool))
    return np.asarray(closed[size:-size, size:-size])


def _is_closed(level: Level, points: Array, mesh: Mesh) -> bool:
    """Whether one cannot reach a place under a ceiling from any side: each is covered for the larger part."""
    z, x0, x1, y0, y1, clear = level
    low, high = z + 0.15 * clear, z + 0.9 * clear
    band = points[(points[:, 2] > low) & (points[:, 2] < high)]
    ends = (mesh.corners.min(axis=0), mesh.corners.max(axis=0))
    for axis, start, end in ((0, y0, y1), (1, x0, x1)):
        other = 1 - axis
        inner = (x0, x1) if axis == 0 else (y0, y1)
        before = (band[:, other] > start) & (band[:, other] < end)
        middle = sum(inner) / 2
        for side in (band[before & (band[:, axis] > middle)], band[before & (band[:, axis] < middle)]):
            if _covered(side, other, (start, end), (low, high)) < _CLOSED and ends[0][2] <= z:
                return False
    return True


def _covered(points: Array, along: int, span: tuple[float, float], band: tuple[float, float]) -> float:
    """How much of an upright rectangle is hidden behind points, in [0, 1]."""
    count = [max(int((high - low) / (1.5 * _DENSE)), 1) for low, high in (span, band)]
    cells = [
        np.clip(((points[:, axis] - low) / (high - low) * n).astype(int), 0, n - 1)
        for axis, (low, high), n in ((along, span, count[0]), (2, band, count[1]))
    ]
    return len(np.unique(cells[0] * count[1] + cells[1])) / (count[0] * count[1])


def _cavity(levels: list[Level], mesh: Mesh) -> list[Level]:
    """The inside of what is open above and carried: its largest bottom, up to the rim."""
    rim = float(mesh.corners[:, 2].max())
    low = [level for level in levels if level[0] < 0.6 * rim and rim - level[0] > _LEAST_CLEAR]
    if not low:
        return []
    z, x0, x1, y0, y1, _ = max(low, key=lambda level: (level[2] - level[1]) * (level[4] - level[3]))
    return [(z, x0, x1, y0, y1, round(rim - z, 4))]


class _Place(NamedTuple):
    """A rectangle of a raster and its height."""

    i0: int
    i1: int
    j0: int
    j1: int
    z: float


def _largest_at(free: Free, heights: tuple[float, float], raster: Raster) -> tuple[_Place, Mask] | None:
    """The largest rectangle, of whatever height in a range, over which a body has room; soft shapes are allowed for."""
    usable = (free.z >= heights[0]) & (free.z <= heights[1]) & (free.clear >= _HEADROOM)
    best: tuple[int, _Place, Mask] | None = None
    left = usable.copy()
    for _ in range(4):
        if not left.any():
            break
        z = free.z[left]
        until = np.searchsorted(z, z + 2 * _SOFT, side="right")
        low = float(z[int((until - np.arange(len(z))).argmax())])
        at = left & (free.z >= low) & (free.z <= low + 2 * _SOFT)
        left &= ~at
        mask = np.asarray(ndimage.binary_fill_holes(_bridged(_mask(free.line[at], raster), raster)))
        found = largest_rectangle(mask)
        if found is None:
            continue
        i0, i1, j0, j1 = found
        row, column = free.line // raster.shape[1], free.line % raster.shape[1]
        within = at & (row >= i0) & (row <= i1) & (column >= j0) & (column <= j1)
        area = (i1 - i0 + 1) * (j1 - j0 + 1)
        if within.any() and (best is None or area > best[0]):
            best = (area, _Place(i0, i1, j0, j1, float(np.median(free.z[within]))), mask)
    return None if best is None else best[1:]


def _seat(free: Free, high: Array, raster: Raster) -> Resting | None:
    """Where one sits: on the largest place, the back where the object rises most beside it, else facing its front."""
    found = _largest_at(free, _SEATS, raster)
    if found is None:
        return None
    (i0, i1, j0, j1, z), _ = found
    wide, deep = (i1 - i0 + 1) * raster.step, (j1 - j0 + 1) * raster.step
    if min(wide, deep) < _SEAT_SIDE:
        return None
    x, y = (raster.x(i0) + raster.x(i1)) / 2, (raster.y(j0) + raster.y(j1)) / 2
    rise = np.maximum(high - z - 0.05, 0.0)
    beside = {  # by the heading of who leans against that side
        math.pi / 2: rise[i0 : i1 + 1, :j0],
        -math.pi / 2: rise[i0 : i1 + 1, j1 + 1 :],
        0.0: rise[:i0, j0 : j1 + 1],
        math.pi: rise[i1 + 1 :, j0 : j1 + 1],
    }
    rises = {turn: float(np.quantile(part.max(axis=_across(turn)), 0.5)) for turn, part in beside.items() if part.size}
    turn = max(rises, key=lambda one: rises[one], default=math.pi / 2)
    if rises.get(turn, 0.0) < rises.get(math.pi / 2, 0.0) + _BACK:
        turn = math.pi / 2
    ahead = (round(math.cos(turn)), round(math.sin(turn)))
    long, aside = (wide, deep) if ahead[0] else (deep, wide)
    forward = max(long / 2 - _FROM_EDGE, 0.0)
    return Resting(
        x=round(x + forward * ahead[0], 4),
        y=round(y + forward * ahead[1], 4),
        z=round(z, 4),
        turn=turn,
        wide=round(aside, 4),
    )


def _across(turn: float) -> int:
    return 1 if round(math.sin(turn)) else 0


def _lie(free: Free, high: Array, raster: Raster) -> Resting | None:
    """Where one lies: on the longest place, pillows and blankets being on it, the head where the object rises more."""
    found = _largest_at(free, _BEDS, raster)
    if found is None:
        return None
    z = found[0].z
    bedding = found[1] | ((high > z) & (high < z + _ON_BED))
    whole = largest_rectangle(np.asarray(_bridged(bedding, raster)))
    if whole is None:
        return None
    i0, i1, j0, j1 = whole
    wide, deep = (i1 - i0 + 1) * raster.step, (j1 - j0 + 1) * raster.step
    if min(wide, deep) < _BED_SIDES[0] or max(wide, deep) < _BED_SIDES[1]:
        return None
    along_x = wide > deep
    ends = high[:, j0 : j1 + 1].mean(axis=1) if along_x else high[i0 : i1 + 1].mean(axis=0)
    fifth = max(len(ends) // 5, 1)
    rises = float(ends[-fifth:].mean() - ends[:fifth].mean())  # the head is at the far end where this is positive
    turn = math.pi if rises > _HEAD else 0.0
    if not along_x:
        turn = -math.pi / 2 if rises > _HEAD else math.pi / 2
    x, y = (raster.x(i0) + raster.x(i1)) / 2, (raster.y(j0) + raster.y(j1)) / 2
    return Resting(x=round(x, 4), y=round(y, 4), z=round(z, 4), turn=turn, wide=round(min(wide, deep), 4))


def surface_points(mesh: Mesh) -> Array:
    """Points spread evenly over all triangles, shape (n, 3): always the same for the same mesh."""
    a, b, c = (mesh.corners[mesh.triangles[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    each = min(_DENSE**2, 1.0) if area.sum() / _DENSE**2 < _MOST_POINTS else area.sum() / _MOST_POINTS
    count = np.ceil(area / each * 2).astype(np.int64)
    which = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    u, v = (0.5 + number * 0.7548776662) % 1.0, (0.5 + number * 0.5698402910) % 1.0  # Roberts' R2 sequence
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u)[:, None], np.where(over, 1.0 - v, v)[:, None]
    inner = a[which] + u * (b - a)[which] + v * (c - a)[which]
    return np.asarray(np.concatenate([mesh.corners[np.unique(mesh.triangles)], inner]))


def _solids(points: Array) -> list[Block]:
    """A few upright boxes that hold all points, each drawn tight around those in it."""
    low, high = points.min(axis=0), points.max(axis=0)
    pitch = max(float((high - low).max()) / 24, 1.2 * _DENSE)
    while True:
        cells = np.minimum(((points - low) / pitch).astype(np.int64), ((high - low) / pitch).astype(np.int64))
        blocks = _merged(cells)
        if len(blocks) <= MOST_SOLIDS:
            break
        pitch *= 1.4
    found: list[Block] = []
    for first, last in blocks:
        own = points[((cells >= first) & (cells <= last)).all(axis=1)]
        (x0, y0, z0), (x1, y1, z1) = np.round(own.min(axis=0), 3).tolist(), np.round(own.max(axis=0), 3).tolist()
        found.append((x0, y0, x1, y1, z0, z1))
    return found


def _merged(cells: Indices) -> list[tuple[Indices, Indices]]:
    """Boxes of filled cells, each cell in one: the first that is left, grown along x, then y, then z."""
    filled = np.zeros(cells.max(axis=0) + 1, bool)
    filled[tuple(cells.T)] = True
    found: list[tuple[Indices, Indices]] = []
    while filled.any() and len(found) <= MOST_SOLIDS:
        first = np.array(np.unravel_index(int(filled.argmax()), filled.shape))
        last = first.copy()
        for axis in (2, 1, 0):
            while last[axis] + 1 < filled.shape[axis]:
                ahead = tuple(
                    slice(f, t + 1) if i != axis else slice(t + 1, t + 2)
                    for i, (f, t) in enumerate(zip(first, last, strict=True))
                )
                if not filled[ahead].all():
                    break
                last[axis] += 1
        filled[tuple(slice(f, t + 1) for f, t in zip(first, last, strict=True))] = False
        found.append((first, last))
    return found
