"""A home's floor plan as one SVG that loads nothing: rooms with their names, walls, furniture and small things."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from markupsafe import Markup

from coopera.simulation.homes.floorplan import WALL_THICKNESS, Point, Wall

_EDGE = 0.2  # metres around the rooms
_LETTER = 0.042  # height of a room's name, as a part of the home's width
_FLOOR, _WALL, _INK = "#efe9dc", "#6d675c", "#3a362e"


class Area(NamedTuple):
    """A room: its name, which is written at the middle, and the corners of its floor."""

    name: str
    corners: Sequence[Point]
    middle: Point


class Footprint(NamedTuple):
    """What an object takes of the floor: its middle, width and depth in metres, how it is turned, and its colour."""

    name: str
    x: float
    y: float
    width: float
    depth: float
    yaw: float
    colour: str


def floor_plan(
    rooms: Sequence[Area], walls: Sequence[Wall], objects: Sequence[Footprint], *, wide: int = 560
) -> Markup:
    """Draw a plan, north (+y) up; each object tells its name to a pointer that rests on it.

    Args:
        rooms: At least one.
        walls: As the home has them, open at doors.
        objects: Those drawn later lie on top.
        wide: Width on the page in pixels; the plan shrinks with a narrow page.
    """
    xs, ys = zip(*(corner for room in rooms for corner in room.corners), strict=True)
    x0, y1 = min(xs) - _EDGE, max(ys) + _EDGE
    width, height = max(xs) + _EDGE - x0, y1 + _EDGE - min(ys)
    floors = [_floor(room) for room in rooms]
    marks = [*floors, *(_thing(one) for one in objects), *(_wall(one) for one in walls)]
    names = [_name(room, width) for room in rooms]
    return Markup(
        '<svg role="img" aria-label="Floor plan" style="width:100%;max-width:{}px;height:auto;border-radius:8px" '
        'viewBox="{:.2f} {:.2f} {:.2f} {:.2f}"><g transform="scale(1,-1)">{}</g>{}</svg>'
    ).format(wide, x0, -y1, width, height, Markup("").join(marks), Markup("").join(names))


def _floor(room: Area) -> Markup:
    points = " ".join(f"{x:.2f},{y:.2f}" for x, y in room.corners)
    return Markup('<polygon points="{}" fill="{}"/>').format(points, _FLOOR)


def _box(x: float, y: float, width: float, height: float, colour: str) -> Markup:
    box = '<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>'
    return Markup(box).format(x, y, width, height, colour)


def _wall(wall: Wall) -> Markup:
    half, length = WALL_THICKNESS / 2, wall.end - wall.start
    if wall.rise:
        (x0, y0), (x1, y1) = wall.ends
        line = '<path d="M{:.2f} {:.2f}L{:.2f} {:.2f}" stroke="{}" stroke-width="{:.2f}" stroke-linecap="round"/>'
        return Markup(line).format(x0, y0, x1, y1, _WALL, WALL_THICKNESS)
    if wall.axis == "x":
        return _box(wall.start - half, wall.at - half, length + 2 * half, 2 * half, _WALL)
    return _box(wall.at - half, wall.start - half, 2 * half, length + 2 * half, _WALL)


def _thing(one: Footprint) -> Markup:
    return Markup(
        '<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" rx=".04" fill="{}" stroke="{}" stroke-width=".015" '
        'transform="translate({:.2f} {:.2f}) rotate({:.1f})"><title>{}</title></rect>'
    ).format(
        -one.width / 2,
        -one.depth / 2,
        one.width,
        one.depth,
        one.colour,
        _INK,
        one.x,
        one.y,
        math.degrees(one.yaw),
        one.name,
    )


def _name(room: Area, width: float) -> Markup:
    xs = [x for x, _ in room.corners]
    return Markup(
        '<text x="{:.2f}" y="{:.2f}" font-size="{:.2f}" text-anchor="middle" fill="{}" stroke="{}" '
        'stroke-width="{:.3f}" paint-order="stroke" font-family="system-ui,sans-serif">{}</text>'
    ).format(
        room.middle[0],
        -room.middle[1],
        min(_LETTER * width, (max(xs) - min(xs)) / max(4, 0.62 * len(room.name))),
        _INK,
        _FLOOR,
        0.006 * width,
        room.name,
    )
