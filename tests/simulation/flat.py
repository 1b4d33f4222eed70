"""A small flat for tests: a living room and a kitchen, with a door between them."""

from __future__ import annotations

import math
from functools import cache
from typing import TypeAlias

from coopera.core.affordances import Relation
from coopera.core.household import FreeMotion, HandOver, PickPlace
from coopera.simulation.homes.scene import Doorway, Room, Scene, SceneObject

Row: TypeAlias = tuple[str, str, tuple[float, float, float], float, tuple[float, float, float], str | None]
"""An object: its name, its category, its place, its heading, its size, and what carries it."""
_FIXED = {"seating", "support", "sleeping furniture", "kitchen bathroom fixture", "large kitchen appliance"}
_ROWS: list[Row] = [
    ("sofa_1", "seating", (2.0, 0.5, 0), 0.0, (2.0, 0.9, 0.82), None),
    ("coffee_table_1", "support", (2.0, 2.2, 0), math.pi, (1.1, 0.6, 0.44), None),
    ("bed_1", "sleeping furniture", (0.9, 4.0, 0), -math.pi / 2, (1.6, 1.8, 1.0), None),
    ("kitchen_counter_1", "support", (8.6, 2.0, 0), math.pi / 2, (0.95, 0.62, 0.9), None),
    ("dining_table_1", "support", (6.2, 3.2, 0), 0.0, (1.5, 0.9, 0.75), None),
    ("dining_chair_1", "seating", (6.2, 2.55, 0), 0.0, (0.44, 0.46, 0.9), None),
    ("washbasin_1", "kitchen bathroom fixture", (6.0, 0.3, 0), 0.0, (0.78, 0.48, 0.88), None),
    ("mug_1", "drinkware", (8.5, 2.0, 0.9), 0.0, (0.12, 0.08, 0.09), "kitchen_counter_1"),
    ("book_1", "book", (2.0, 2.2, 0.44), 0.0, (0.16, 0.23, 0.035), "coffee_table_1"),
    ("apple_1", "food", (6.3, 3.5, 0.75), 0.0, (0.078, 0.078, 0.08), "dining_table_1"),
    ("cushion_1", "textile", (2.6, 0.65, 0.41), 0.0, (0.42, 0.42, 0.14), "sofa_1"),
    ("tennis_ball_1", "toy", (3.3, 3.6, 0.0), 0.0, (0.066, 0.066, 0.066), None),
    ("laundry_basket_1", "container", (5.0, 4.2, 0.0), 0.0, (0.48, 0.36, 0.42), None),
]


def flat() -> Scene:
    rooms = [
        Room(name="living room", kind="living room", x0=0, y0=0, x1=4.5, y1=5),
        Room(name="kitchen", kind="kitchen", x0=4.5, y0=0, x1=9, y1=5),
    ]
    doors = [Doorway(between=("living room", "kitchen"), x=4.5, y=2.5)]
    return Scene(id="flat", rooms=rooms, doors=doors, objects=objects(_ROWS, 10))


def objects(rows: list[Row], first: int) -> list[SceneObject]:
    """Objects of the flat, with ids from the first one on."""
    return [
        SceneObject(
            id=first + i,
            name=name,
            cls=name.rsplit("_", 1)[0],
            category=category,
            fixed=category in _FIXED,
            room="living room" if position[0] < 4.5 else "kitchen",
            position=position,
            yaw=yaw,
            size=size,
            colour="#8a5a32",
            on=carrier,
        )
        for i, (name, category, position, yaw, size, carrier) in enumerate(rows)
    ]


def put(thing: str, receptacle: str, relation: Relation = "on", scene: Scene | None = None) -> PickPlace:
    """An act in a home, by default the flat."""
    there = _number(receptacle, scene)
    return PickPlace(
        object_id=_number(thing, scene), object=thing, receptacle_id=there, receptacle=receptacle, relation=relation
    )


def move(target: str, in_hand: str, motion: str, scene: Scene | None = None) -> FreeMotion:
    """An act in a home, by default the flat."""
    return FreeMotion(target_id=_number(target, scene), target=target, in_hand=in_hand, motion=motion)


@cache
def _flat() -> Scene:
    return flat()


def _number(name: str, scene: Scene | None) -> int:
    """The id of an object; a name that the home does not have gets one that nothing has."""
    found = (scene or _flat()).object(name)
    return 9999 if found is None else found.id


def bring(thing: str) -> HandOver:
    return HandOver(object=thing)
