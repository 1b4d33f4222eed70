"""What an open piece of furniture shows besides itself: its dark inside, and its doors or a drawer pulled out."""

from __future__ import annotations

from coopera.simulation.homes.catalogue import interiors
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.kit import DARK, Kit, Part, shade

_LEAF = 0.025
_WIDE = 0.62
"""Wider furniture has two doors (metres)."""
_DRAWN_OUT = 0.28
_FLAPS = ("dishwasher",)
_DRAWERS = ("dresser",)
_RIM = 0.02


def opened(thing: SceneObject) -> list[Part]:
    """The parts to show while furniture is open, in its frame; empty where nothing goes in behind a front."""
    rows = interiors(thing)
    if not rows or not thing.fixed:
        return []
    kit = Kit(thing.size, thing.rgb)
    front = thing.size[1] / 2 + _RIM
    x0, x1 = min(row.x0 for row in rows), max(row.x1 for row in rows)
    low, high = min(row.z for row in rows), max(row.z + row.clear for row in rows)
    middle, wide, tall = (x0 + x1) / 2, x1 - x0, high - low
    if thing.cls in _DRAWERS:
        top = rows[0]
        for x in (x0, x1):
            kit.box((x, front + _DRAWN_OUT / 2, top.z), (_LEAF, _DRAWN_OUT, 0.8 * top.clear))
        kit.box((middle, front + _DRAWN_OUT / 2, top.z), (wide, _DRAWN_OUT, _LEAF), shade(kit.colour, 0.5))
        kit.box((middle, front + _DRAWN_OUT, top.z), (wide, _LEAF, top.clear), shade(kit.colour, 1.3))
        return kit.parts
    kit.box((middle, front, low), (wide, 0.01, tall), DARK)
    for row in rows:
        kit.box((middle, front + 0.005, row.z - 0.01), (wide, 0.012, 0.015), shade(kit.colour, 0.9))
    if thing.cls in _FLAPS:
        kit.box((middle, front + tall / 2, low - _LEAF), (wide, tall, _LEAF))
        return kit.parts
    for x, leaf in ((x0, wide / 2), (x1, wide / 2)) if wide > _WIDE else ((x0, wide),):
        kit.box((x, front + leaf / 2, low), (_LEAF, leaf, tall), shade(kit.colour, 1.1))
    return kit.parts
