from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from coopera.cli import main
from coopera.core.errors import ConfigError
from coopera.core.household import PickPlace
from coopera.simulation import World
from coopera.simulation.homes.scene import SceneObject, load_scene
from coopera.simulation.making.procthor.files import Item, read_assets, read_house
from coopera.simulation.making.procthor.homes import import_house
from coopera.simulation.making.procthor.things import kind_of
from coopera.simulation.making.report import Imported
from tests.simulation.procthor_house import ASSETS, house, thing


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Imported:
    return imported(tmp_path_factory.mktemp("house"), house(), ASSETS)


def imported(folder: Path, data: dict[str, Any], assets: Any = None) -> Imported:
    (folder / "house.json").write_text(json.dumps(data))
    (folder / "assets.json").write_text(json.dumps(assets))
    known = read_assets(folder / "assets.json") if assets else None
    return import_house(read_house(folder / "house.json"), "house", folder / "house.json", known)


def corners(wide: float, deep: float) -> list[dict[str, float]]:
    return [{"x": x, "y": 0, "z": z} for x, z in ((0, 0), (0, deep), (wide, deep), (wide, 0))]


def the(home: Imported, name: str) -> SceneObject:
    found = home.scene.object(name)
    assert found is not None, name
    return found


def test_rooms_keep_their_polygons_and_open_where_doors_and_missing_walls_are(home: Imported) -> None:
    living, kitchen, bedroom = home.scene.rooms
    assert (living.kind, kitchen.kind, bedroom.kind) == ("living room", "kitchen", "bedroom")
    assert living.polygon is not None
    assert len(living.polygon) == 6
    assert bedroom.polygon is None
    assert living.area == pytest.approx(12)
    assert kitchen.area == pytest.approx(20)
    (door, opening) = home.scene.doors
    assert (door.x, door.y, door.width) == (4.0, 4.5, 1.0)  # measured from the wall's first corner, at z = 6
    assert set(opening.between) == {"living room", "kitchen"}
    assert (opening.x, opening.y) == (2.0, 5.0)
    assert 1.8 < opening.width < 2.0
    assert home.problems == []


def test_things_are_where_they_were_and_look_where_they_looked(home: Imported) -> None:
    sofa = the(home, "sofa_1")
    assert sofa.size == (1.9, 0.8, 0.9)
    assert math.dist(sofa.xy, (0.5, 6.9)) < 0.15
    assert math.cos(sofa.facing) == pytest.approx(1, abs=1e-3)  # a turn of 90 degrees about y looks along +x
    bed = the(home, "bed_1")
    assert bed.size == (1.4, 2.1, 0.91)
    assert math.sin(bed.facing) == pytest.approx(-1, abs=1e-3)
    assert the(home, "dining_table_1").size == (1.47, 0.96, 0.76)  # the usual one: not in the database


def test_children_lie_on_their_parents(home: Imported) -> None:
    assert (the(home, "mug_1").on, the(home, "mug_1").position[2]) == ("dining_table_1", 0.76)
    assert the(home, "book_1").on == "bed_1"
    assert math.dist(the(home, "mug_1").xy, (1.2, 2.0)) < 0.15


def test_a_chair_under_a_table_is_drawn_out(home: Imported) -> None:
    chair, table = the(home, "dining_chair_1"), the(home, "dining_table_1")
    assert not chair.bounds.overlaps(table.bounds)
    assert any("objects.2 (Chair_002_1): shifted by" in line for line in home.report.guessed)


def test_furniture_that_overlaps_gives_way_alike_wherever_in_the_room_it_stands(tmp_path: Path) -> None:
    """Sofas are 1.9 m x 0.8 m: the second of each pair stands 0.53 m from the first, and is shifted by 0.30 m."""
    data = house() | {"walls": [], "doors": [], "windows": []}
    data["rooms"] = [{"id": "room|2", "roomType": "LivingRoom", "floorPolygon": corners(30, 30)}]
    middles = [(x, z + more) for x in (4.0, 7.96, 12.1, 27.5) for z in (3.9, 9.0, 25.75) for more in (0, 0.53)]
    data["objects"] = [thing(f"Sofa|{n}", "Sofa_221_1", x, 0.45, z) for n, (x, z) in enumerate(middles)]
    home = imported(tmp_path, data, ASSETS)
    sofas = [the(home, f"sofa_{n + 1}").xy for n in range(len(middles))]
    assert sofas[::2] == [pytest.approx(middle) for middle in middles[::2]]
    assert sofas[1::2] == [pytest.approx((x, z + 0.3)) for x, z in middles[1::2]]


def test_the_account_says_what_was_understood_guessed_and_left_out(home: Imported) -> None:
    assert home.report.understood[0] == "3 rooms, 2 of them no rectangles, and 2 doors and openings"
    assert any("Dining_Table_16_1): the usual size of its type" in line for line in home.report.guessed)
    assert any("Gizmo_9): a box that can be carried, for its type is not known" in line for line in home.report.guessed)
    said = "\n".join(home.report.left_out)
    assert "1 windows: the walls stand whole there" in said
    assert "doors.1 (door|1|2): it leads outside" in said
    assert "objects.5 (Wall_Decor_Painting_3): a picture on the wall" in said
    assert "objects.6 (Box_12): hangs 2.46 m above the floor" in said


