"""A house of ProcTHOR in its published form: an L-shaped kitchen open to a living room, and a bedroom behind a door."""

from __future__ import annotations

from typing import Any


def _floor(*corners: tuple[float, float]) -> list[dict[str, float]]:
    return [{"x": x, "y": 0, "z": z} for x, z in corners]


def _wall(id: str, room: str, a: tuple[float, float], b: tuple[float, float], **more: Any) -> dict[str, Any]:
    foot = [{"x": x, "y": 0, "z": z} for x, z in (a, b)]
    top = [{**corner, "y": 2.5} for corner in foot]
    return {"id": id, "roomId": room, "polygon": [*foot, *top], "material": {"name": "Drywall"}, **more}


def thing(id: str, asset: str, x: float, y: float, z: float, turn: float = 0, **more: Any) -> dict[str, Any]:
    """An object as a house has it; y is the height of its middle."""
    place, turned = {"x": x, "y": y, "z": z}, {"x": 0, "y": turn, "z": 0}
    return {"id": id, "assetId": asset, "position": place, "rotation": turned, "kinematic": True, "layer": "A", **more}


def house() -> dict[str, Any]:
    """The house: 4 m x 8 m, its rooms as polygons of which one goes clockwise."""
    living = _floor((0, 4), (0, 8), (4, 8), (4, 6), (2, 6), (2, 4))
    kitchen = _floor((0, 0), (0, 4), (2, 4), (2, 6), (4, 6), (4, 0))
    bedroom = _floor((4, 0), (8, 0), (8, 8), (4, 8))
    hole = [{"x": 1.0, "y": 0, "z": 0}, {"x": 2.0, "y": 2.1, "z": 0}]
    pane = [{"x": 0.5, "y": 0.9, "z": 0}, {"x": 1.5, "y": 1.8, "z": 0}]
    book = thing("Book|4|1", "Book_7", 6.0, 0.55, 7.2)
    walls = [
        _wall("wall|2|2.00|4.00|2.00|6.00", "room|2", (2, 4), (2, 6), empty=True),
        _wall("wall|3|2.00|4.00|2.00|6.00", "room|3", (2, 6), (2, 4), empty=True),
        _wall("wall|3|4.00|0.00|4.00|6.00", "room|3", (4, 6), (4, 0)),
        _wall("wall|4|4.00|0.00|4.00|6.00", "room|4", (4, 0), (4, 6)),
        _wall("wall|exterior|0.00|0.00|0.00|4.00", "exterior", (0, 0), (0, 4)),
    ]
    sides = {"wall0": "wall|3|4.00|0.00|4.00|6.00", "wall1": "wall|4|4.00|0.00|4.00|6.00"}
    door = {
        "id": "door|3|4",
        "assetId": "Doorway_4",
        "room0": "room|3",
        "room1": "room|4",
        **sides,
        "holePolygon": hole,
    }
    way_out = {**door, "id": "door|1|2", "room0": "room|2", "room1": "room|2"}
    return {
        "proceduralParameters": {"floorColliderThickness": 1.0, "lights": [{"id": "light_2"}], "skyboxId": "Sky1"},
        "metadata": {"schema": "1.0.0", "agent": {"horizon": 30}},
        "rooms": [
            {"id": "room|2", "roomType": "LivingRoom", "floorPolygon": living, "floorMaterial": {"name": "Wood"}},
            {"id": "room|3", "roomType": "Kitchen", "floorPolygon": kitchen},
            {"id": "room|4", "roomType": "Bedroom", "floorPolygon": bedroom},
        ],
        "walls": walls,
        "doors": [door, way_out],
        "windows": [{"id": "window|2|0", "wall0": walls[-1]["id"], "room0": "room|2", "holePolygon": pane}],
        "objects": [
            thing("Sofa|2|0", "Sofa_221_1", 0.5, 0.45, 6.9, 90),
            thing("DiningTable|3|0", "Dining_Table_16_1", 1.0, 0.38, 2.0, children=[thing("", "Mug_2", 1.2, 0.8, 2.0)]),
            thing("Chair|3|1", "Chair_002_1", 1.0, 0.44, 2.5, 180),
            thing("Bed|4|0", "Bed_5", 6.0, 0.455, 6.8, 180, children=[book]),
            thing(
                "SideTable|4|1", "Side_Table_2", 7.3, 0.33, 7.6, 180, children=[thing("x", "Gizmo_9", 7.3, 0.8, 7.6)]
            ),
            thing("Painting|4|2", "Wall_Decor_Painting_3", 4.02, 1.6, 5.0, 90),
            thing("Chandelier|4|3", "Box_12", 6.0, 2.6, 4.0),
        ],
    }


ASSETS = {
    "Bed": [{"assetId": "Bed_5", "objectType": "Bed", "boundingBox": {"x": 1.4, "y": 0.91, "z": 2.1}}],
    "Sofa": [{"assetId": "Sofa_221_1", "objectType": "Sofa", "boundingBox": {"x": 1.9, "y": 0.9, "z": 0.8}}],
}
"""An asset database as the package procthor has it, of two assets."""
