"""Where a thing of a generated home can stand: free spots on and in furniture, and what fills them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.homes.catalogue import Surface, interiors, parts_of, surfaces
from coopera.simulation.homes.floorplan import Bounds
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.kit import Size

Array = NDArray[np.float64]

APART = 0.015
"""Things put down keep this distance, in metres."""
_STEP = 0.04
_SUNK = 0.05
"""A part that ends less than this above a surface is that surface: cushions and rims (metres)."""
_PUSHES = (0.02, 0.04, 0.06, 0.08, 0.1)
"""How far a thing that hangs over may be pushed towards the front of its carrier (metres)."""
_NOTHING = np.zeros((0, 6))
_OVERHANG = 0.6


class Spot(NamedTuple):
    """A pose for a thing: base centre and yaw."""

    x: float
    y: float
    z: float
    yaw: float


class Taken(NamedTuple):
    """A space that is already filled: a rectangle on the floor plan from one height to another."""

    bounds: Bounds
    low: float
    high: float


def taken_by(thing: SceneObject) -> Taken:
    """The space that an object fills in its initial place."""
    return Taken(thing.bounds, thing.position[2], thing.top)


def taken_at(spot: Spot, size: Size) -> Taken:
    """The space that a thing of this size fills at a spot."""
    half_x, half_y = _half_extents(size, spot.yaw)
    bounds = Bounds(spot.x - half_x, spot.y - half_y, spot.x + half_x, spot.y + half_y)
    return Taken(bounds, spot.z, spot.z + size[2])


def furniture_on(scene: Scene, carrier: SceneObject) -> list[Taken]:
    """Spaces on, over or beside a piece of furniture that are filled: by other furniture, and all outside its room."""
    around = carrier.bounds.grown(_OVERHANG)
    near = [other for other in scene.fixed if other.name != carrier.name and other.bounds.overlaps(around)]
    filled = [taken_by(other) for other in near if other.top > carrier.position[2] + 0.01]
    room = scene.room(carrier.room)
    return filled if room is None else [*filled, *(Taken(b, 0.0, math.inf) for b in room.outside(around, _OVERHANG))]


def spots(
    carrier: SceneObject, size: Size, taken: Iterable[Taken], *, inside: bool = False, through: bool = False
) -> list[Spot]:
    """All free spots for a thing on a piece of furniture, on a 4 cm raster, the usual surface first.

    A thing that is larger than a surface may hang over its edge, centred, or towards the front where the carrier has
    a back. Two yaws are tried: the carrier's own and a quarter turn. Nothing is put through the parts of the
    furniture that it stands on, such as the pole of a lamp.

    Args:
        carrier: The furniture or, for what goes inside, perhaps a thing; it is where its position and yaw say.
        size: Of the thing, in metres.
        taken: What is filled already.
        inside: Whether it goes within the carrier: then it must fit there as a whole.
        through: Whether parts of the carrier are no hindrance.
    """
    filled = np.array([(*space.bounds, space.low, space.high) for space in taken]).reshape(-1, 6)
    own = _NOTHING if inside or through else _parts(carrier)
    found: list[Spot] = []
    for surface in interiors(carrier) if inside else surfaces(carrier):
        if surface.clear < size[2]:
            continue
        z = round(carrier.position[2] + surface.z, 3)
        above = _above(own, surface.z, size[2])
        level = filled[(z < filled[:, 5] - 1e-3) & (filled[:, 4] < z + size[2] - 1e-3), :4]
        for turn in (0.0, math.pi / 2):
            half = _half_extents(size, turn)
            if inside and not _within(surface, half):
                continue
            yaw = round(math.remainder(carrier.yaw + turn, math.tau), 4)
            local = _local(surface, half)
            kept = local[_clear(local, half, above)]
            if not len(kept) and 2 * half[1] >= surface.y1 - surface.y0:
                local = np.concatenate([local + (0.0, push) for push in _PUSHES])
                kept = local[_clear(local, half, above) & (local[:, 1] <= surface.y1)]
            places = _places(carrier, kept[:, 0], kept[:, 1])
            free = places[_clear(places, _half_extents(size, yaw), level)]
            found += [Spot(x, y, z, yaw) for x, y in free.tolist()]
    return found


def stands_through(carrier: SceneObject, spot: Spot, size: Size) -> bool:
    """Whether a thing at a spot on a piece of furniture sticks in one of the furniture's own parts."""
    x, y = carrier.to_local(spot.x, spot.y)
    half = _half_extents(size, spot.yaw - carrier.yaw)
    above = _above(_parts(carrier), spot.z - carrier.position[2], size[2])
    return not _clear(np.array([[x, y]]), (half[0] - 2e-3, half[1] - 2e-3), above).all()