def test_a_robot_and_a_person_use_it(home: Imported) -> None:
    bed, mug = the(home, "bed_1"), the(home, "mug_1")
    with World(home.scene) as world:
        act = PickPlace(object_id=mug.id, object="mug_1", receptacle_id=bed.id, receptacle="bed_1")
        assert world.perform("robot", act).ok


@pytest.mark.parametrize(
    ("id", "asset", "cls"),
    [
        ("Bed|2|1", "RoboTHOR_bed_kritter", "bed"),
        ("2|0", "Dog_Bed_1_1", "dog_bed"),
        ("2|0", "coffee_machine_1", "coffee_machine"),
        ("2|0", "Desk_Lamp_4", "floor_lamp"),
        ("2|0", "bin_13", "trash_can"),
        ("2|0", "RoboTHOR_cellphone_blackberry_v", "phone"),
        ("2|0", "Grand_Couch_3", "sofa"),
        ("2|0", "Zorblax_7", "zorblax"),
    ],
)
def test_a_thing_is_known_by_its_type_or_by_the_meaning_of_its_name(id: str, asset: str, cls: str) -> None:
    assert kind_of(Item.model_validate(thing(id, asset, 0, 0, 0)), {}).cls == cls


def test_a_counter_around_a_corner_is_two_runs_and_none_stands_in_the_room(tmp_path: Path) -> None:
    data = house()
    data["objects"] = [thing("CounterTop|4|0", "Countertop_L_8x6", 6.72, 0.47, 0.99)]
    box = {"x": 2.44, "y": 0.94, "z": 1.83}
    assets = [{"assetId": "Countertop_L_8x6", "objectType": "CounterTop", "boundingBox": box}]
    scene = imported(tmp_path, data, assets).scene
    back, arm = sorted(scene.fixed, key=lambda one: -one.size[0])
    assert back.size == (2.44, 0.65, 0.94)
    assert arm.size == pytest.approx((1.18, 0.65, 0.94))
    assert arm.bounds.x1 > 7.8  # at the wall, not in the middle of the room
    assert not any(one.bounds.distance(6.3, 1.4) == 0 for one in scene.fixed)


def _crossed(data: dict[str, Any]) -> None:
    data["rooms"][2]["floorPolygon"] = data["rooms"][2]["floorPolygon"][::2] + data["rooms"][2]["floorPolygon"][1::2]


def _put(*path: Any, value: Any) -> Any:
    def change(data: Any) -> None:
        for step in path[:-1]:
            data = data[step]
        data[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_crossed, "field rooms.2.floorPolygon: room 'bedroom': its polygon crosses or touches itself"),
        (_put("doors", value=[]), "field rooms.2: no door leads from the room 'room|4' into another"),
        (_put("rooms", value=[]), "field rooms: "),
        (_put("rooms", 1, "id", value="room|2"), "field rooms.1.id: there are two rooms 'room|2'"),
        (_put("rooms", 0, "floorPolygon", value="round"), "field rooms.0.floorPolygon"),
        (_put("objects", 0, "position", "x", value="left"), "field objects.0.position.x"),
        (_put("objects", 1, "children", 0, "position", value=3), "field objects.1.children.0.position"),
        (_put("objects", 0, "position", "x", value=1e9), "field objects.0.position.x"),
        (_put("objects", 0, "position", "x", value=500.0), "field objects.0.position.x"),
        (_put("walls", 2, "polygon", 0, "x", value=5000.0), "field walls.2.polygon.0.x"),
    ],
)
def test_a_house_that_cannot_be_is_one_sentence_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Any, said: str
) -> None:
    data = house()
    change(data)
    (tmp_path / "bad.json").write_text(json.dumps(data))
    assert main(["scenes", "import", str(tmp_path / "bad.json"), "--out", str(tmp_path / "data")]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert "bad.json" in told
    assert len(told.strip().splitlines()) == 1
    assert not (tmp_path / "data").exists()


def test_a_file_of_100_mb_is_not_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with (tmp_path / "large.json").open("wb") as file:
        file.truncate(100_000_000)
    assert main(["scenes", "import", str(tmp_path / "large.json"), "--out", str(tmp_path / "data")]) == 2
    assert "64 MiB" in capsys.readouterr().err
    assert not (tmp_path / "data").exists()


def test_a_database_that_is_none_is_refused(tmp_path: Path) -> None:
    for text in ("{}", "[1]", '{"Bed": [{"assetId": "a", "boundingBox": {"x": "wide", "y": 1, "z": 1}}]}'):
        (tmp_path / "assets.json").write_text(text)
        with pytest.raises(ConfigError, match=r"assets\.json: "):
            read_assets(tmp_path / "assets.json")


def test_an_imported_house_is_stored_with_its_account(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "My House.json").write_text(json.dumps(house()))
    (tmp_path / "assets.json").write_text(json.dumps(ASSETS))
    arguments = ["scenes", "import", str(tmp_path / "My House.json"), "--assets", str(tmp_path / "assets.json")]
    assert main([*arguments, "--out", str(tmp_path / "data"), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)
    assert (found["id"], found["rooms"], found["problems"]) == ("my-house", 3, [])
    account = (tmp_path / "data/scenes/my-house.import.txt").read_text()
    assert "understood: 3 rooms" in account
    assert "guessed: " in account
    assert "left out: 1 windows" in account
    assert load_scene("my-house", [tmp_path / "data/scenes"]).rooms[0].polygon is not None
