"""The flat with a kitchen that one can cook in, for tests of acts and of what they change."""

from __future__ import annotations

import math

from coopera.simulation import World
from coopera.simulation.homes.scene import Scene
from tests.simulation.flat import Row, flat, move, objects, put

KITCHEN: list[Row] = [
    ("fridge_1", "large kitchen appliance", (6.8, 4.6, 0.0), math.pi, (0.65, 0.66, 1.28), None),
    ("stove_1", "large kitchen appliance", (7.7, 4.6, 0.0), math.pi, (0.62, 0.62, 0.9), None),
    ("kitchen_sink_1", "kitchen bathroom fixture", (7.4, 0.35, 0.0), 0.0, (1.1, 0.62, 0.9), None),
    ("frying_pan_1", "kitchen ware", (8.6, 2.3, 0.9), 0.0, (0.44, 0.25, 0.05), "kitchen_counter_1"),
    ("plate_1", "dining ware", (6.65, 3.2, 0.75), 0.0, (0.25, 0.25, 0.025), "dining_table_1"),
    ("hat_1", "wearable", (2.3, 2.2, 0.44), 0.0, (0.2, 0.2, 0.1), "coffee_table_1"),
]


def kitchen() -> Scene:
    """The flat with a fridge, a stove and a sink, and some things to use there."""
    home = flat()
    return home.model_copy(update={"objects": [*home.objects, *objects(KITCHEN, 100)]})


HOME = kitchen()


def moves(target: str, in_hand: str, motion: str):
    return move(target, in_hand, motion, HOME)


def puts(thing: str, receptacle: str, relation="on"):
    return put(thing, receptacle, relation, HOME)


def condition(home: World, name: str) -> dict[str, bool | str]:
    return home.state.condition(home.state.find(home.layout, name))
