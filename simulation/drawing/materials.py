"""What things are made of, and what that looks like from near: a small tiling picture for each material.

A picture holds how much lighter or darker each point is than the colour of the thing: 0.5 leaves it as it is. They are
made here, with a fixed seed; nothing is read from a file.
"""

from __future__ import annotations

import colorsys
from enum import IntEnum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing.geometry import Floats
from coopera.simulation.shapes.kit import CREAM, DARK_WOOD, GLASS, SCREEN, STEEL, WOOD, Colour

SIDE = 256
PANE: Colour = (0.62, 0.83, 0.97)
"""The colour in which the recipes of windows paint their glass."""


class Material(IntEnum):
    """What a surface is made of; the number is that of its picture."""

    PLAIN = 0
    PAINT = 1
    WOOD = 2
    PLANKS = 3
    TILES = 4
    CLOTH = 5
    METAL = 6
    GLASS = 7
    WINDOW = 8
    LAMP = 9
    SKIN = 10
    HAIR = 11
    STONE = 12
    WALL_TILES = 13
    CARPET = 14


METRES = (1.0, 1.6, 0.5, 1.44, 1.2, 0.16, 1.0, 1.0, 1.0, 1.0, 1.0, 0.1, 0.7, 0.6, 0.24)
"""How much of a surface one picture of each material covers."""

_SOFT = frozenset(
    [
        "sofa",
        "armchair",
        "office_chair",
        "bed",
        "curtain",
        "rug",
        "towel",
        "cushion",
        "blanket",
        "teddy_bear",
        "handbag",
        "backpack",
        "hat",
        "scarf",
        "slippers",
        "yoga_mat",
        "pillow",
        "jacket",
        "shirt",
        "sweater",
        "coat",
        "socks",
        "gloves",
        "apron",
        "bathrobe",
        "laundry_basket",
        "sewing_kit",
        "bench",
    ]
)
_TURNED = frozenset(["floor_lamp", "table_lamp", "lamp", "desk_lamp"])


def of_thing(cls: str, main: Colour, colour: Colour) -> Material:
    """What a part of a thing is made of, by its colour, the thing's class and its main colour."""
    if colour == PANE:
        return Material.WINDOW
    if colour == STEEL:
        return Material.METAL
    if colour in (GLASS, SCREEN) or cls == "mirror":
        return Material.GLASS if colour != main else Material.WOOD
    if colour in (WOOD, DARK_WOOD):
        return Material.WOOD
    if cls in _TURNED and _bright(colour):
        return Material.LAMP
    if cls == "rug":
        return Material.CARPET
    if cls in _SOFT and (_like(colour, main) or colour == CREAM):
        return Material.CLOTH
    if cls == "kitchen_counter" and sum(colour) < 1.6:
        return Material.STONE
    return Material.WOOD if wooden(colour) else Material.PLAIN


def wooden(colour: Colour) -> bool:
    """Whether a colour is that of wood."""
    hue, saturation, value = colorsys.rgb_to_hsv(*colour)
    return 0.05 <= hue <= 0.125 and 0.28 <= saturation <= 0.68 and 0.2 <= value <= 0.8


def _like(colour: Colour, main: Colour) -> bool:
    """Whether a colour is a shade of another."""
    one, other = (np.array(value) / max(*value, 1e-6) for value in (colour, main))
    return float(np.abs(one - other).max()) < 0.3


def _bright(colour: Colour) -> bool:
    return min(colour[:2]) > 0.6


@lru_cache(maxsize=1)
def pictures() -> NDArray[np.uint8]:
    """The pictures of all materials: (materials, SIDE, SIDE, 3)."""
    rng = np.random.default_rng(20)
    found = np.full((len(Material), SIDE, SIDE, 3), 0.5, dtype=np.float32)
    y, x = np.mgrid[0:SIDE, 0:SIDE] / SIDE
    soft = _noise(rng, (8, 8), 4)
    found[Material.PAINT] += 0.006 * soft[..., None]
    found[Material.SKIN] += 0.01 * soft[..., None]
    found[Material.STONE] += (0.14 * _noise(rng, (40, 40), 3) + 0.04 * soft)[..., None]
    found[Material.WOOD] = _grain(rng, x, y, 3.0)
    found[Material.PLANKS] = _planks(rng)
    found[Material.TILES] = _tiles(rng, 4, 0.014)
    found[Material.WALL_TILES] = _tiles(rng, 4, 0.010)
    weave = np.sin(2 * np.pi * 32 * x) * np.sin(2 * np.pi * 32 * y)
    found[Material.CLOTH] += (0.05 * weave + 0.045 * _noise(rng, (24, 24), 3))[..., None]
    found[Material.CARPET] += (0.13 * _noise(rng, (64, 64), 2))[..., None]
    found[Material.METAL] += (0.03 * _noise(rng, (2, 128), 1))[..., None]
    found[Material.HAIR] += (0.12 * _noise(rng, (2, 48), 2))[..., None]
    found[Material.WINDOW] = _outdoors(rng, y)
    return np.clip(np.round(found * 255), 0, 255).astype(np.uint8)


