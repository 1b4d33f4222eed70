"""What an open piece of furniture shows besides itself: its dark inside, and its doors or a drawer pulled out."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from coopera.simulation.homes.catalogue import interiors
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.kit import DARK, Colour, Kit, Part, shade
from coopera.simulation.shapes.rotations import Array, about_x, about_z

_LEAF = 0.025
_WIDE = 0.62
"""Wider furniture has two doors (metres)."""
_DRAWN_OUT = (0.28, 0.22, 0.16, 0.1, 0.05)
_TURNED = sorted(range(40, 161, 10), key=lambda by: abs(by - 99))
_FOLDED = range(160, 119, -10)
_LET_DOWN = range(90, 19, -10)
"""How far a drawer comes out (metres), a door turns and a flap goes down (degrees): what is liked best comes first.

A door that is hung on the other side hides who stands before it from most places, unless it is folded back."""
_FLAPS = ("dishwasher",)
_DRAWERS = ("dresser",)
_RIM = 0.02


class Way(NamedTuple):
    """Where a leaf's origin may be in the furniture's frame, and how the leaf is turned (a matrix)."""

    place: Array
    turn: Array


class Leaf(NamedTuple):
    """What moves when furniture is opened: its parts, all boxes, in its own frame, and the ways it may stand open.

    The best way comes first; a door is hung on the other side last of all. Into what is `hollow` hands reach.
    """

    parts: list[Part]
    ways: list[Way]
    hollow: bool = False


class Opened(NamedTuple):
    """What shows while furniture is open: parts in its frame that stay, and leaves."""

    inside: list[Part]
    leaves: list[Leaf]


def opened(thing: SceneObject) -> Opened:
    """What to show while furniture is open; nothing where nothing goes in behind a front."""
    rows = interiors(thing)
    if not rows or not thing.fixed:
        return Opened([], [])
    kit = Kit(thing.size, thing.rgb)
    front = thing.size[1] / 2 + _RIM
    x0, x1 = min(row.x0 for row in rows), max(row.x1 for row in rows)
    low, high = min(row.z for row in rows), max(row.z + row.clear for row in rows)
    middle, wide, tall = (x0 + x1) / 2, x1 - x0, high - low
    if thing.cls in _DRAWERS:
        return Opened([], [_drawer(thing, (middle, front, rows[0].z), wide, rows[0].clear)])
    kit.box((middle, front, low), (wide, 0.01, tall), DARK)
    for row in rows:
        kit.box((middle, front + 0.005, row.z - 0.01), (wide, 0.012, 0.015), shade(kit.colour, 0.9))
    if thing.cls in _FLAPS:
        ways = [_way((middle, front, low), about_x(math.radians(90 - by))) for by in _LET_DOWN]
        return Opened(kit.parts, [Leaf(_slab((0.0, tall / 2, -_LEAF), (wide, tall, _LEAF), kit.colour), ways)])
    colour = shade(kit.colour, 1.1)
    right = [_way((x0, front, low), about_z(math.radians(by))) for by in _TURNED]
    wider = _TURNED if wide > _WIDE else _FOLDED
    left = [_way((x1, front, low), about_z(math.radians(180 - by))) for by in wider]
    if wide > _WIDE:
        parts = _slab((wide / 4, 0.0, 0.0), (wide / 2, _LEAF, tall), colour)
        return Opened(kit.parts, [Leaf(parts, right), Leaf(parts, left)])
    return Opened(kit.parts, [Leaf(_slab((wide / 2, 0.0, 0.0), (wide, _LEAF, tall), colour), right + left)])


def _drawer(thing: SceneObject, front: tuple[float, float, float], wide: float, tall: float) -> Leaf:
    """A drawer whose front is the origin of its frame."""
    kit, deep = Kit(thing.size, thing.rgb), _DRAWN_OUT[0]
    for x in (-wide / 2, wide / 2):
        kit.box((x, -deep / 2, 0.0), (_LEAF, deep, 0.8 * tall))
    kit.box((0.0, -deep / 2, 0.0), (wide, deep, _LEAF), shade(kit.colour, 0.5))
    kit.box((0.0, 0.0, 0.0), (wide, _LEAF, tall), shade(kit.colour, 1.3))
    x, y, z = front
    return Leaf(kit.parts, [_way((x, y + out, z), np.eye(3)) for out in _DRAWN_OUT], hollow=True)


def _slab(at: tuple[float, float, float], size: tuple[float, float, float], colour: Colour) -> list[Part]:
    kit = Kit(size, colour)
    kit.box(at, size)
    return kit.parts


def _way(place: tuple[float, float, float], turn: Array) -> Way:
    return Way(np.array(place), turn)
