"""A flat of rooms that are no rectangles: an L around a kitchen, and a bedroom behind a slanted wall."""

from __future__ import annotations

from typing import Any

from coopera.simulation.homes.scene import Scene

LIVING = [[0, 0], [6, 0], [6, 3], [3, 3], [3, 6], [0, 6]]
KITCHEN = [[3, 3], [6, 3], [8, 5], [8, 6], [3, 6]]
BEDROOM = [[6, 0], [8, 0], [8, 5], [6, 3]]


def polygon_flat() -> dict[str, Any]:
    """The flat as its file has it: doors in a straight wall and in the slanted one."""
    table = {"id": 0, "name": "table_1", "cls": "dining_table", "category": "support furniture", "fixed": True}
    table |= {"room": "living room", "position": [1.5, 4.5, 0], "size": [1.2, 0.8, 0.75], "colour": "#aa7744"}
    counter = {"id": 1, "name": "counter_1", "cls": "kitchen_counter", "category": "support furniture", "fixed": True}
    counter |= {"room": "living room", "position": [4.5, 2.64, 0], "yaw": 3.1416, "size": [1.2, 0.6, 0.9]}
    mug = {"id": 2, "name": "mug_1", "cls": "mug", "category": "dining ware", "fixed": False, "room": "living room"}
    mug |= {"position": [1.2, 4.5, 0.75], "size": [0.12, 0.08, 0.09], "colour": "#3366cc", "on": "table_1"}
    return {
        "id": "polygons",
        "rooms": [
            {"name": "living room", "kind": "living room", "polygon": LIVING},
            {"name": "kitchen", "kind": "kitchen", "polygon": KITCHEN},
            {"name": "bedroom", "kind": "bedroom", "polygon": BEDROOM},
        ],
        "doors": [
            {"between": ["living room", "kitchen"], "x": 3, "y": 4.5},
            {"between": ["kitchen", "bedroom"], "x": 7, "y": 4},
        ],
        "objects": [table, {**counter, "colour": "#e4e0d4"}, mug],
    }


def polygon_scene() -> Scene:
    """The flat as a scene."""
    return Scene.model_validate(polygon_flat())
