"""Rooms and doors of a ProcTHOR house: its polygons as they are, doors as gaps in the walls that two rooms share."""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from pydantic import ValidationError

from coopera.core.errors import ConfigError
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Doorway, Room
from coopera.simulation.making.procthor.files import Hole, House

NARROWEST, WIDEST = 0.7, 3.0
_TRIM = 0.06
"""The ends of a wall that is open as a whole are kept clear of the corners, in metres."""


class Plan(NamedTuple):
    """Rooms by the house's ids, doors, and what was guessed and left out."""

    rooms: dict[str, Room]
    doors: list[Doorway]
    guessed: list[str]
    left_out: list[str]


def plan_of(house: House, path: Path) -> Plan:
    """Take over rooms and doors.

    Raises:
        ConfigError: If a room's polygon cannot be one, or a room has no door; names file and field.
    """
    rooms = _rooms(house, path)
    guessed: list[str] = []
    left_out = [f"{len(house.windows)} windows: the walls stand whole there"] * bool(house.windows)
    doors: list[Doorway] = []
    for number, hole in enumerate(house.doors):
        what = f"doors.{number} ({hole.id})"
        found = _doorway(hole, house, rooms)
        if isinstance(found, str):
            left_out.append(f"{what}: {found}")
        else:
            doors.append(found[0])
            guessed += [f"{what}: {found[1]}"] * bool(found[1])
    doors += _open_walls(house, rooms)
    _need_doors(house, rooms, doors, path)
    return Plan(rooms, doors, guessed, left_out)


def _rooms(house: House, path: Path) -> dict[str, Room]:
    rooms: dict[str, Room] = {}
    count: Counter[str] = Counter()
    for number, row in enumerate(house.rooms):
        kind = " ".join(re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", row.kind)).lower()[:50] or "room"
        count[kind] += 1
        name = kind if count[kind] == 1 else f"{kind} {count[kind]}"
        where = f"{path}, field rooms.{number}.floorPolygon"
        try:
            room = Room.model_validate({"name": name, "kind": kind, "polygon": [one.plan for one in row.corners]})
        except ValidationError as err:
            raise ConfigError(f"{where}: {err.errors()[0]['msg'].removeprefix('Value error, ')}.") from err
        if row.id in rooms:
            raise ConfigError(f"{path}, field rooms.{number}.id: there are two rooms {row.id!r}.")
        whole = room.polygon is not None and len(room.polygon) == 4 and all(not e.wall.rise for e in room.edges)
        rooms[row.id] = room.model_copy(update={"polygon": None}) if whole else room
    return {key: Room.model_validate(room.model_dump()) for key, room in rooms.items()}


def _doorway(hole: Hole, house: House, rooms: dict[str, Room]) -> tuple[Doorway, str] | str:
    """A door, and what was guessed of it; or why it is left out."""
    first, second = rooms.get(hole.room0 or ""), rooms.get(hole.room1 or "")
    if first is None or second is None or first is second:
        return "it leads outside and stays shut"
    wall = next((wall for wall in house.walls if wall.id == hole.wall0), None)
    if wall is None or hole.along is None:
        return "its wall, or its place in it, is not said"
    begin, end = wall.foot
    length = math.dist(begin, end)
    low, high = hole.along
    if length <= 0 or not -0.1 <= low < high <= length + 0.1:
        return "it does not lie in its wall"
    middle, width = (low + high) / 2 / length, min(max(high - low, NARROWEST), WIDEST)
    x, y = (begin[i] + (end[i] - begin[i]) * middle for i in (0, 1))
    changed = "" if abs(width - (high - low)) < 0.01 else f"{high - low:.2f} m wide in the house, {width:.2f} m here"
    return Doorway(between=(first.name, second.name), x=round(x, 4), y=round(y, 4), width=round(width, 4)), changed


def _open_walls(house: House, rooms: dict[str, Room]) -> list[Doorway]:
    """Walls between two rooms where nothing stands, as openings of at most three metres side by side."""
    sides: dict[tuple[Point, ...], list[str]] = {}
    for wall in house.walls:
        if wall.empty and wall.room in rooms:
            sides.setdefault(tuple(sorted(wall.foot)), []).append(wall.room)
    doors = []
    for (begin, end), both in sorted(sides.items()):
        length = math.dist(begin, end) - 2 * _TRIM
        if len(set(both)) != 2 or length < NARROWEST:
            continue
        count = math.ceil(length / WIDEST)
        names = [rooms[id].name for id in sorted(set(both))]
        for k in range(count):
            share = (_TRIM + length * (k + 0.5) / count) / (length + 2 * _TRIM)
            x, y = (round(begin[i] + (end[i] - begin[i]) * share, 4) for i in (0, 1))
            width = min(round(length / count + 0.001, 4), WIDEST)
            doors.append(Doorway(between=(names[0], names[1]), x=x, y=y, width=width))
    return doors


def _need_doors(house: House, rooms: dict[str, Room], doors: list[Doorway], path: Path) -> None:
    reached = {name for door in doors for name in door.between}
    for number, row in enumerate(house.rooms):
        if len(rooms) > 1 and rooms[row.id].name not in reached:
            raise ConfigError(f"{path}, field rooms.{number}: no door leads from the room {row.id!r} into another.")
