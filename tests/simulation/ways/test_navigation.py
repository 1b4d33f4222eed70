from __future__ import annotations

import math

import numpy as np
import pytest

from coopera.simulation.homes.catalogue import blocks
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene, load_scene
from coopera.simulation.ways.navigation import RADIUS, REACH, STOP, Array, Disc, Navigator, clearance, obstacle_boxes


@pytest.fixture(scope="module")
def maple() -> Scene:
    return load_scene("maple")


@pytest.fixture(scope="module")
def navigator(maple: Scene) -> Navigator:
    return Navigator(maple)


def along(points: list[Point]) -> Array:
    """Points every centimetre of a way."""
    legs = [np.linspace(a, b, max(2, int(math.dist(a, b) / 0.01))) for a, b in zip(points, points[1:], strict=False)]
    return np.concatenate(legs)


def places(navigator: Navigator, count: int) -> list[Point]:
    cells = [cell for room in navigator.scene.rooms for cell in navigator.cells_in(room.name).tolist()]
    picked = np.random.default_rng(3).choice(len(cells), size=count, replace=False)
    return [(cells[int(i)][0], cells[int(i)][1]) for i in picked]


def nearest_obstacle(scene: Scene, points: Array) -> float:
    """Distance from a way to the nearest furniture or wall, by hand: plain loops over turned rectangles."""
    worst = math.inf
    for thing in (thing for thing in scene.fixed if blocks(thing)):
        for x, y in points:
            u, v = thing.to_local(float(x), float(y))
            worst = min(worst, math.hypot(max(abs(u) - thing.size[0] / 2, 0), max(abs(v) - thing.size[1] / 2, 0)))
    for wall in scene.walls():
        worst = min(worst, *(wall.bounds.distance(float(x), float(y)) for x, y in points))
    return worst


def test_the_distance_to_a_turned_box_is_exact() -> None:
    box = np.array([[1.0, 1.0, 0.5, 0.25, math.pi / 2]])
    x, y = np.array([1.0, 1.0, 2.0, 1.25 + 3.0]), np.array([1.0, 2.0, 1.0, 1.5 + 4.0])
    assert clearance(x, y, box) == pytest.approx([0.0, 0.5, 0.75, 5.0])


def test_no_way_comes_nearer_to_anything_than_the_body_is_wide(maple: Scene, navigator: Navigator) -> None:
    spots = places(navigator, 24)
    boxes = obstacle_boxes((thing for thing in maple.fixed if blocks(thing)), maple.walls())
    for start, goal in zip(spots[::2], spots[1::2], strict=True):
        way = navigator.path(start, goal)
        assert way is not None
        points = along(way)
        assert clearance(points[:, 0], points[:, 1], boxes).min() >= RADIUS - 0.01
    assert nearest_obstacle(maple, points) == pytest.approx(
        float(clearance(points[:, 0], points[:, 1], boxes).min()), abs=1e-9
    )


def test_a_way_starts_and_ends_where_asked_and_its_length_adds_up(navigator: Navigator) -> None:
    start, goal = places(navigator, 2)
    route = navigator.route(start, goal)
    assert route.points is not None
    assert route.points[0] == start
    assert math.dist(route.points[-1], goal) < 0.01
    legs = zip(route.points, route.points[1:], strict=False)
    assert route.length == pytest.approx(sum(math.dist(a, b) for a, b in legs))
    assert route.length >= math.dist(start, goal) - 1e-9


def test_the_way_back_is_about_as_long(navigator: Navigator) -> None:
    start, goal = places(navigator, 2)
    assert navigator.distance(start, goal) == pytest.approx(navigator.distance(goal, start), rel=0.05)


def test_in_an_empty_room_the_way_is_straight() -> None:
    room = {"name": "hall", "kind": "hallway", "x0": 0, "y0": 0, "x1": 6, "y1": 4}
    empty = Navigator(Scene.model_validate({"id": "empty", "rooms": [room]}))
    way = empty.path((1.0, 1.0), (5.0, 3.0))
    assert way is not None
    assert len(way) == 2
    assert math.dist(way[1], (5.0, 3.0)) < 0.04


def test_every_room_leads_to_every_other(maple: Scene, navigator: Navigator) -> None:
    middles = [navigator.middle_of(room.name) for room in maple.rooms]
    assert None not in middles
    assert all(navigator.path(middles[0] or (0, 0), middle or (0, 0)) for middle in middles)


