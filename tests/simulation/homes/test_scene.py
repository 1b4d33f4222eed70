from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.errors import ConfigError
from coopera.simulation.homes.scene import Scene, SceneObject, dump_scene, list_scenes, load_scene, parse_scene


def two_rooms() -> dict[str, Any]:
    """A bedroom beside a kitchen, a door between them, a table with a mug."""
    table = {
        "id": 3,
        "name": "dining_table_1",
        "cls": "dining_table",
        "category": "support",
        "fixed": True,
        "room": "kitchen",
        "position": [2.0, 1.5, 0.0],
        "size": [1.2, 0.8, 0.75],
        "colour": "#aa7744",
    }
    mug = {
        "id": 7,
        "name": "mug_1",
        "cls": "mug",
        "category": "dining ware",
        "fixed": False,
        "room": "kitchen",
        "position": [2.4, 1.7, 0.75],
        "size": [0.12, 0.08, 0.09],
        "colour": "#3366cc",
        "on": "dining_table_1",
    }
    return {
        "id": "tiny",
        "rooms": [
            {"name": "kitchen", "kind": "kitchen", "x0": 0, "y0": 0, "x1": 4, "y1": 3},
            {"name": "bedroom", "kind": "bedroom", "x0": 4, "y0": 0, "x1": 7, "y1": 3},
        ],
        "doors": [{"between": ["kitchen", "bedroom"], "x": 4, "y": 1.5}],
        "objects": [table, mug],
    }


def reading(data: dict[str, Any]) -> Scene:
    return parse_scene(json.dumps(data), "tiny.json")


def test_a_scene_written_and_read_again_is_the_same() -> None:
    scene = reading(two_rooms())
    assert parse_scene(dump_scene(scene), "again") == scene


def test_the_shipped_home_is_listed_and_loads_by_its_id() -> None:
    assert "maple" in list_scenes()
    assert load_scene("maple").id == "maple"


def test_a_home_in_a_given_folder_is_found_by_its_id(tmp_path: Path) -> None:
    (tmp_path / "tiny.json").write_text(json.dumps(two_rooms()), encoding="utf-8")
    assert "tiny" in list_scenes([tmp_path])
    assert load_scene("tiny", [tmp_path]).id == "tiny"
    assert load_scene(tmp_path / "tiny.json").id == "tiny"


def test_an_unknown_id_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ConfigError, match=r"'castle'.*maple"):
        load_scene("castle")


@pytest.mark.parametrize("strange", ["", "x" * 5000, "a\0b", "a\0b.json", "y" * 5000 + ".json", ".", "tests"])
def test_an_id_that_cannot_even_be_a_file_name_is_refused(strange: str) -> None:
    with pytest.raises(ConfigError, match="scene"):
        load_scene(strange)


def test_a_file_whose_id_is_not_its_name_is_refused_when_asked_for_by_id(tmp_path: Path) -> None:
    (tmp_path / "other.json").write_text(json.dumps(two_rooms()), encoding="utf-8")
    with pytest.raises(ConfigError, match=r"other\.json, field id: must be 'other'"):
        load_scene("other", [tmp_path])


def test_a_missing_file_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"gone\.json"):
        load_scene(tmp_path / "gone.json")


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "odd.json"
    path.write_bytes(b"\xff\xfe\x00{")
    with pytest.raises(ConfigError, match=r"odd\.json"):
        load_scene(path)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda d: d["objects"][0].update(size=[1.0, -0.1, 0.5]), r"objects\.0\.size\.1"),
        (lambda d: d["objects"][0].update(colour="red"), r"objects\.0\.colour"),
        (lambda d: d["objects"][1].update(room="attic"), "mug_1.*room must be one of.*attic"),
        (lambda d: d["objects"][1].update(on="shelf_9"), "mug_1.*must name a fixed object.*shelf_9"),
        (lambda d: d["objects"][1].update(name="dining_table_1"), "object name must be unique.*dining_table_1"),
        (lambda d: d["objects"][1].update(id=3), "object id must be unique.*3"),
        (lambda d: d["objects"][0].update(weight=3), r"objects\.0\.weight"),
        (lambda d: d["objects"][0].update(position=[1e6, 0, 0]), r"objects\.0\.position\.0"),
        (lambda d: d["rooms"][0].update(x1=-4), "kitchen.*at least 0.8 m"),
        (lambda d: d["doors"][0].update(between=["kitchen", "moon"]), "door must join two"),
        (lambda d: d.update(version=9), "version"),
        (lambda d: d.pop("rooms"), "rooms"),
    ],
)
def test_a_mistake_in_a_scene_file_is_named_with_file_and_field(change: Any, field: str) -> None:
    data = two_rooms()
    change(data)
    with pytest.raises(ConfigError, match=rf"tiny\.json.*{field}"):
        reading(data)


