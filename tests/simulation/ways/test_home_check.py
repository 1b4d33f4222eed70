from __future__ import annotations

from typing import Any

import pytest

from coopera.simulation.homes.scene import Scene, SceneObject, load_scene
from coopera.simulation.ways.home_check import check


@pytest.fixture(scope="module")
def maple() -> Scene:
    return load_scene("maple")


def with_changed(scene: Scene, name: str, **change: Any) -> Scene:
    """The home with one object changed, read anew."""
    objects = [thing.model_copy(update=change) if thing.name == name else thing for thing in scene.objects]
    return Scene(id=scene.id, rooms=scene.rooms, doors=scene.doors, objects=objects)


def named(scene: Scene, name: str) -> SceneObject:
    thing = scene.object(name)
    assert thing is not None
    return thing


def test_the_shipped_home_has_no_problems(maple: Scene) -> None:
    assert check(maple) == []


def test_the_shipped_home_is_of_the_promised_size(maple: Scene) -> None:
    assert len(maple.rooms) == 7
    assert len(maple.fixed) >= 75
    assert len(maple.movable) >= 60


def test_furniture_inside_other_furniture_is_found(maple: Scene) -> None:
    problems = check(with_changed(maple, "armchair_1", position=named(maple, "sofa_1").position))
    assert any("armchair_1" in problem and "sofa_1" in problem and "overlap" in problem for problem in problems)


def test_a_thing_out_of_reach_is_found(maple: Scene) -> None:
    bed = named(maple, "bed_1")
    big = with_changed(maple, "bed_1", size=(bed.size[0], bed.size[1], bed.size[2]))
    shirt = next(thing for thing in maple.movable if thing.on is not None)
    x, y, _ = named(maple, "dining_table_1").position
    far = with_changed(big, shirt.name, position=(x + 6.0, y, shirt.position[2]))
    assert any(shirt.name in problem for problem in check(far))


def test_a_floating_thing_is_found(maple: Scene) -> None:
    thing = next(thing for thing in maple.movable if thing.on is not None)
    x, y, z = thing.position
    floating = check(with_changed(maple, thing.name, position=(x, y, z + 0.4)))
    assert any(problem.startswith(f"{thing.name} is at height") for problem in floating)


def test_a_thing_in_the_air_with_nothing_under_it_is_found(maple: Scene) -> None:
    thing = next(thing for thing in maple.movable if thing.on is not None and thing.position[2] > 0.3)
    assert any("floats" in problem for problem in check(with_changed(maple, thing.name, on=None)))


def test_furniture_through_a_wall_is_found(maple: Scene) -> None:
    sofa = named(maple, "sofa_1")
    out = (maple.bounds.x0 - 0.5, sofa.position[1], 0.0)
    assert any("sofa_1 stands outside" in problem for problem in check(with_changed(maple, "sofa_1", position=out)))


def test_a_home_without_doors_has_rooms_nobody_gets_into(maple: Scene) -> None:
    shut = Scene(id="shut", rooms=maple.rooms, objects=list(maple.fixed))
    problems = check(shut)
    assert sum("Nobody can get into" in problem for problem in problems) == len(maple.rooms) - 1


def test_furniture_whose_top_is_full_of_furniture_is_found(maple: Scene) -> None:
    counter, oven = named(maple, "kitchen_counter_1"), named(maple, "microwave_1")
    x, y, _ = counter.position
    wide = (counter.size[0], counter.size[1], oven.size[2])
    built_in = with_changed(maple, "microwave_1", position=(x, y, counter.size[2]), size=wide, yaw=counter.yaw)
    assert "Nobody can put even a small thing on kitchen_counter_1 in the kitchen." in check(built_in)


def test_a_door_off_the_shared_wall_is_found(maple: Scene) -> None:
    door = maple.doors[0].model_copy(update={"x": maple.bounds.x0 - 3, "y": 0.0})
    problems = check(Scene(id="odd", rooms=maple.rooms, doors=[door, *maple.doors[1:]]))
    assert any("does not stand on a wall" in problem for problem in problems)


def test_a_room_walled_up_by_furniture_is_found() -> None:
    room = {"name": "cell", "kind": "cell", "x0": 0, "y0": 0, "x1": 2, "y1": 2}
    block = {
        "id": 0,
        "name": "box_1",
        "cls": "box",
        "category": "box",
        "fixed": True,
        "room": "cell",
        "position": [1, 1, 0],
        "size": [1.6, 1.6, 1.0],
        "colour": "#112233",
    }
    problems = check(Scene.model_validate({"id": "cell", "rooms": [room], "objects": [block]}))
    assert problems == ["In the home 'cell' there is no room to stand anywhere."]


def test_overlapping_rooms_are_found() -> None:
    rooms = [
        {"name": "a", "kind": "kitchen", "x0": 0, "y0": 0, "x1": 3, "y1": 3},
        {"name": "b", "kind": "study", "x0": 2, "y0": 0, "x1": 5, "y1": 3},
    ]
    assert any("a and b overlap" in problem for problem in check(Scene.model_validate({"id": "two", "rooms": rooms})))


def test_a_thing_that_sticks_into_the_wall_is_found(maple: Scene) -> None:
    room = maple.rooms[0]
    broom = next(thing for thing in maple.movable if thing.on is None)
    into = with_changed(maple, broom.name, room=room.name, position=(room.x0 + 0.01, room.centre[1], 0.0))
    assert f"{broom.name} lies outside its room, the {room.name}." in check(into)
