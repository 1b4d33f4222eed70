"""Find out what is wrong with a home before anyone lives in it: each problem is one sentence naming the object."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations

from coopera.core.errors import SimulationError
from coopera.simulation.homes.catalogue import FLAT, surfaces
from coopera.simulation.homes.floorplan import Wall
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.homes.spots import Taken, furniture_on, spots, taken_by
from coopera.simulation.ways.navigation import REACH, Navigator

FLOOR_REACH = 0.60
"""Farthest at which a thing on the floor can be taken: the arm points down."""
_SLACK = 0.02
_SMALL = (0.08, 0.08, 0.09)
_FLOATING = 0.03
_ON_WALL = 1.0
"""Furniture whose base is higher hangs on a wall: nobody need walk up to it (metres)."""


def check(scene: Scene) -> list[str]:
    """Return all problems of a home, empty for a good one; the order is that of the checks and of the scene.

    It finds overlapping rooms, doors into nothing, objects outside their room, objects inside each other, and floating
    things. It finds rooms without a way in, furniture without a place to stand or to put a thing, and things out of
    reach.
    """
    problems = [*_rooms(scene), *_doors(scene), *_places(scene), *_overlaps(scene), *_supports(scene)]
    try:
        navigator = Navigator(scene)
    except SimulationError as err:
        return [*problems, str(err)]
    return [*problems, *_access(scene, navigator)]


def _rooms(scene: Scene) -> Iterator[str]:
    if scene.stage is not None:  # a room may be imported as the rectangle around it
        return
    for a, b in combinations(scene.rooms, 2):
        if a.overlaps(b, _SLACK):
            yield f"The rooms {a.name} and {b.name} overlap."


def _doors(scene: Scene) -> Iterator[str]:
    if scene.stage is not None:
        return
    lines = {wall.line for wall in scene.model_copy(update={"doors": []}).walls()}
    walls = scene.walls()
    for door in scene.doors:
        pair = f"The door between {door.between[0]} and {door.between[1]}"
        touching = [
            room.name for room in scene.rooms if room.distance(door.x, door.y) < 0.05 and room.name in door.between
        ]
        on_wall = any(line.aside(door.x, door.y) < 0.05 for line in lines) and not _closed(walls, door.x, door.y)
        if len(touching) < 2 or not on_wall:
            yield f"{pair} does not stand on a wall that both share."


def _closed(walls: Sequence[Wall], x: float, y: float) -> bool:
    """Whether a wall still stands where a door should be."""
    return any(
        wall.line.aside(x, y) < 0.05 and wall.start + _SLACK < (x if wall.axis == "x" else y) < wall.end - _SLACK
        for wall in walls
    )


def _places(scene: Scene) -> Iterator[str]:
    for thing in scene.objects:
        room = scene.room(thing.room)
        if room is None:  # the schema forbids it
            continue
        if not room.encloses(thing.bounds, _SLACK):
            yield f"{thing.name} {'stands' if thing.fixed else 'lies'} outside its room, the {room.name}."
        if thing.position[2] < -_SLACK:
            yield f"{thing.name} is sunk into the floor."


def _overlaps(scene: Scene) -> Iterator[str]:
    for a, b in combinations(scene.objects, 2):
        if a.on == b.name or b.on == a.name or (a.fixed and b.fixed and min(a.size[2], b.size[2]) <= FLAT):
            continue
        if _collide(taken_by(a), taken_by(b)):
            yield f"{a.name} and {b.name} overlap."


def _collide(a: Taken, b: Taken) -> bool:
    """Whether two spaces share more than a centimetre in every direction."""
    return a.low < b.high - 0.01 and b.low < a.high - 0.01 and a.bounds.overlaps(b.bounds, -0.01)


def _supports(scene: Scene) -> Iterator[str]:
    for thing in scene.movable:
        if thing.on is None:
            if thing.position[2] > _FLOATING:
                yield f"{thing.name} floats {thing.position[2]:.2f} m above the floor: `on` names nothing."
            continue
        carrier = scene.object(thing.on)
        if carrier is None:  # the schema forbids it
            continue
        if carrier.room != thing.room:
            yield f"{thing.name} is in the {thing.room}, but {carrier.name} in the {carrier.room}."
        x, y = carrier.to_local(*thing.xy)
        if abs(x) > carrier.size[0] / 2 + _SLACK or abs(y) > carrier.size[1] / 2 + _SLACK:
            yield f"{thing.name} does not lie over {carrier.name}, which should carry it."
        heights = [carrier.position[2] + surface.z for surface in surfaces(carrier)]
        if not any(abs(thing.position[2] - height) <= _FLOATING for height in heights):
            known = ", ".join(f"{height:.2f}" for height in heights) or "none"
            yield f"{thing.name} is at height {thing.position[2]:.2f} m, but {carrier.name} carries things at {known}."


def _access(scene: Scene, navigator: Navigator) -> Iterator[str]:
    for room in scene.rooms:
        if not len(navigator.cells_in(room.name)):
            yield f"Nobody can get into the {room.name}."
    for thing in scene.fixed:
        if thing.position[2] >= _ON_WALL:
            continue
        stands = navigator.approach(thing, most=60)
        if not stands:
            yield f"Nobody can walk up to {thing.name} in the {thing.room}."
        elif surfaces(thing) and not any(
            math.dist((spot.x, spot.y), (stand.x, stand.y)) <= REACH
            for spot in spots(thing, _SMALL, furniture_on(scene, thing))
            for stand in stands
        ):
            yield f"Nobody can put even a small thing on {thing.name} in the {thing.room}."
    for thing in scene.movable:
        if not can_take(scene, navigator, thing):
            yield f"Nobody can reach {thing.name} in the {thing.room}."


def can_take(scene: Scene, navigator: Navigator, thing: SceneObject) -> bool:
    """Whether a movable thing, in its initial place, is within reach of a place to stand."""
    carrier = scene.object(thing.on) if thing.on is not None else None
    if carrier is None:
        return bool(navigator.approach(thing.xy, reach=FLOOR_REACH, most=1))
    reach = FLOOR_REACH if thing.position[2] < 0.1 else REACH
    return bool(navigator.approach(carrier, point=thing.xy, reach=reach, most=1))