@pytest.mark.parametrize("text", ["", "{", "[1, 2]", '"home"', "null", '{"id": NaN}', "[" * 100_000])
def test_text_that_is_no_home_is_a_config_error(text: str) -> None:
    with pytest.raises(ConfigError, match=r"bad\.json"):
        parse_scene(text, "bad.json")


def test_the_object_map_gives_id_and_room_sorted_by_name() -> None:
    scene = reading(two_rooms())
    assert scene.object_map("fixed") == {"dining_table_1": (3, "kitchen")}
    assert scene.object_map("movable") == {"mug_1": (7, "kitchen")}
    assert list(load_scene("maple").object_map("movable")) == sorted(load_scene("maple").object_map("movable"))


def test_rooms_share_one_wall_with_a_gap_at_the_door() -> None:
    shared = [wall for wall in reading(two_rooms()).walls() if wall.axis == "y" and wall.at == 4]
    assert [(round(w.start, 3), round(w.end, 3)) for w in shared] == [(0.0, 1.025), (1.975, 3.0)]


def test_a_door_leaves_walls_of_other_rooms_closed() -> None:
    data = two_rooms()
    data["rooms"].append({"name": "study", "kind": "study", "x0": 0, "y0": 3, "x1": 4, "y1": 6})
    assert len([wall for wall in reading(data).walls() if wall.axis == "x" and wall.at == 3]) == 1


def test_the_walls_do_not_depend_on_the_order_of_the_rooms() -> None:
    data = two_rooms()
    forward = reading(data).walls()
    data["rooms"].reverse()
    assert reading(data).walls() == forward


def test_a_point_outside_belongs_to_the_nearest_room() -> None:
    assert reading(two_rooms()).room_at(9.0, 1.0).name == "bedroom"


@given(x=st.floats(-3, 3), y=st.floats(-3, 3), yaw=st.floats(-7, 7))
def test_a_point_goes_to_the_world_and_back(x: float, y: float, yaw: float) -> None:
    thing = SceneObject(
        id=0,
        name="box_1",
        cls="box",
        category="box",
        fixed=True,
        room="r",
        position=(1.0, -2.0, 0.5),
        yaw=yaw,
        size=(1, 1, 1),
        colour="#000000",
    )
    wx, wy, wz = thing.to_world(x, y, 0.25)
    assert thing.to_local(wx, wy) == pytest.approx((x, y), abs=1e-9)
    assert wz == 0.75


def test_a_quarter_turn_swaps_width_and_depth_and_turns_the_front_to_minus_x() -> None:
    table = reading(two_rooms()).fixed[0].model_copy(update={"yaw": 1.5707963})
    assert table.bounds == pytest.approx((1.6, 0.9, 2.4, 2.1), abs=1e-6)
    moved = table.model_copy(update={"position": (3.0, 1.5, 0.0)})
    assert moved.bounds == pytest.approx((2.6, 0.9, 3.4, 2.1), abs=1e-6)
    assert table.to_world(0, 1)[0] == pytest.approx(1.0, abs=1e-6)


def test_a_changed_copy_of_a_home_forgets_what_the_old_one_had_worked_out() -> None:
    home = reading(two_rooms())
    assert home.object("mug_1") is not None
    assert len(home.movable) == 1
    bare = home.model_copy(update={"objects": [home.fixed[0]]})
    assert bare.movable == ()
    assert bare.object("mug_1") is None