def _noise(rng: np.random.Generator, cells: tuple[int, int], octaves: int) -> Floats:
    """Tiling noise about 0, mostly from -1 to 1; `cells` are its bumps along x and y."""
    total = np.zeros((SIDE, SIDE), dtype=np.float32)
    for octave in range(octaves):
        across, down = (min(count << octave, SIDE) for count in cells)
        values = rng.normal(0.0, 0.5, (down, across))
        total += (_stretched(_stretched(values, 0), 1) / 2**octave).astype(np.float32)
    return total


def _stretched(values: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    """Values along an axis, which closes, with smooth steps between them, to `SIDE` of them."""
    count = values.shape[axis]
    place = np.arange(SIDE) * count / SIDE
    low = place.astype(int)
    share = place - low
    share = (share * share * (3 - 2 * share)).reshape((-1, 1) if axis == 0 else (1, -1))
    return np.asarray(values.take(low % count, axis) * (1 - share) + values.take((low + 1) % count, axis) * share)


def _grain(rng: np.random.Generator, x: NDArray[np.float64], y: NDArray[np.float64], rings: float) -> Floats:
    """Wood with its grain along x."""
    bent = y * rings + 0.22 * _noise(rng, (2, 4), 2)
    ring = np.abs((bent * 2) % 1.0 - 0.5) * 2
    fine = _noise(rng, (4, 128), 1)
    value = 0.5 + 0.07 * (ring - 0.5) + 0.05 * fine + 0.03 * _noise(rng, (3, 24), 2)
    return np.stack((value, value * 0.985, value * 0.965), axis=2).astype(np.float32)


def _planks(rng: np.random.Generator) -> Floats:
    """A floor of planks along x: ten rows, each of two boards of its own shade."""
    rows, value = 10, np.empty((SIDE, SIDE), dtype=np.float32)
    y = np.arange(SIDE) * rows / SIDE
    fine = 0.045 * _noise(rng, (4, 128), 1) + 0.03 * _noise(rng, (6, 40), 2)
    for row in range(rows):
        band = (y >= row) & (y < row + 1)
        shift = int(rng.integers(SIDE))
        column = (np.arange(SIDE) + shift) % SIDE
        shades = rng.uniform(0.42, 0.555, 2)
        value[band] = shades[(column >= SIDE // 2).astype(int)] + fine[band]
        value[np.ix_(band, column % (SIDE // 2) < 2)] *= 0.72
    value[(y % 1.0) < 0.07] *= 0.74
    return np.stack((value, value * 0.985, value * 0.96), axis=2)


def _tiles(rng: np.random.Generator, count: int, joint: float) -> Floats:
    """Square tiles, so many a side, with grout between them."""
    at = np.arange(SIDE) / SIDE * count
    shade = rng.uniform(0.493, 0.512, (count, count))[np.ix_(at.astype(int), at.astype(int))]
    near = np.minimum(at % 1.0, 1 - at % 1.0) / count
    grout = np.minimum(near[:, None], near[None, :]) < joint / 2
    value = shade + 0.012 * _noise(rng, (16, 16), 2)
    value = np.where(grout, 0.38, value)
    return np.repeat(value[..., None], 3, axis=2).astype(np.float32)


def _outdoors(rng: np.random.Generator, y: NDArray[np.float64]) -> Floats:
    """What is seen through a window: sky, and out of focus a hedge and a lawn; these are colours, y from below."""
    sky = np.array((0.80, 0.90, 1.0)) + (y[..., None] - 0.5) * np.array((-0.18, -0.10, 0.0))
    edge = 0.36 + 0.06 * _noise(rng, (5, 1), 3)[:1] * np.ones_like(y)
    hedge = np.array((0.46, 0.58, 0.38)) + 0.05 * _noise(rng, (12, 12), 2)[..., None]
    lawn = np.array((0.62, 0.72, 0.45)) + 0.02 * _noise(rng, (8, 8), 2)[..., None]
    blend = np.clip((edge - y) / 0.04 + 0.5, 0, 1)[..., None]
    ground = np.clip((0.16 - y) / 0.05 + 0.5, 0, 1)[..., None]
    below = hedge * (1 - ground) + lawn * ground
    return np.asarray(sky * (1 - blend) + below * blend, dtype=np.float32)
