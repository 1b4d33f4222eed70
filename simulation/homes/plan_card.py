"""A home's floor plan as one SVG that loads nothing: rooms with their names, walls, furniture and small things."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from markupsafe import Markup

from coopera.simulation.homes.floorplan import WALL_THICKNESS, Bounds, Wall

_EDGE = 0.2  # metres around the rooms
_LETTER = 0.042  # height of a room's name, as a part of the home's width
_FLOOR, _WALL, _INK = "#efe9dc", "#6d675c", "#3a362e"


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
    rooms: Sequence[tuple[str, Bounds]], walls: Sequence[Wall], objects: Sequence[Footprint], *, wide: int = 560
) -> Markup:
    """Draw a plan, north (+y) up; each object tells its name to a pointer that rests on it.

    Args:
        rooms: At least one, by name.
        walls: As the home has them, open at doors.
        objects: Those drawn later lie on top.
        wide: Width on the page in pixels; the plan shrinks with a narrow page.
    """
    x0, y1 = min(one.x0 for _, one in rooms) - _EDGE, max(one.y1 for _, one in rooms) + _EDGE
    width, height = max(one.x1 for _, one in rooms) + _EDGE - x0, y1 + _EDGE - min(one.y0 for _, one in rooms)
    floors = [_box(b.x0, b.y0, b.x1 - b.x0, b.y1 - b.y0, _FLOOR) for _, b in rooms]
    marks = [*floors, *(_thing(one) for one in objects), *(_wall(one) for one in walls)]
    names = [_name(name, bounds, width) for name, bounds in rooms]
    return Markup(
        '<svg role="img" aria-label="Floor plan" style="width:100%;max-width:{}px;height:auto;border-radius:8px" '
        'viewBox="{:.2f} {:.2f} {:.2f} {:.2f}"><g transform="scale(1,-1)">{}</g>{}</svg>'
    ).format(wide, x0, -y1, width, height, Markup("").join(marks), Markup("").join(names))


def _box(x: float, y: float, width: float, height: float, colour: str) -> Markup:
    box = '<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>'
    return Markup(box).format(x, y, width, height, colour)


def _wall(wall: Wall) -> Markup:
    half, length = WALL_THICKNESS / 2, wall.end - wall.start
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


def _name(name: str, bounds: Bounds, width: float) -> Markup:
    return Markup(
        '<text x="{:.2f}" y="{:.2f}" font-size="{:.2f}" text-anchor="middle" fill="{}" stroke="{}" '
        'stroke-width="{:.3f}" paint-order="stroke" font-family="system-ui,sans-serif">{}</text>'
    ).format(
        (bounds.x0 + bounds.x1) / 2,
        -(bounds.y0 + bounds.y1) / 2,
        min(_LETTER * width, (bounds.x1 - bounds.x0) / max(4, 0.62 * len(name))),
        _INK,
        _FLOOR,
        0.006 * width,
        name,
    )
