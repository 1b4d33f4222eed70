from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pybullet
import pytest

from coopera.simulation.homes.scene import Scene, load_scene
from coopera.simulation.sight.build import WALL_HEIGHT, BuiltHome, build


@pytest.fixture(scope="module")
def maple() -> Scene:
    return load_scene("maple")


@pytest.fixture
def home(maple: Scene) -> Iterator[BuiltHome]:
    client = pybullet.connect(pybullet.DIRECT)
    yield build(maple, client)
    pybullet.disconnect(client)


def hit(home: BuiltHome, start: tuple[float, float, float], end: tuple[float, float, float]) -> str | None:
    """What a ray hits first, by name; rooms by theirs."""
    body = pybullet.rayTest(start, end, physicsClientId=home.client)[0][0]
    rooms = {body: name for name, body in home.rooms.items()}
    return home.names.get(body) or rooms.get(body)


def test_every_object_and_room_is_one_body_that_can_be_named_back(maple: Scene, home: BuiltHome) -> None:
    assert set(home.bodies) == {thing.name for thing in maple.objects}
    assert all(home.names[body] == name for name, body in home.bodies.items())
    assert set(home.rooms) == {room.name for room in maple.rooms}
    count = pybullet.getNumBodies(physicsClientId=home.client)
    assert count == len(maple.objects) + len(maple.rooms)


def test_a_body_fills_the_space_that_the_scene_says(maple: Scene, home: BuiltHome) -> None:
    for thing in maple.objects:
        low, high = pybullet.getAABB(home.bodies[thing.name], physicsClientId=home.client)
        assert low[:2] == pytest.approx(thing.bounds[:2], abs=0.01)
        assert high[:2] == pytest.approx(thing.bounds[2:], abs=0.01)
        assert (low[2], high[2]) == pytest.approx((thing.position[2], thing.top), abs=0.01)


def test_a_ray_from_above_finds_the_thing_that_lies_on_top(maple: Scene, home: BuiltHome) -> None:
    table = maple.object("dining_table_1")
    assert table is not None
    for thing in (thing for thing in maple.movable if thing.on == "dining_table_1"):
        assert hit(home, (*thing.xy, 2.0), (*thing.xy, 0.0)) == thing.name


def test_walls_stop_rays_and_doors_let_them_through(maple: Scene, home: BuiltHome) -> None:
    for door in maple.doors:
        on_x = any(wall.axis == "x" and abs(wall.at - door.y) < 0.05 for wall in maple.walls())
        step = (0.0, 0.3) if on_x else (0.3, 0.0)
        start = (door.x - step[0], door.y - step[1], 2.2)
        end = (door.x + step[0], door.y + step[1], 2.2)
        assert hit(home, start, end) is None
    wall = next(wall for wall in maple.walls() if wall.axis == "x" and wall.at == maple.bounds.y0)
    middle = (wall.start + wall.end) / 2
    assert hit(home, (middle, wall.at + 0.5, WALL_HEIGHT - 0.1), (middle, wall.at - 0.5, WALL_HEIGHT - 0.1)) is not None


def test_a_moved_thing_is_where_it_was_put(maple: Scene, home: BuiltHome) -> None:
    name = maple.movable[0].name
    home.move(name, (1.0, 2.0, 0.5), math.pi / 2)
    place, turn = pybullet.getBasePositionAndOrientation(home.bodies[name], physicsClientId=home.client)
    assert place == pytest.approx((1.0, 2.0, 0.5))
    assert pybullet.getEulerFromQuaternion(turn)[2] == pytest.approx(math.pi / 2)


def test_a_thing_of_unknown_class_comes_out_of_the_magic_box_and_goes_again(home: BuiltHome) -> None:
    before = pybullet.getNumBodies(physicsClientId=home.client)
    home.add("box:astrolabe", "astrolabe", (0.1, 0.1, 0.1), (0.5, 0.2, 0.2))
    home.move("box:astrolabe", (1.0, 1.0, 2.3), 0.0)
    assert hit(home, (1.0, 1.0, 3.0), (1.0, 1.0, 2.31)) == "box:astrolabe"
    home.remove("box:astrolabe")
    assert pybullet.getNumBodies(physicsClientId=home.client) == before


def test_a_picture_of_the_kitchen_shows_its_furniture_in_many_colours(maple: Scene, home: BuiltHome) -> None:
    room = maple.room("kitchen")
    assert room is not None
    eye, target = (room.x0 + 0.3, room.y0 + 0.3, 2.0), (room.x1 - 0.8, room.y1 - 0.8, 0.3)
    view = pybullet.computeViewMatrix(eye, target, (0, 0, 1))
    lens = pybullet.computeProjectionMatrixFOV(70, 4 / 3, 0.05, 20)
    _, _, colours, _, mask = pybullet.getCameraImage(
        160, 120, view, lens, shadow=0, renderer=pybullet.ER_TINY_RENDERER, physicsClientId=home.client
    )
    seen = {home.names[int(body)] for body in np.unique(mask) if int(body) in home.names}
    assert {"dining_table_1", "fridge_1"} <= seen
    assert len(np.unique(np.asarray(colours).reshape(-1, 4)[:, :3], axis=0)) > 100