def test_a_walled_up_room_has_no_way_and_a_reason() -> None:
    rooms = [
        {"name": "a", "kind": "study", "x0": 0, "y0": 0, "x1": 4, "y1": 4},
        {"name": "b", "kind": "study", "x0": 4, "y0": 0, "x1": 7, "y1": 4},
    ]
    navigator = Navigator(Scene.model_validate({"id": "two", "rooms": rooms}))
    route = navigator.route((1.0, 1.0), (6.0, 2.0))
    assert route.points is None
    assert "no room to stand at the goal (6.00, 2.00)" in route.reason
    assert route.length == math.inf


def test_every_piece_of_furniture_has_places_to_act_from(maple: Scene, navigator: Navigator) -> None:
    start = navigator.middle_of("hallway")
    assert start is not None
    for thing in maple.fixed:
        stands = navigator.approach(thing, start)
        assert stands, thing.name
        support = STOP if thing.position[2] < 0.2 else REACH
        for stand in stands:
            assert thing.bounds.distance(stand.x, stand.y) <= support + 1e-6
            assert maple.room_at(stand.x, stand.y).name == thing.room
            assert navigator.can_stand(stand.x, stand.y)


def test_one_faces_what_one_walks_up_to(maple: Scene, navigator: Navigator) -> None:
    for thing in maple.fixed:
        stand = navigator.approach(thing, most=1)[0]
        ahead = (stand.x + 0.1 * math.cos(stand.yaw), stand.y + 0.1 * math.sin(stand.yaw))
        inside = thing.bounds.distance(stand.x, stand.y) == 0.0  # on a rug
        assert inside or thing.bounds.distance(*ahead) < thing.bounds.distance(stand.x, stand.y)


def test_one_stands_in_front_of_a_cupboard_not_beside_it(maple: Scene, navigator: Navigator) -> None:
    shelf = maple.object("bookshelf_1")
    assert shelf is not None
    stand = navigator.approach(shelf, most=1)[0]
    assert shelf.to_local(stand.x, stand.y)[1] > shelf.size[1] / 2


def test_a_thing_on_furniture_is_taken_from_within_reach(maple: Scene, navigator: Navigator) -> None:
    for thing in maple.movable:
        carrier = maple.object(thing.on) if thing.on is not None else None
        if carrier is not None:
            stand = navigator.approach(carrier, point=thing.xy, most=1)[0]
            assert math.dist((stand.x, stand.y), thing.xy) <= REACH
            assert stand.yaw == pytest.approx(math.atan2(thing.xy[1] - stand.y, thing.xy[0] - stand.x))


def test_the_nearest_of_equal_places_comes_first(navigator: Navigator, maple: Scene) -> None:
    table = maple.object("dining_table_1")
    assert table is not None
    stands = navigator.approach(table)
    first = stands[-1]
    again = navigator.approach(table, (first.x, first.y), most=1)[0]
    assert again.walk <= 0.6


def test_another_body_in_the_way_is_walked_around() -> None:
    room = {"name": "hall", "kind": "hallway", "x0": 0, "y0": 0, "x1": 6, "y1": 4}
    navigator = Navigator(Scene.model_validate({"id": "empty", "rooms": [room]}))
    direct = navigator.route((1.0, 2.0), (5.0, 2.0))
    detour = navigator.route((1.0, 2.0), (5.0, 2.0), avoid=(Disc(3.0, 2.0),))
    assert detour.points is not None
    assert direct.length < detour.length < direct.length + 1.0
    assert np.hypot(*(along(detour.points) - np.array([3.0, 2.0])).T).min() >= 2 * RADIUS - 0.02


def test_a_body_in_the_only_door_blocks_the_way_and_can_give_way() -> None:
    rooms = [
        {"name": "a", "kind": "study", "x0": 0, "y0": 0, "x1": 4, "y1": 4},
        {"name": "b", "kind": "study", "x0": 4, "y0": 0, "x1": 8, "y1": 4},
    ]
    door = {"between": ["a", "b"], "x": 4, "y": 2}
    navigator = Navigator(Scene.model_validate({"id": "two", "rooms": rooms, "doors": [door]}))
    route = navigator.route((1.0, 2.0), (7.0, 2.0))
    assert route.points is not None
    blocked = navigator.route((1.0, 2.0), (7.0, 2.0), avoid=(Disc(4.0, 2.0),))
    assert blocked.points is None
    assert blocked.reason == "somebody stands in the way"
    aside = next(navigator.give_way((4.0, 2.0), route.points))
    assert navigator.route((1.0, 2.0), (7.0, 2.0), avoid=(Disc(*aside),)).points is not None


def test_the_same_question_gets_the_same_answer_from_a_new_navigator(maple: Scene, navigator: Navigator) -> None:
    start, goal = places(navigator, 2)
    assert Navigator(maple).route(start, goal) == navigator.route(start, goal)
