from __future__ import annotations

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.core.randomness import rng_at
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import Scene, dump_scene
from coopera.simulation.making.generate import generate
from coopera.simulation.making.layout import USUAL_ROOMS, lay_out, room_names
from coopera.simulation.ways.home_check import check

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def small_home() -> Scene:
    return generate(4, ["kitchen", "bathroom"], "small", things=60)


def test_the_same_seed_gives_the_same_file_in_another_process_with_another_hash_seed() -> None:
    program = (
        "import sys; from coopera.simulation.making.generate import generate; "
        "from coopera.simulation.homes.scene import dump_scene;"
        "sys.stdout.write(dump_scene(generate(3, ['hallway'], 'twin')))"
    )
    other = subprocess.run(
        [sys.executable, "-c", program],
        cwd=ROOT,
        env={"PYTHONHASHSEED": "7", "PATH": ""},
        capture_output=True,
        text=True,
        check=True,
    )
    assert other.stdout == dump_scene(generate(3, ["hallway"], "twin"))


def test_another_seed_gives_another_home() -> None:
    assert generate(3, ["hallway"], "twin").objects != generate(4, ["hallway"], "twin").objects


def test_a_generated_home_has_no_problems(small_home: Scene) -> None:
    assert check(small_home) == []


def test_a_generated_home_is_full_and_every_thing_stands_on_something_fitting(small_home: Scene) -> None:
    wanted = sum(len(catalogue().rooms[room.kind].furniture) for room in small_home.rooms)
    assert len(small_home.fixed) >= 0.85 * wanted
    assert len(small_home.movable) >= 50
    for thing in small_home.movable:
        carrier = small_home.object(thing.on) if thing.on else None
        assert (carrier.cls if carrier else "floor") in catalogue().movable[thing.cls].put


def test_names_number_the_copies_of_a_class_from_one(small_home: Scene) -> None:
    chairs = [thing.name for thing in small_home.fixed if thing.cls == "dining_chair"]
    assert chairs == [f"dining_chair_{i + 1}" for i in range(len(chairs))]
    assert len(chairs) >= 2


def test_furniture_stands_only_in_rooms_where_it_belongs(small_home: Scene) -> None:
    kinds = {room.name: room.kind for room in small_home.rooms}
    for thing in small_home.fixed:
        assert kinds[thing.room] in catalogue().fixed[thing.cls].rooms


def test_only_the_things_asked_for_are_put_in() -> None:
    home = generate(2, ["hallway"], "bare", things=["hat", "hat", "scarf"])
    assert [thing.name for thing in home.movable] == ["hat_1", "hat_2", "scarf_1"]


def test_a_number_of_things_takes_each_super_category_in_turn_and_no_class_twice_before_it_must() -> None:
    home = generate(2, ["hallway", "study"], "some", things=14)
    assert len(home.movable) >= 13
    assert len({thing.cls for thing in home.movable}) == len(home.movable)
    assert max(Counter(thing.category for thing in home.movable).values()) <= 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"rooms": 0}, "1 to 24 rooms, not 0"),
        ({"rooms": -3}, "not -3"),
        ({"rooms": 1000}, "not 1000"),
        ({"rooms": []}, "not 0"),
        ({"rooms": ["kitchen", "dungeon"]}, "'dungeon'.*bathroom"),
        ({"rooms": 1, "things": ["mug", "sword"]}, "'sword'"),
        ({"rooms": 1, "things": -1}, "0 to 300 movable things, not -1"),
    ],
)
def test_a_home_that_cannot_be_is_refused(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        generate(1, **arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize("count", [1, 2, 5, 10, 16])
def test_a_layout_tiles_its_rectangle_and_doors_lead_everywhere(count: int) -> None:
    kinds = [USUAL_ROOMS[i % len(USUAL_ROOMS)] for i in range(count)]
    layout = lay_out(kinds, rng_at(8, count))
    home = Scene(id="plan", rooms=layout.rooms, doors=layout.doors)
    whole = home.bounds
    area = sum((room.x1 - room.x0) * (room.y1 - room.y0) for room in layout.rooms)
    assert area == pytest.approx((whole.x1 - whole.x0) * (whole.y1 - whole.y0))
    reached = {layout.rooms[0].name}
    for _ in layout.rooms:
        reached |= {name for door in layout.doors if reached & set(door.between) for name in door.between}
    assert reached == set(room_names(kinds))
    assert not [problem for problem in check(home) if "door" in problem or "overlap" in problem]


@pytest.mark.slow
@pytest.mark.parametrize("rooms", [1, 4, 10])
def test_homes_of_all_sizes_have_no_problems(rooms: int) -> None:
    assert check(generate(101, rooms)) == []
