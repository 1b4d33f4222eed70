from __future__ import annotations

import json
import math
from itertools import combinations
from pathlib import Path

import pytest

from coopera.cli import main
from coopera.core.randomness import rng_at
from coopera.simulation.homes.scene import Room, Scene, dump_scene, load_scene
from coopera.simulation.making.layout import Form, lay_out
from coopera.simulation.making.proof import prove
from coopera.simulation.making.reshape import reshaped
from coopera.simulation.making.styles import STYLES, styled
from coopera.simulation.making.varied import draw, varied
from coopera.simulation.ways.home_check import check
from tests.simulation.flat import flat

ROOMS = [
    Room(name="a", kind="living room", x0=0, y0=0, x1=6, y1=5),
    Room(name="b", kind="kitchen", x0=6, y0=0, x1=10, y1=5),
    Room(name="c", kind="bedroom", x0=0, y0=5, x1=10, y1=9),
]


@pytest.mark.parametrize("seed", range(12))
def test_corners_that_go_to_a_neighbour_leave_the_floor_covered_once(seed: int) -> None:
    rooms = reshaped(ROOMS, rng_at(seed, "test"), bites=2)
    assert sum(room.area for room in rooms) == pytest.approx(90)
    assert not any(one.overlaps(other, 0.02) for one, other in combinations(rooms, 2))
    assert any(room.polygon is not None for room in rooms)
    assert all(room.area > 5 for room in rooms)


@pytest.mark.parametrize("seed", range(6))
def test_corners_of_the_home_are_cut_out_or_off(seed: int) -> None:
    rooms = reshaped(ROOMS, rng_at(seed, "test"), bites=0, notch=True, slants=1)
    slanted = [edge for room in rooms for edge in room.edges if edge.wall.rise]
    assert len(slanted) == 1
    assert 90 - 2.6**2 - 1.5**2 / 2 <= sum(room.area for room in rooms) < 90 - 0.8**2 / 2


@pytest.mark.parametrize("seed", range(4))
def test_every_room_of_a_reshaped_layout_is_reached_by_doors_in_walls(seed: int) -> None:
    form = Form(size=1.1, long=1.6, bites=2, notch=True, slants=1)
    layout = lay_out(["living room", "kitchen", "bedroom", "bathroom", "hallway"], rng_at(seed, "test"), form)
    scene = Scene(id="draft", rooms=layout.rooms, doors=layout.doors)
    assert check(scene) == []
    group = {room.name: room.name for room in layout.rooms}
    for _ in layout.rooms:
        for a, b in (door.between for door in layout.doors):
            group[a] = group[b] = min(group[a], group[b])
    assert len(set(group.values())) == 1


def test_a_seed_gives_the_same_home_in_which_all_can_be_done() -> None:
    seed = next(seed for seed in range(50) if draw(seed, 3).form.bites)
    home = varied(seed, "one", rooms=3, things=8)
    assert prove(home) == []
    assert dump_scene(varied(seed, "one", rooms=3, things=8)) == dump_scene(home)


def test_draws_differ_in_rooms_size_shape_and_style() -> None:
    drawn = [draw(seed) for seed in range(100)]
    assert {len(one.kinds) for one in drawn} == set(range(3, 12))
    assert {one.form.style for one in drawn} == set(STYLES)
    assert len({tuple(sorted(one.kinds)) for one in drawn}) > 60
    assert 0.6 < sum(bool(one.form.bites or one.form.notch or one.form.slants) for one in drawn) / 100 < 0.9
    assert all({"bedroom", "bathroom"} <= set(one.kinds) for one in drawn)


def test_many_homes_come_with_a_card_and_are_not_made_twice(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["scenes", "generate", "--count", "2", "--rooms", "1", "--id", "few", "--out", str(tmp_path)]
    assert main([*command, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [home["id"] for home in told["homes"]] == ["few-0000", "few-0001"]
    card = json.loads((tmp_path / "few.card.json").read_text())
    assert card["command"] == "coopera scenes generate --count 2 --seed 0 --id few --rooms 1"
    assert card["ranges"]["rooms"] == {"least": 1, "median": 1, "most": 1}
    assert card["objects"]["movable"] == sum(home["movable"] for home in told["homes"])
    assert "| rooms | 1 to 1 (median 1) | 4 to 11 |" in (tmp_path / "few.card.md").read_text()
    file = tmp_path / "scenes" / "few-0001.json"
    assert load_scene(file).seed == 1
    before = file.stat().st_mtime_ns
    assert main(command) == 0
    assert file.stat().st_mtime_ns == before
    assert main([*command[:3], "3", *command[4:], "--seed", "7"]) == 2
    assert "there is a home of this id already" in capsys.readouterr().err
    assert not (tmp_path / "scenes" / "few-0002.json").exists()
    others = str(len(load_scene(file).rooms) + 1)
    assert main([*command, "--rooms", others]) == 2  # a home of other rooms is not taken for one of these
    assert "there is a home of this id already" in capsys.readouterr().err
    assert main([*command, "--things", "100"]) == 2  # nor one of other things, though none of these has more
    assert "there is a home of this id already" in capsys.readouterr().err
    file.unlink()  # as if it had been ended before the second
    first = file.with_name("few-0000.json")
    before = first.stat().st_mtime_ns
    assert main(command) == 0
    assert file.is_file()
    assert first.stat().st_mtime_ns == before


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--count", "0"], "--count must be from 1 to 1000, not 0"),
        (["--count", "2000"], "--count must be from 1 to 1000, not 2000"),
        (["--count", "2", "--png", "a.png"], "--png: a picture is drawn of one home"),
        (["--count", "2", "--rooms", "99"], "1 to 24"),
    ],
)
def test_what_cannot_be_made_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    assert main(["scenes", "generate", *arguments, "--out", str(tmp_path / "data")]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert len(told.strip().splitlines()) == 1
    assert not (tmp_path / "data").exists()


def test_a_style_changes_wood_and_cloth_but_no_ceramics() -> None:
    plain_, dark = (varied_colours(style) for style in ("", "dark"))
    assert plain_["bed"] != dark["bed"]
    assert plain_["toilet"] == dark["toilet"]


def varied_colours(style: str) -> dict[str, str]:
    bed = flat().object("bed_1")
    assert bed is not None
    toilet = bed.model_copy(update={"cls": "toilet", "category": "bathroom fixtures"})
    assert math.isclose(bed.rgb[0], toilet.rgb[0])
    return {thing.cls: styled(thing, style).colour for thing in (bed, toilet)}
