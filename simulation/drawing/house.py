"""A home's shell as triangles: floors, walls, ceilings, lintels; and where daylight comes in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coopera.simulation.drawing.geometry import Mesh, Solid, fine_box, flat_uv, merged, painted
from coopera.simulation.drawing.materials import PANE, Material, wooden
from coopera.simulation.homes.catalogue import catalogue, parts_of
from coopera.simulation.homes.floorplan import PARALLEL, WALL_THICKNESS, Block, Wall, wall_on
from coopera.simulation.homes.scene import Doorway, Room, Scene, rgb_of
from coopera.simulation.shapes.kit import WHITE, Colour, shade
from coopera.simulation.shapes.rotations import about_z

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
    grain = 0 if room.x1 - room.x0 >= room.y1 - room.y0 else 1
    bare = Material.PLAIN if kind is None else Material.CARPET
    material = Material.TILES if room.kind in _TILED else Material.PLANKS if wooden(ground) else bare
    low = [("floor", _level(room, 0.0, 0.025, ground, material, grain))]
    above = [("ceiling", _level(room, WALL_HEIGHT, -0.02, _CEILING, Material.PAINT, 0))]
    side = Material.WALL_TILES if room.kind == "bathroom" else Material.PAINT
    for wall in walls:
        for face in faces_of(room, wall):
            low.append(("wall", _wall(face, 0.0, WALL_HEIGHT, paint, side, 2 if side == Material.PAINT else 0)))
            if room.kind not in _TILED:
                board = face._replace(half_x=face.half_x + 0.006, half_y=face.half_y + 0.006)
                low.append(("wall", _wall(board, 0.0, _SKIRTING, shade(WHITE, 0.97), Material.PLAIN, 0)))
    for door in scene.doors:
        if room.name in door.between:
            above += [("wall", lintel) for lintel in _lintel(room, door, paint)]
    return Shell(low, above)


def loose_walls(walls: Sequence[Wall]) -> Mesh:
    """The walls of an imported home, as they stand."""
    return merged([_wall(wall.block, 0.0, WALL_HEIGHT, shade(WHITE, 0.94), Material.PAINT, 2) for wall in walls])


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


def faces_of(room: Room, wall: Wall) -> list[Block]:
    """The room's own half of a wall on its edge, for each side of the room that it stands on."""
    quarter, line, found = WALL_THICKNESS / 4, wall.line, []
    for side, inward, turns_in in room.edges:
        start, end = max(wall.start, side.start), min(wall.end, side.end)
        own = side.line
        if side.axis != wall.axis or end - start < 0.02 or abs(own.slope - line.slope) > PARALLEL:
            continue
        middle = (start + end) / 2
        if abs(own.across(middle) - line.across(middle)) >= 0.03:
            continue
        # where the room goes on around the end of a wall, the corner is filled
        start -= WALL_THICKNESS / 2 if turns_in[0] and start == side.start else 0.0
        end += WALL_THICKNESS / 2 if turns_in[1] and end == side.end else 0.0
        middle, half = (start + end) / 2, (end - start) / 2
        if wall.axis == "x" and not wall.rise:
            found.append(Block(middle, wall.at + inward[1] * quarter, half, quarter))
        elif not wall.rise:
            found.append(Block(wall.at + inward[0] * quarter, middle, quarter, half))
        else:
            x, y, along, _, yaw = wall_on(line, start, end).block
            found.append(Block(x + inward[0] * quarter, y + inward[1] * quarter, along, quarter, yaw))
    return found


def _lintel(room: Room, door: Doorway, paint: Colour) -> list[Mesh]:
    """The room's half of the wall over a door."""
    found = []
    for line in (edge.wall.line for edge in room.edges):
        along, half = door.x if line.axis == "x" else door.y, door.width / 2 / math.hypot(1.0, line.slope)
        over = wall_on(line, along - half, along + half)
        for face in faces_of(room, over) if line.aside(door.x, door.y) < 0.05 else []:
            found.append(_wall(face, LINTEL, WALL_HEIGHT, paint, Material.PAINT, 2))
    return found


def _level(room: Room, at: float, thick: float, colour: Colour, material: Material, grain: int) -> Mesh:
    """A floor, or a ceiling where `thick` is negative, its visible side at a height."""
    triangles = room.triangles(_STEP)
    if triangles is None:
        w, d = room.x1 - room.x0, room.y1 - room.y0
        half = (w / 2, d / 2, abs(thick))
        return _slab((*room.bounds.middle, at - thick), half, colour, material, grain)
    corners = np.full((3 * len(triangles), 3), at, dtype=np.float32)
    corners[:, :2] = triangles[:, :: 1 if thick > 0 else -1].reshape(-1, 2)
    normal = np.tile(np.array((0.0, 0.0, math.copysign(1.0, thick)), dtype=np.float32), (len(corners), 1))
    faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    return painted(Solid(corners, normal, flat_uv(corners, normal, grain), faces), colour, material)


def _wall(block: Block, low: float, high: float, colour: Colour, material: Material, grain: int) -> Mesh:
    """An upright piece of wall from one height to another."""
    half = (block.half_x, block.half_y, (high - low) / 2)
    if not block.yaw:
        return _slab((block.x, block.y, low + half[2]), half, colour, material, grain)
    return _slab((0.0, 0.0, low + half[2]), half, colour, material, grain).moved(
        (block.x, block.y, 0.0), about_z(block.yaw)
    )


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
