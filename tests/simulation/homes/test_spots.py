from __future__ import annotations

import math

import pytest

from coopera.simulation.homes.catalogue import catalogue, surfaces
from coopera.simulation.homes.floorplan import Bounds
from coopera.simulation.homes.scene import Scene, SceneObject, load_scene
from coopera.simulation.homes.spots import APART, Spot, Taken, furniture_on, is_free, spots, stands_through, taken_at


def piece(cls: str, *, yaw: float = 0.0, z: float = 0.0, x: float = 2.0) -> SceneObject:
    kind = catalogue().fixed[cls]
    return SceneObject(
        id=len(cls),
        name=f"{cls}_1",
        cls=cls,
        category=kind.category,
        fixed=True,
        room="r",
        position=(x, 2.0, z),
        yaw=yaw,
        size=kind.size,
        colour="#808080",
    )


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2, math.pi, 0.4])
def test_spots_lie_on_the_surface_however_the_furniture_is_turned(yaw: float) -> None:
    table = piece("dining_table", yaw=yaw)
    found = spots(table, (0.1, 0.1, 0.1), [])
    assert len(found) > 100
    for spot in found:
        x, y = table.to_local(spot.x, spot.y)
        assert abs(x) <= table.size[0] / 2 - 0.05
        assert abs(y) <= table.size[1] / 2 - 0.05
        assert spot.z == pytest.approx(table.size[2])


def test_a_filled_space_is_kept_clear() -> None:
    table = piece("dining_table")
    vase = Taken(Bounds(1.9, 1.9, 2.1, 2.1), 0.75, 1.1)
    found = spots(table, (0.2, 0.2, 0.2), [vase])
    assert found
    assert len(found) < len(spots(table, (0.2, 0.2, 0.2), []))
    for spot in found:
        assert not taken_at(spot, (0.2, 0.2, 0.2)).bounds.overlaps(vase.bounds, APART)


def test_what_stands_lower_or_higher_fills_nothing() -> None:
    table = piece("dining_table")
    chair_under = Taken(Bounds(1.5, 1.5, 2.5, 2.5), 0.0, 0.7)
    lamp_above = Taken(Bounds(1.5, 1.5, 2.5, 2.5), 1.5, 2.0)
    assert spots(table, (0.1, 0.1, 0.1), [chair_under, lamp_above]) == spots(table, (0.1, 0.1, 0.1), [])


def test_a_full_table_has_no_spots() -> None:
    assert spots(piece("side_table"), (0.1, 0.1, 0.1), [Taken(Bounds(0, 0, 5, 5), 0.0, 3.0)]) == []


def test_a_tall_thing_does_not_go_between_shelf_boards() -> None:
    shelf = piece("bookshelf")
    clear = max(surface.clear for surface in surfaces(shelf))
    assert spots(shelf, (0.1, 0.1, clear - 0.01), [])
    assert spots(shelf, (0.1, 0.1, clear + 0.01), []) == []


def test_a_thing_larger_than_the_surface_may_hang_over_centred() -> None:
    stool = piece("stool")
    found = spots(stool, (1.0, 0.36, 0.1), [])
    assert {(spot.x, spot.y) for spot in found} == {(2.0, 2.0)}


def test_a_microwave_takes_its_part_of_the_counter() -> None:
    counter, oven = piece("kitchen_counter"), piece("microwave", z=0.9)
    room = {"name": "r", "kind": "kitchen", "x0": 0, "y0": 0, "x1": 4, "y1": 4}
    home = Scene.model_validate({"id": "k", "rooms": [room], "objects": [counter, oven]})
    taken = furniture_on(home, counter)
    assert oven.bounds in [space.bounds for space in taken]
    assert not any(
        taken_at(spot, (0.1, 0.1, 0.1)).bounds.overlaps(oven.bounds) for spot in spots(counter, (0.1, 0.1, 0.1), taken)
    )


def test_the_things_of_the_shipped_home_stand_where_a_spot_could_be() -> None:
    maple = load_scene("maple")
    for thing in maple.movable:
        carrier = maple.object(thing.on) if thing.on is not None else None
        if carrier is not None:
            own = taken_at(Spot(*thing.position, thing.yaw), thing.size)
            assert is_free(own, furniture_on(maple, carrier)), thing.name


