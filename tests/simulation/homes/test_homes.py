"""The homes that ship, as a researcher who compares them with the paper's scenes would look at them."""

from __future__ import annotations

import pytest

from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.categories import DYNAMIC, STATIC
from coopera.simulation.homes.scene import Scene, list_scenes, load_scene
from coopera.simulation.homes.spots import Spot, stands_through
from coopera.simulation.making.generate import generate
from coopera.simulation.making.proof import prove

HOMES = ("maple", "oak", "pine", "rowan", "willow")


@pytest.fixture(scope="module")
def homes() -> dict[str, Scene]:
    return {home: load_scene(home) for home in list_scenes()}


def test_five_homes_ship_in_the_sizes_of_the_paper(homes: dict[str, Scene]) -> None:
    assert tuple(homes) == HOMES
    assert len({len(home.rooms) for home in homes.values()}) == 5
    for home in homes.values():
        assert 4 <= len(home.rooms) <= 11
        assert 51 <= len(home.fixed) <= 140
        assert 33 <= len(home.movable) <= 94
        assert len({room.kind for room in home.rooms}) >= 4


def test_the_homes_hold_every_super_category_every_class_and_twenty_objects_of_the_ycb_set(
    homes: dict[str, Scene],
) -> None:
    objects = [thing for home in homes.values() for thing in home.objects]
    assert {thing.category for thing in objects} == {*DYNAMIC, *STATIC}
    assert len({*DYNAMIC, *STATIC}) == 32
    assert {thing.cls for thing in objects} == {*catalogue().fixed, *catalogue().movable}
    ycb = {kind.ycb for cls, kind in catalogue().movable.items() if cls in {thing.cls for thing in objects}}
    assert len(ycb - {None}) == 20


@pytest.mark.parametrize("home", HOMES)
def test_a_shipped_home_has_no_problems(home: str) -> None:
    assert prove(load_scene(home)) == []


@pytest.mark.parametrize("home", HOMES)
def test_each_room_of_a_shipped_home_has_what_makes_it_that_room(home: str, homes: dict[str, Scene]) -> None:
    for room in homes[home].rooms:
        first = catalogue().rooms[room.kind].furniture[0]
        assert any(thing.cls == first and thing.room == room.name for thing in homes[home].fixed)


@pytest.mark.parametrize("home", HOMES)
def test_nothing_of_a_shipped_home_sticks_in_what_it_stands_on(home: str, homes: dict[str, Scene]) -> None:
    for thing in homes[home].movable:
        carrier = homes[home].object(thing.on) if thing.on else None
        if carrier is not None:
            assert not stands_through(carrier, Spot(*thing.position, thing.yaw), thing.size), thing.name


@pytest.mark.slow
@pytest.mark.parametrize("home", HOMES)
def test_a_shipped_home_is_what_its_seed_gives(home: str, homes: dict[str, Scene]) -> None:
    shipped = homes[home]
    assert shipped.seed is not None
    assert generate(shipped.seed, [room.kind for room in shipped.rooms], home) == shipped
