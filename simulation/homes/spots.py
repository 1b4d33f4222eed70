"""Where a thing of a generated home can stand: free spots on and in furniture, and what fills them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.homes.catalogue import Surface, interiors, surfaces
from coopera.simulation.homes.floorplan import Bounds
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.kit import Size

Array = NDArray[np.float64]

APART = 0.015
"""Things put down keep this distance, in metres."""
_STEP = 0.04
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
    return filled if room is None else [*filled, *_outside(room.bounds)]


def _outside(room: Bounds) -> list[Taken]:
    out = room.grown(_OVERHANG)
    strips = (
        *(out._replace(x1=room.x0), out._replace(x0=room.x1)),
        *(out._replace(y1=room.y0), out._replace(y0=room.y1)),
    )
    return [Taken(strip, 0.0, math.inf) for strip in strips]


def spots(carrier: SceneObject, size: Size, taken: Iterable[Taken], *, inside: bool = False) -> list[Spot]:
    """All free spots for a thing on a piece of furniture, on a 4 cm raster, the usual surface first.

    A thing that is larger than a surface may hang over its edge, centred. Two yaws are tried: the carrier's
    own and a quarter turn.

    Args:
        carrier: The furniture or, for what goes inside, perhaps a thing; it is where its position and yaw say.
        size: Of the thing, in metres.
        taken: What is filled already.
        inside: Whether it goes within the carrier: then it must fit there as a whole.
    """
    filled = np.array([(*space.bounds, space.low, space.high) for space in taken]).reshape(-1, 6)
    found: list[Spot] = []
    for surface in interiors(carrier) if inside else surfaces(carrier):
        if surface.clear < size[2]:
            continue
        z = round(carrier.position[2] + surface.z, 3)
        level = filled[(z < filled[:, 5] - 1e-3) & (filled[:, 4] < z + size[2] - 1e-3), :4]
        for turn in (0.0, math.pi / 2):
            half = _half_extents(size, turn)
            if inside and not _within(surface, half):
                continue
            xs, ys = _raster(surface.x0, surface.x1, half[0]), _raster(surface.y0, surface.y1, half[1])
            yaw = round(math.remainder(carrier.yaw + turn, math.tau), 4)
            places = _places(carrier, np.repeat(xs, len(ys)), np.tile(ys, len(xs)))
            free = places[_clear(places, _half_extents(size, yaw), level)]
            found += [Spot(x, y, z, yaw) for x, y in free.tolist()]
    return found


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
    return np.array([[round(a, 3), round(b, 3)] for a, b in there.tolist()])  # numpy's own rounding is not exact


def _clear(places: Array, half: tuple[float, float], filled: Array) -> NDArray[np.bool_]:
    """Which places, of shape (n, 2), keep a thing clear of all filled rectangles, of shape (m, 4)."""
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
