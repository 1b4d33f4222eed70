from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coopera.cli import main
from coopera.core.errors import ConfigError
from coopera.core.household import PickPlace
from coopera.simulation import World
from coopera.simulation.drawing.house import shell
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.sight import rooms_seen
from coopera.simulation.homes.floorplan import Bounds
from coopera.simulation.homes.scene import Room, Scene, dump_scene, list_scenes, load_scene, parse_scene
from coopera.simulation.homes.spots import furniture_on, spots, taken_at
from coopera.simulation.making.overview import overview
from coopera.simulation.ways.home_check import check
from coopera.simulation.ways.navigation import Navigator
from coopera.web.person.plan import plan_of
from tests.simulation.polygons import BEDROOM, KITCHEN, LIVING, polygon_flat, polygon_scene


def _room(polygon: list[list[float]], **more: Any) -> Room:
    return Room.model_validate({"name": "room", "kind": "room", "polygon": polygon, **more})


def test_a_room_knows_its_area_its_middle_and_what_lies_in_it() -> None:
    room = _room(LIVING)
    assert room.bounds == Bounds(0, 0, 6, 6)
    assert room.area == pytest.approx(27)
    assert room.contains(1, 5)
    assert room.contains(5, 1)
    assert room.contains(3, 4)
    assert not room.contains(5, 5)
    assert room.distance(5, 5) == pytest.approx(2)
    assert room.distance(1, 1) == 0
    assert room.contains(*room.centre)
    assert room.depth(*map(np.array, room.centre)) > 1.7
    assert room.encloses(Bounds(1, 1, 5, 2.9))
    assert not room.encloses(Bounds(1, 1, 5, 3.1))
    assert room.encloses(Bounds(1, 1, 5, 3.1), 0.11)


@pytest.mark.parametrize("order", ["clockwise", "closed", "with a corner on a side"])
def test_corners_are_put_in_order(order: str) -> None:
    points = [list(map(float, point)) for point in LIVING]
    given = {
        "clockwise": points[::-1],
        "closed": [*points, points[0]],
        "with a corner on a side": [[2, 0], *points[1:]],
    }
    given["with a corner on a side"].append([0, 0])
    polygon = _room(given[order]).polygon
    assert polygon is not None
    assert {tuple(point) for point in points} == set(polygon)
    assert len(polygon) == 6
    assert sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True)) > 0


