"""What a camera may see of a home: what lies in its pyramid, and in rooms that it looks into."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing.house import WALL_HEIGHT
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.homes.scene import Doorway, Scene
from coopera.simulation.shapes.rotations import Array


class Pieces(Protocol):
    """Boxes around stretches of triangles: see `scenery.Piece`."""

    low: Array
    high: Array
    room: NDArray[np.int64]
    above: NDArray[np.bool_]
    casts: NDArray[np.bool_]


def in_view(scene: Scene, camera: Camera, lens: Array, pieces: Pieces, rooms: set[int] | None) -> NDArray[np.int64]:
    """Numbers of the pieces that may be seen: the nearest first, and last walls, floors and windows, which are behind.

    `rooms` are those that are looked into: see `rooms_seen`.
    """
    if not len(pieces.room):
        return np.zeros(0, dtype=np.int64)
    kept = _in_pyramid(lens, pieces.low, pieces.high)
    if camera.eye[2] > WALL_HEIGHT:
        kept &= ~pieces.above
    if rooms is not None:
        seen = np.zeros(len(scene.rooms) + 1, dtype=bool)
        seen[[*sorted(rooms), -1]] = True
        kept &= seen[pieces.room]
    chosen = np.flatnonzero(kept)
    eye = np.array(camera.eye)
    nearest = np.clip(eye, pieces.low[chosen], pieces.high[chosen])
    away = np.round(((nearest - eye) ** 2).sum(axis=1), 6)
    return chosen[np.lexsort((away, ~pieces.casts[chosen]))]


def _in_pyramid(lens: Array, low: Array, high: Array) -> NDArray[np.bool_]:
    """Which boxes are not wholly beyond one side of what a camera sees."""
    planes = np.concatenate((lens[3] + lens[:3], lens[3] - lens[:3]))
    normals = planes[:, :3]
    reach = np.where(normals[:, None] > 0, high, low)
    return np.asarray(((reach * normals[:, None]).sum(axis=2) + planes[:, 3:] >= 0).all(axis=0))


def rooms_seen(scene: Scene, camera: Camera) -> set[int] | None:
    """Numbers of the rooms that a camera may look into, through doors; None where all may be.

    Walls are as high as the rooms, so it is a matter of angles on the floor: what is seen through a door lies between
    the directions of its posts.
    """
    x, y, z = camera.eye
    if z >= WALL_HEIGHT or scene.stage is not None:
        return None
    here = next((number for number, room in enumerate(scene.rooms) if room.contains(x, y)), None)
    if here is None:
        return None
    numbers = {room.name: number for number, room in enumerate(scene.rooms)}
    doors: dict[int, list[tuple[int, Doorway]]] = {}
    for door in scene.doors:
        a, b = (numbers[name] for name in door.between)
        doors.setdefault(a, []).append((b, door))
        doors.setdefault(b, []).append((a, door))
    seen, left = {here}, [(here, -1, -math.pi, math.pi)]
    while left:
        room, came, low, high = left.pop()
        for other, door in doors.get(room, []):
            if other == came:
                continue
            if math.hypot(door.x - x, door.y - y) < door.width:
                begin, end = low, high
            else:
                begin, end = _between(_posts(scene, room, door), (x, y), low, high)
            if begin < end and (len(left) < 200):
                seen.add(other)
                left.append((other, room, begin, end))
    return seen


def _posts(scene: Scene, room: int, door: Doorway) -> list[tuple[float, float]]:
    """The corners of a doorway's opening in the floor plan, a little wider than it is."""
    half = door.width / 2 + 0.02
    wall = min((edge.wall for edge in scene.rooms[room].edges), key=lambda one: one.distance(door.x, door.y))
    begin, end = wall.ends
    ux, uy = ((end[i] - begin[i]) / math.dist(begin, end) for i in (0, 1))
    if wall.axis == "x":
        (a, b), (c, d) = (half * ux, half * uy), (-0.06 * uy, 0.06 * ux)
    else:
        (a, b), (c, d) = (0.06 * uy, -0.06 * ux), (half * ux, half * uy)
    return [(door.x + i * a + j * c, door.y + i * b + j * d) for i in (-1, 1) for j in (-1, 1)]


def _between(
    posts: list[tuple[float, float]], eye: tuple[float, float], low: float, high: float
) -> tuple[float, float]:
    """The part of a range of directions, which may be more than a turn around, that lies between some points."""
    angles = [math.atan2(y - eye[1], x - eye[0]) for x, y in posts]
    first = angles[0]
    spread = [math.remainder(angle - first, math.tau) for angle in angles]
    begin, end = first + min(spread), first + max(spread)
    if high - low >= math.tau - 1e-9:
        return begin, end
    middle = (low + high) / 2
    shift = math.remainder((begin + end) / 2 - middle, math.tau) + middle - (begin + end) / 2
    return max(low, begin + shift), min(high, end + shift)
