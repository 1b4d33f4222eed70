"""What light depends on besides what is seen, as the shaders read it: rooms, windows, corners, and the sun's camera."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from coopera.simulation.drawing.house import Window
from coopera.simulation.drawing.lens import Camera, view_matrix
from coopera.simulation.drawing.scenery import Scenery
from coopera.simulation.homes.scene import Room
from coopera.simulation.shapes.rotations import Array

_TEXEL = 0.011
"""Metres that a texel of the shadow map covers, as far as `_MOST` allows."""
_MOST = 2048
_FEW = 10_000
"""Texels of the shadow map that are cast anew as soon as another rectangle of it is begun."""
_WINDOWS = 3
_CONTACT = 0.05


def room_rows(scenery: Scenery) -> NDArray[np.float32]:
    """For each room what `room` is in scene.vert: its rectangle within its walls, its windows, those towards the sun.

    Shape (rooms, n, 4).
    """
    rooms = scenery.scene.rooms
    rows = np.zeros((len(rooms), 1 + 2 * (_WINDOWS + gates(scenery)), 4), dtype=np.float32)
    for number, room in enumerate(rooms):
        rows[number, 0] = (room.x0 + 0.05, room.y0 + 0.05, room.x1 - 0.05, room.y1 - 0.05)
        for first, some in ((1, _windows(scenery, room)), (1 + 2 * _WINDOWS, _sunward(scenery, room))):
            for i, one in enumerate(some):
                rows[number, first + 2 * i] = (one.axis, one.at, one.start, one.end)
                area = (one.end - one.start) * (one.high - one.low)
                rows[number, first + 1 + 2 * i] = (one.low, one.high, one.inward, area)
    return rows


def gates(scenery: Scenery) -> int:
    """Through how many windows the sun shines into a room at most; at least 1."""
    return max(1, *(len(_sunward(scenery, room)) for room in scenery.scene.rooms))


def _windows(scenery: Scenery, room: Room) -> list[Window]:
    return scenery.windows.get(room.name, [])[:_WINDOWS]


def _sunward(scenery: Scenery, room: Room) -> list[Window]:
    """The windows through which the sun can shine in."""
    x, y, _ = scenery.sun
    return [one for one in _windows(scenery, room) if one.inward * (y if one.axis == 0 else x) < 0]


def contact(scenery: Scenery) -> NDArray[np.uint8]:
    """How much the furniture that stands on the floor keeps light from it: a picture of the home's rectangle."""
    scene, b = scenery.scene, scenery.scene.bounds
    shape = (math.ceil((b.y1 - b.y0) / _CONTACT), math.ceil((b.x1 - b.x0) / _CONTACT))
    covered = np.zeros(shape, dtype=np.float32)
    y, x = ((np.arange(count) + 0.5) * _CONTACT for count in shape)
    for thing in scene.fixed:
        if thing.position[2] < 0.3 and thing.size[2] > 0.06:
            t = thing.bounds
            inside = np.ix_((y + b.y0 > t.y0) & (y + b.y0 < t.y1), (x + b.x0 > t.x0) & (x + b.x0 < t.x1))
            covered[inside] = 1.0
    soft = 0.6 * gaussian_filter(covered, 1.6) + 0.4 * gaussian_filter(covered, 5.0)
    return np.asarray(np.clip(np.round(soft * 255), 0, 255), dtype=np.uint8)


def sun_lens(scenery: Scenery) -> tuple[Array, float, tuple[int, int]]:
    """The sun's camera over the whole home: world to clip space, how deep it sees in metres, and its size in texels."""
    b = scenery.scene.bounds
    corners = np.array([(x, y, z) for x in (b.x0, b.x1) for y in (b.y0, b.y1) for z in (-0.1, 2.6)])
    middle = corners.mean(axis=0)
    view = view_matrix(Camera(tuple((middle + scenery.sun).tolist()), tuple(middle.tolist())))
    seen = corners @ view[:3, :3].T + view[:3, 3]
    low, high = seen.min(axis=0) - 0.2, seen.max(axis=0) + 0.2
    scale = np.diag([*(2 / (high - low) * (1, 1, -1)), 1.0])
    scale[:3, 3] = -(high + low) / (high - low) * (1, 1, -1)
    size = tuple(min(_MOST, math.ceil(float(side) / _TEXEL / 64) * 64) for side in (high - low)[:2])
    return scale @ view, float(high[2] - low[2]), (size[0], size[1])


def apart(boxes: NDArray[np.int64]) -> list[tuple[int, int, int, int]]:
    """Rectangles that cover some others, as few and small as serves: to cast shadows in one more costs a little, too.

    Args:
        boxes: Shape (n, 4), texels: x0, y0, x1, y1. Those without any are left out.
    """
    found: list[tuple[int, int, int, int]] = []
    left = [(x0, y0, x1, y1) for x0, y0, x1, y1 in boxes.tolist() if x0 < x1 and y0 < y1]
    while left:
        one = left.pop()
        for other in found:
            both = (*map(min, one[:2], other[:2]), *map(max, one[2:], other[2:]))
            if _texels(both) <= _texels(one) + _texels(other) + _FEW:
                found.remove(other)
                left.append(both)
                break
        else:
            found.append(one)
    return found


def _texels(box: tuple[int, ...]) -> int:
    return (box[2] - box[0]) * (box[3] - box[1])
