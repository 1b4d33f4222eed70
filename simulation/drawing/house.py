"""A home's shell as triangles: floors, walls, ceilings, lintels; and where daylight comes in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coopera.simulation.drawing.geometry import Mesh, fine_box, flat_uv, merged, painted
from coopera.simulation.drawing.materials import PANE, Material, wooden
from coopera.simulation.homes.catalogue import catalogue, parts_of
from coopera.simulation.homes.floorplan import WALL_THICKNESS, Wall
from coopera.simulation.homes.scene import Doorway, Room, Scene, rgb_of
from coopera.simulation.shapes.kit import WHITE, Colour, shade

WALL_HEIGHT = 2.4
LINTEL = 2.06
"""Height of a doorway."""
_CEILING: Colour = (0.96, 0.955, 0.945)
_SKIRTING = 0.07
_STEP = 0.8
"""Floors and walls are divided into pieces no larger, since daylight is reckoned at their corners."""
_TILED = ("kitchen", "bathroom", "laundry room", "garage")


class Window(NamedTuple):
    """An opening for daylight: a rectangle in a wall that runs along `axis`; light comes in along `inward`."""

    axis: int
    """0 where the wall runs along x, 1 where along y."""
    at: float
    start: float
    end: float
    low: float
    high: float
    inward: float
    """1.0 or -1.0 along the other axis."""


class Shell(NamedTuple):
    """What a room is made of: what is always seen, and what is left out for a camera above it."""

    low: list[tuple[str, Mesh]]
    """Class ("floor", "wall") and triangles."""
    above: list[tuple[str, Mesh]]


def shell(scene: Scene, room: Room, walls: Sequence[Wall]) -> Shell:
    """Floor, walls and ceiling of a room; each wall is half of what two rooms share."""
    kind = catalogue().rooms.get(room.kind)
    ground = rgb_of(kind.floor) if kind else (0.7, 0.66, 0.6)
    paint = rgb_of(kind.wall) if kind else WHITE
    w, d = room.x1 - room.x0, room.y1 - room.y0
    cx, cy = room.centre
    grain = 0 if w >= d else 1
    bare = Material.PLAIN if kind is None else Material.CARPET
    material = Material.TILES if room.kind in _TILED else Material.PLANKS if wooden(ground) else bare
    low = [("floor", _slab((cx, cy, -0.025), (w / 2, d / 2, 0.025), ground, material, grain))]
    above = [("ceiling", _slab((cx, cy, WALL_HEIGHT + 0.02), (w / 2, d / 2, 0.02), _CEILING, Material.PAINT, 0))]
    side = Material.WALL_TILES if room.kind == "bathroom" else Material.PAINT
    for wall in walls:
        for x, y, along in faces_of(room, wall):
            half = (along / 2, WALL_THICKNESS / 4) if wall.axis == "x" else (WALL_THICKNESS / 4, along / 2)
            middle = WALL_HEIGHT / 2
            low.append(
                ("wall", _slab((x, y, middle), (*half, middle), paint, side, 2 if side == Material.PAINT else 0))
            )
            if room.kind not in _TILED:
                board = (half[0] + 0.006, half[1] + 0.006, _SKIRTING / 2)
                low.append(("wall", _slab((x, y, _SKIRTING / 2), board, shade(WHITE, 0.97), Material.PLAIN, 0)))
    for door in scene.doors:
        if room.name in door.between:
            above += [("wall", lintel) for lintel in _lintel(room, door, paint)]
    return Shell(low, above)


def loose_walls(walls: Sequence[Wall]) -> Mesh:
    """The walls of an imported home, as they stand."""
    found = []
    for wall in walls:
        b, middle = wall.bounds, WALL_HEIGHT / 2
        half = ((b.x1 - b.x0) / 2, (b.y1 - b.y0) / 2, middle)
        found.append(_slab(((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, middle), half, shade(WHITE, 0.94), Material.PAINT, 2))
    return merged(found)


def windows(scene: Scene) -> dict[str, list[Window]]:
    """Where daylight comes into each room that has a window, the largest first."""
    found: dict[str, list[Window]] = {}
    for thing in scene.fixed:
        for part in parts_of(thing.cls, thing.size, thing.rgb):
            quarter = round(thing.yaw / (math.pi / 2))
            if part.rgba[:3] != PANE or abs(thing.yaw - quarter * math.pi / 2) > 0.02:
                continue
            x, y, _ = thing.to_world(part.position[0], part.position[1], 0.0)
            low = thing.position[2] + part.position[2] - part.half[2]
            wide, facing = part.half[0], quarter % 4
            axis = facing % 2
            at, middle = (y, x) if axis == 0 else (x, y)
            inward = 1.0 if facing in (0, 3) else -1.0
            opening = Window(axis, at, middle - wide, middle + wide, low, low + 2 * part.half[2], inward)
            found.setdefault(thing.room, []).append(opening)
    for room in found.values():
        room.sort(key=lambda one: ((one.start - one.end) * (one.high - one.low), one))
    return found


def sunlight(scene: Scene) -> tuple[float, float, float]:
    """The direction towards the sun: of eight, that from which most light comes in."""
    openings = [one for room in windows(scene).values() for one in room]
    steep = math.radians(52)

    def lit(angle: float) -> float:
        return sum(
            (one.end - one.start)
            * (one.high - one.low)
            * max(-one.inward * (math.sin(angle) if one.axis == 0 else math.cos(angle)), 0.0)
            for one in openings
        )

    angles = [math.radians(31 + 45 * k) for k in range(8)]
    angle = max(angles, key=lambda one: round(lit(one), 6))
    return math.cos(angle) * math.cos(steep), math.sin(angle) * math.cos(steep), math.sin(steep)


def faces_of(room: Room, wall: Wall) -> list[tuple[float, float, float]]:
    """The room's own half of a wall on its edge: middle of the piece and its length; empty if it is elsewhere."""
    quarter = WALL_THICKNESS / 4
    low, high = (room.x0, room.x1) if wall.axis == "x" else (room.y0, room.y1)
    edges = (room.y0, room.y1) if wall.axis == "x" else (room.x0, room.x1)
    start, end = max(wall.start, low), min(wall.end, high)
    if end - start < 0.02:
        return []
    found = []
    for edge, inwards in ((edges[0], 1), (edges[1], -1)):
        if abs(edge - wall.at) < 0.03:
            along, across = (start + end) / 2, wall.at + inwards * quarter
            found.append((along, across, end - start) if wall.axis == "x" else (across, along, end - start))
    return found


