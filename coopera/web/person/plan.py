"""The plan of a home as a drawing: rooms, doors, furniture to click, and where things lie."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from coopera.core.household import plain
from coopera.simulation import Scene
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Room

MARGIN = 0.25  # metres around the home
_SMALL = 0.30  # metres; below it furniture is drawn without a name


class Box(NamedTuple):
    """Something that stands on the plan: its middle, size and turn (degrees, clockwise), in metres from the corner."""

    name: str
    words: str
    x: float
    y: float
    width: float
    depth: float
    turn: float
    colour: str
    known: bool
    labelled: bool


class Dot(NamedTuple):
    """A movable thing, or somebody."""

    name: str
    words: str
    x: float
    y: float
    known: bool


class Area(NamedTuple):
    """A room: the corners of its floor as SVG writes them, and where its name stands."""

    name: str
    corners: str
    x: float
    y: float


class Place(NamedTuple):
    """The opening of a door."""

    name: str
    x: float
    y: float
    width: float
    height: float


class Plan(NamedTuple):
    """A home seen from above, in metres; `bodies` are the person and the robot where that is known."""

    width: float
    height: float
    rooms: list[Area]
    doors: list[Place]
    furniture: list[Box]
    things: list[Dot]
    bodies: list[Dot]


def _top(room: Room) -> Point:
    """Where a room's name stands: below the middle of its highest side."""
    (x0, y0), (x1, y1) = max((edge.wall.ends for edge in room.edges), key=lambda ends: (ends[0][1] + ends[1][1], ends))
    return (x0 + x1) / 2, (y0 + y1) / 2 - 0.36


def plan_of(
    scene: Scene, *, places: Collection[str] = (), things: Collection[str] = (), now: Mapping[str, Any] | None = None
) -> Plan:
    """Draw a home.

    Args:
        scene: The home as it was built.
        places: Furniture that may be chosen now.
        things: Movable things that may be chosen now.
        now: How the last hour left it (`HourRecord.world["poses"]`).
    """
    left, bottom = min(room.x0 for room in scene.rooms), min(room.y0 for room in scene.rooms)
    right, top = max(room.x1 for room in scene.rooms), max(room.y1 for room in scene.rooms)

    def at(x: float, y: float) -> tuple[float, float]:
        return round(x - left + MARGIN, 3), round(top - y + MARGIN, 3)

    rooms = [
        Area(one.name, " ".join("{},{}".format(*at(*corner)) for corner in one.outline), *at(*_top(one)))
        for one in scene.rooms
    ]
    doors = []
    for door in scene.doors:
        beside = (edge.wall for room in scene.rooms if room.name in door.between for edge in room.edges)
        flat = min(beside, key=lambda wall: wall.distance(door.x, door.y)).axis == "x"
        wide, high = (door.width, 0.16) if flat else (0.16, door.width)
        x, y = at(door.x, door.y)
        doors.append(Place(" – ".join(door.between), round(x - wide / 2, 3), round(y - high / 2, 3), wide, high))
    moved: Mapping[str, Any] = (now or {}).get("moved", {})
    furniture, dots = [], []
    for thing in scene.objects:
        x, y = at(*moved.get(thing.name, {}).get("position", thing.position)[:2])
        if thing.fixed:
            wide, deep = thing.size[0], thing.size[1]
            furniture.append(
                Box(
                    thing.name,
                    plain(thing.name),
                    x,
                    y,
                    wide,
                    deep,
                    round(-math.degrees(thing.yaw), 1),
                    thing.colour,
                    thing.name in places,
                    max(wide, deep) >= _SMALL,
                )
            )
        else:
            dots.append(Dot(thing.name, plain(thing.name), x, y, thing.name in things))
    furniture.sort(key=lambda box: -box.width * box.depth)
    bodies = []
    for name, body in (now or {}).get("agents", {}).items():
        spot = body.get("place") or body.get("spot")
        if spot:
            bodies.append(Dot(str(body.get("kind", name)), name, *at(*spot[:2]), known=False))
    return Plan(
        round(right - left + 2 * MARGIN, 3), round(top - bottom + 2 * MARGIN, 3), rooms, doors, furniture, dots, bodies
    )