def is_free(space: Taken, taken: Iterable[Taken]) -> bool:
    """Whether a space keeps clear of all those already filled."""
    return not any(
        space.low < other.high - 1e-3 and other.low < space.high - 1e-3 and space.bounds.overlaps(other.bounds, APART)
        for other in taken
    )


def _places(carrier: SceneObject, x: Array, y: Array) -> Array:
    """Points of the carrier's frame on the floor plan, to the millimetre; shape (n, 2)."""
    cos, sin = math.cos(carrier.yaw), math.sin(carrier.yaw)
    at_x, at_y = carrier.xy
    there = np.stack((at_x + x * cos - y * sin, at_y + x * sin + y * cos), axis=1)
    return np.array([[round(a, 3), round(b, 3)] for a, b in there.tolist()]).reshape(
        -1, 2
    )  # numpy's own rounding is not exact


def _local(surface: Surface, half: tuple[float, float]) -> Array:
    """The raster on a surface, in the carrier's frame; shape (n, 2)."""
    xs, ys = _raster(surface.x0, surface.x1, half[0]), _raster(surface.y0, surface.y1, half[1])
    return np.stack((np.repeat(xs, len(ys)), np.tile(ys, len(xs))), axis=1)


def _parts(carrier: SceneObject) -> Array:
    if carrier.measured is not None:
        return np.array(carrier.measured.solids).reshape(-1, 6)
    return _NOTHING if carrier.mesh else _solid(carrier.cls, carrier.size)


def _above(parts: Array, surface: float, high: float) -> Array:
    """Rectangles of those parts that a thing of some height on a surface could stick in; shape (n, 4)."""
    found: Array = parts[(surface + _SUNK < parts[:, 5]) & (parts[:, 4] < surface + high - 1e-3), :4]
    return found


@lru_cache(maxsize=512)
def _solid(cls: str, size: Size) -> Array:
    """The boxes around the parts of a piece of furniture, in its frame: x0, y0, x1, y1, low, high; shape (n, 6)."""
    rows = []
    for part in parts_of(cls, size, (0.5, 0.5, 0.5)):
        (x, y, z), (wide, deep, high) = part.position, part.around
        rows.append((x - wide, y - deep, x + wide, y + deep, z - high, z + high))
    return np.array(rows)


def _clear(places: Array, half: tuple[float, float], filled: Array) -> NDArray[np.bool_]:
    """Which places, of shape (n, 2), keep a thing apart from all filled rectangles, of shape (m, 4)."""
    x, y = places[:, :1], places[:, 1:]
    hits = (x - half[0] < filled[:, 2] + APART) & (filled[:, 0] < x + half[0] + APART)
    hits &= (y - half[1] < filled[:, 3] + APART) & (filled[:, 1] < y + half[1] + APART)
    clear: NDArray[np.bool_] = np.logical_not(hits.any(axis=1))
    return clear


def _within(surface: Surface, half: tuple[float, float]) -> bool:
    return 2 * half[0] <= surface.x1 - surface.x0 and 2 * half[1] <= surface.y1 - surface.y0


def _half_extents(size: Size, yaw: float) -> tuple[float, float]:
    cos, sin = abs(math.cos(yaw)), abs(math.sin(yaw))
    return (size[0] * cos + size[1] * sin) / 2, (size[0] * sin + size[1] * cos) / 2


def _raster(low: float, high: float, half: float) -> list[float]:
    low, high = low + half, high - half
    if low >= high:
        return [(low + high) / 2]
    count = max(1, math.floor((high - low) / _STEP))
    return [low + (high - low) * i / count for i in range(count + 1)]