def _lintel(room: Room, door: Doorway, paint: Colour) -> list[Mesh]:
    """The room's half of the wall over a door."""
    half = door.width / 2
    walls = [
        Wall("x", room.y0, door.x - half, door.x + half),
        Wall("x", room.y1, door.x - half, door.x + half),
        Wall("y", room.x0, door.y - half, door.y + half),
        Wall("y", room.x1, door.y - half, door.y + half),
    ]
    found = []
    for wall in walls:
        across = abs((door.y if wall.axis == "x" else door.x) - wall.at)
        for x, y, along in faces_of(room, wall) if across < 0.05 else []:
            tall = (WALL_HEIGHT - LINTEL) / 2
            sides = (along / 2, WALL_THICKNESS / 4) if wall.axis == "x" else (WALL_THICKNESS / 4, along / 2)
            found.append(_slab((x, y, LINTEL + tall), (*sides, tall), paint, Material.PAINT, 2))
    return found


def _slab(
    middle: tuple[float, float, float],
    half: tuple[float, float, float],
    colour: Colour,
    material: Material,
    grain: int,
) -> Mesh:
    """A box in the world, its picture lying in the world's own measures so that neighbours fit together."""
    solid = fine_box(half, _STEP)
    at = solid.at + np.asarray(middle, dtype=np.float32)
    return painted(solid._replace(at=at, uv=flat_uv(at, solid.normal, grain)), colour, material)