@pytest.mark.parametrize(
    ("polygon", "more", "said"),
    [
        ([[0, 0], [4, 4], [4, 0], [0, 4]], {}, r"room 'room': its polygon crosses or touches itself at \(2, 2\)"),
        ([[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], {}, "its polygon crosses or touches itself"),
        ([[0, 0], [1, 1], [2, 2]], {}, "its polygon has fewer than three corners"),
        ([[0, 0], [4, 0], [4, 0.5], [0, 0.5]], {}, "at least 0.8 m wide and deep"),
        ([[0, 0], [4, 0], [4, 4]], {"x1": 5}, "x1 is 5, but its polygon's is 4.0"),
        ([[0, 0], [4, 0], [4, math.nan]], {}, "polygon.2.1"),
        ([[0, 0], [4, 0]], {}, "polygon"),
        ("a square", {}, "polygon"),
    ],
)
def test_a_polygon_that_cannot_be_is_one_sentence(polygon: Any, more: dict[str, Any], said: str) -> None:
    data = {**polygon_flat(), "doors": [], "objects": []}
    data["rooms"] = [{"name": "room", "kind": "room", "polygon": polygon, **more}]
    with pytest.raises(ConfigError, match=said) as caught:
        parse_scene(json.dumps(data), "home.json")
    assert "home.json" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_home_with_polygons_reads_back_as_it_was_written_and_others_have_no_such_field() -> None:
    scene = polygon_scene()
    assert parse_scene(dump_scene(scene), "here") == scene
    assert all('"polygon"' not in dump_scene(load_scene(name)) for name in list_scenes())


def test_walls_stand_on_all_sides_once_and_are_open_at_doors() -> None:
    scene = polygon_scene()
    slanted = [wall for wall in scene.walls() if wall.rise]
    length = sum(math.dist(*wall.ends) for wall in slanted)
    assert length == pytest.approx(math.hypot(2, 2) - 0.95)
    assert all(wall.block.yaw == pytest.approx(math.pi / 4) for wall in slanted)
    straight = [(wall.axis, wall.at, wall.start, wall.end) for wall in scene.walls() if not wall.rise]
    assert ("y", 3.0, 3.0, 4.5 - 0.475) in straight
    assert ("x", 3.0, 3.0, 6.0) in straight
    assert check(scene) == []


@pytest.mark.parametrize("place", [(7.5, 4.0), (3.0, 5.0)])
def test_a_door_that_stands_beside_its_wall_is_named(place: tuple[float, float]) -> None:
    data = polygon_flat()
    data["doors"][1] |= {"x": place[0], "y": place[1]}
    assert any("does not stand on a wall that both share" in line for line in check(Scene.model_validate(data)))


def test_what_stands_in_the_missing_corner_is_outside_and_rooms_that_share_floor_overlap() -> None:
    data = polygon_flat()
    data["objects"][0]["position"] = [3.2, 3.4, 0]
    assert "table_1 stands outside its room, the living room." in check(Scene.model_validate(data))
    data["rooms"][1]["polygon"] = [[2.9, 2.9], *KITCHEN[1:]]
    assert "The rooms living room and kitchen overlap." in check(Scene.model_validate(data))


def test_ways_go_around_the_corner_and_through_doors() -> None:
    navigator = Navigator(polygon_scene())
    around = navigator.path((5.0, 1.5), (1.5, 5.4))
    assert around is not None
    room = _room(LIVING)
    assert all(room.contains(*point) for point in around)
    through = navigator.path((1.5, 1.5), (7.3, 2.0))
    assert through is not None
    assert math.dist(min(through, key=lambda one: math.dist(one, (7, 4))), (7, 4)) < 0.5
    assert not navigator.can_stand(8.5, 7.0)
    assert {len(navigator.cells_in(room)) > 20 for room in ("living room", "kitchen", "bedroom")} == {True}
    for x, y in navigator.cells_in("bedroom"):
        assert _room(BEDROOM).contains(x, y)


def test_nothing_is_put_through_the_wall_behind_furniture() -> None:
    scene = polygon_scene()
    counter = scene.object("counter_1")
    assert counter is not None
    size = (0.5, 0.9, 0.1)  # deeper than the counter: it would hang over into the kitchen
    found = spots(counter, size, furniture_on(scene, counter))
    assert all(taken_at(spot, size).bounds.y1 <= 3.0 for spot in found)


def test_a_thing_is_carried_through_a_slanted_door() -> None:
    data = polygon_flat()
    bed = {**data["objects"][0], "id": 5, "name": "bench_1", "cls": "bench", "room": "bedroom"}
    data["objects"].append({**bed, "position": [7.7, 1.5, 0], "yaw": 1.5708, "size": [1.1, 0.4, 0.45]})
    with World(Scene.model_validate(data)) as world:
        act = PickPlace(object_id=2, object="mug_1", receptacle_id=5, receptacle="bench_1")
        assert world.perform("robot", act).ok
        assert world.as_scene().object_map("movable")["mug_1"] == (2, "bedroom")


def test_floor_and_ceiling_are_as_large_as_the_polygon_and_face_the_room() -> None:
    scene = polygon_scene()
    for room in scene.rooms:
        made = shell(scene, room, scene.walls())
        for cls, up, pairs in (("floor", 1, made.low), ("ceiling", -1, made.above)):
            (mesh,) = [mesh for name, mesh in pairs if name == cls]
            a, b, c = (mesh.at[mesh.faces[:, k]] for k in range(3))
            area = np.cross(b - a, c - a)[:, 2] / 2
            assert (up * area > 0).all()
            assert up * float(area.sum()) == pytest.approx(room.area, abs=1e-3)


def test_a_camera_sees_from_one_arm_of_a_room_through_the_slanted_door() -> None:
    scene = polygon_scene()
    assert rooms_seen(scene, Camera((7.0, 5.5, 1.5), (7.2, 3.0, 1.0), 60)) == {0, 1, 2}
    assert rooms_seen(scene, Camera((7.7, 0.5, 1.5), (7.0, 4.0, 1.0), 60)) >= {1, 2}
    picture = overview(scene, 160, 120, renderer="tiny")
    assert picture.std() > 20


def test_plans_show_the_polygon() -> None:
    scene = polygon_scene()
    assert scene._repr_html_().count("<polygon") == 3
    rooms = plan_of(scene).rooms
    assert [len(room.corners.split()) for room in rooms] == [6, 5, 4]
    at = {room.name: (room.x - 0.25, 6 + 0.25 - room.y) for room in rooms}
    assert scene.rooms[0].contains(*at["living room"])
    assert scene.rooms[1].contains(*at["kitchen"])


def test_a_room_without_a_door_is_not_imported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = polygon_flat()
    data["doors"].pop()
    (tmp_path / "home.json").write_text(json.dumps(data))
    assert main(["scenes", "import", str(tmp_path / "home.json"), "--out", str(tmp_path / "data")]) == 2
    said = capsys.readouterr().err
    assert "field rooms.2: no door leads into the room 'bedroom'" in said
    assert len(said.strip().splitlines()) == 1
    assert not (tmp_path / "data").exists()