def test_nothing_is_put_where_it_would_stick_into_a_wall() -> None:
    stool = piece("stool")  # at (2, 2)
    room = {"name": "r", "kind": "kitchen", "x0": 0, "y0": 0, "x1": 4, "y1": 4}
    for x1, fits in ((4.0, {0.0, 1.5708}), (2.3, {1.5708})):
        home = Scene.model_validate({"id": "k", "rooms": [{**room, "x1": x1}], "objects": [stool]})
        assert {spot.yaw for spot in spots(stool, (1.0, 0.36, 0.1), furniture_on(home, stool))} == fits


def test_what_goes_inside_fits_there_as_a_whole() -> None:
    fridge = piece("fridge", yaw=math.pi / 2)
    found = spots(fridge, (0.1, 0.1, 0.25), [], inside=True)
    assert found
    for spot in found:
        space = taken_at(spot, (0.1, 0.1, 0.25))
        assert fridge.bounds.grown(1e-3).overlaps(space.bounds)
        assert fridge.bounds.x0 <= space.bounds.x0 < space.bounds.x1 <= fridge.bounds.x1
        assert fridge.bounds.y0 <= space.bounds.y0 < space.bounds.y1 <= fridge.bounds.y1
        assert 0.3 < space.low < space.high < fridge.top
    assert spots(fridge, (0.7, 0.1, 0.1), [], inside=True) == []
    assert spots(fridge, (0.1, 0.1, 0.5), [], inside=True) == []


def test_there_is_room_beside_and_below_what_is_inside_already() -> None:
    cabinet = piece("kitchen_cabinet")
    size = (0.25, 0.25, 0.025)
    first = spots(cabinet, size, [], inside=True)[0]
    others = spots(cabinet, size, [taken_at(first, size)], inside=True)
    assert first not in others
    assert {spot.z for spot in others} == {spot.z for spot in spots(cabinet, size, [], inside=True)}


def test_nothing_is_put_inside_a_table() -> None:
    assert spots(piece("dining_table"), (0.1, 0.1, 0.1), [], inside=True) == []


def test_a_thing_that_holds_others_takes_them_where_it_now_stands() -> None:
    kind = catalogue().movable["laundry_basket"]
    basket = piece("stool", x=5.0).model_copy(update={"cls": "laundry_basket", "size": kind.size, "fixed": False})
    towel = catalogue().movable["towel"].size
    found = spots(basket, towel, [], inside=True)
    assert found
    assert all(basket.bounds.x0 < spot.x < basket.bounds.x1 for spot in found)


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2, 0.4])
def test_nothing_is_put_through_the_parts_of_what_it_stands_on(yaw: float) -> None:
    lamp, size = piece("floor_lamp", yaw=yaw), (0.2, 0.2, 0.3)
    found = spots(lamp, size, [])
    assert not any(stands_through(lamp, spot, size) for spot in found)
    assert any(stands_through(lamp, spot, size) for spot in spots(lamp, size, [], through=True))


def test_what_is_too_deep_for_a_sill_hangs_over_its_front_and_not_through_the_window() -> None:
    window, plant = piece("curtain"), catalogue().movable["potted_plant"].size
    found = spots(window, plant, [])
    assert found
    assert all(window.to_local(spot.x, spot.y)[1] > 0 for spot in found)


@pytest.mark.parametrize("cls", sorted(catalogue().movable))
def test_a_thing_has_a_place_on_each_class_on_which_it_is_usually_put(cls: str) -> None:
    kind = catalogue().movable[cls]
    for carrier in map(piece, sorted({*kind.put} - {"floor"})):
        found = spots(carrier, kind.size, [])
        assert found, carrier.cls
        assert not any(stands_through(carrier, spot, kind.size) for spot in found), carrier.cls


def test_parts_of_imported_furniture_are_not_known_and_hinder_nothing() -> None:
    shape = {"file": "0" * 64, "colour": "#808080"}
    lamp = piece("floor_lamp")
    imported = lamp.model_copy(update={"mesh": [shape]})
    assert spots(imported, (0.2, 0.2, 0.3), []) == spots(lamp, (0.2, 0.2, 0.3), [], through=True)


@pytest.mark.parametrize(
    ("other", "metres"),
    [
        (Bounds(3, 0, 4, 1), 2.0),
        (Bounds(0, 5, 1, 6), 4.0),
        (Bounds(4, 5, 6, 6), 5.0),
        (Bounds(1, 0, 2, 1), 0.0),
        (Bounds(0.2, 0.2, 0.4, 3), 0.0),
    ],
)
def test_the_gap_of_two_rectangles_is_that_of_their_nearest_points(other, metres) -> None:
    one = Bounds(0, 0, 1, 1)
    assert one.gap(other) == other.gap(one) == pytest.approx(metres)
