from __future__ import annotations

import math
from itertools import combinations, pairwise

import pytest

from coopera.simulation.acts.handling import Errand, posture_for
from coopera.simulation.acts.plans import Give, Ground, Handle, Plan, UnableError, Walk, clear_of, discs
from coopera.simulation.acts.skills import hand_over, pick_place
from coopera.simulation.acts.walking import walk
from coopera.simulation.bodies.elbowroom import Elbowroom
from coopera.simulation.bodies.robot import load_robot
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.library import load_library
from coopera.simulation.state.free_places import free_places
from coopera.simulation.state.home_state import HomeState, PersonState, RobotState
from coopera.simulation.ways.navigation import Disc, Navigator, Stand
from tests.simulation.flat import bring, flat, put

SCENE = flat()
WHO = ("human",), {"robot": load_robot("fetch")}
GROUND = Ground(SCENE, Navigator(SCENE), load_library(), *WHO, Elbowroom(SCENE))


def home(person=(1.0, 2.2), robot=(7.5, 4.3), **details) -> HomeState:
    agents = {"human": PersonState(spot=person, place=person, **details), "robot": RobotState(spot=robot)}
    return HomeState(scene="flat", agents=agents)


def test_a_walk_leads_around_the_other_one() -> None:
    plan = Plan(home(person=(5.4, 1.2), robot=(7.2, 1.2)))
    walk(GROUND, plan, "human", (8.6, 1.0))
    (way,) = plan.steps
    assert isinstance(way, Walk)
    assert min(math.dist(point, (7.2, 1.2)) for point in _along(way.points)) >= 0.59


@pytest.mark.parametrize("agent", ["human", "robot"])
def test_who_stands_in_the_door_steps_aside_for_the_other(agent) -> None:
    state = home(person=(2.9, 2.9), robot=(4.5, 2.5)) if agent == "human" else home(person=(4.5, 2.5), robot=(3.2, 2.9))
    plan = Plan(state)
    walk(GROUND, plan, agent, (5.1, 2.2))
    aside, way = plan.steps
    assert isinstance(aside, Walk)
    assert isinstance(way, Walk)
    assert (aside.agent, way.agent) == (("robot", "human") if agent == "human" else ("human", "robot"))
    assert clear_of((5.1, 2.2), [Disc(*aside.points[-1])])
    assert math.dist(plan.state.person().spot, plan.state.robot().spot) >= 0.6


def test_all_who_stand_in_the_way_step_aside_and_not_onto_each_other() -> None:
    ground = Ground(SCENE, Navigator(SCENE), load_library(), ("human", "ana"), WHO[1], Elbowroom(SCENE))
    state = home(person=(4.5, 2.5), robot=(3.2, 2.9)).put("ana", PersonState(spot=(5.1, 2.2), place=(5.1, 2.2)))
    plan = Plan(state)
    walk(ground, plan, "robot", (5.1, 2.2))
    assert [step.agent for step in plan.steps] == ["human", "ana", "robot"]
    spots = [body.spot for body in plan.state.agents.values()]
    assert min(math.dist(a, b) for a, b in combinations(spots, 2)) >= 0.6


def test_a_walk_leads_around_two_others_at_once() -> None:
    ground = Ground(SCENE, Navigator(SCENE), load_library(), ("human", "ana"), WHO[1], Elbowroom(SCENE))
    ana = PersonState(spot=(7.2, 1.85), place=(7.2, 1.85))
    plan = Plan(home(person=(7.2, 1.2), robot=(5.4, 1.2)).put("ana", ana))
    walk(ground, plan, "robot", (8.6, 1.2))
    (way,) = plan.steps
    for taken in ((7.2, 1.2), (7.2, 1.85)):
        assert min(math.dist(taken, point) for point in _along(way.points)) >= 0.59


def _along(points):
    for (ax, ay), (bx, by) in pairwise(points):
        yield from ((ax + (bx - ax) * k / 20, ay + (by - ay) * k / 20) for k in range(21))


def test_a_pick_and_place_goes_takes_goes_and_puts() -> None:
    plan = pick_place(GROUND, home(), "robot", put("book_1", "kitchen_counter_1"))
    kinds = [type(step) for step in plan.steps if not (isinstance(step, Walk) and step.agent == "human")]
    assert kinds == [Walk, Handle, Walk, Handle]
    take, place = (step for step in plan.steps if isinstance(step, Handle))
    assert take.put is None
    assert place.put is not None
    assert place.put.on == "kitchen_counter_1"
    assert place.put.position[2] == pytest.approx(0.9)
    assert plan.at == ["kitchen_counter_1", "coffee_table_1"]


def test_things_are_put_side_by_side_until_the_table_is_full() -> None:
    state, put_there = home(), 0
    for thing in ("mug_1", "book_1", "apple_1", "tennis_ball_1", "cushion_1"):
        state = pick_place(GROUND, state, "human", put(thing, "coffee_table_1")).state
        put_there += 1
    boxes = []
    for thing in SCENE.movable:
        where = state.thing(thing)
        if where.on == "coffee_table_1":
            boxes.append(thing.model_copy(update={"position": where.position, "yaw": where.yaw}).bounds)
    assert len(boxes) == put_there
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_free_place_is_never_on_top_of_another_thing_or_over_the_edge() -> None:
    table, basket = SCENE.object("dining_table_1"), SCENE.object("laundry_basket_1")
    apple = SCENE.object("apple_1")
    places = free_places(SCENE, home(), basket, table)
    assert places
    for place in places:
        there = basket.model_copy(update={"position": place[:3], "yaw": place.yaw})
        assert not there.bounds.overlaps(apple.bounds)
        assert table.bounds.grown(0.01).overlaps(there.bounds)
        assert there.bounds.x0 >= table.bounds.x0 - 0.01
        assert there.bounds.y1 <= table.bounds.y1 + 0.01


def test_a_thing_is_not_put_on_the_seat_in_which_the_person_sits() -> None:
    sitting = home().with_agent("human", place=(2.0, 0.68), spot=(2.0, 1.35), posture="sit", support=0.41)
    plan = pick_place(GROUND, sitting, "robot", put("book_1", "sofa_1"))
    x, y, _ = plan.state.thing(SCENE.object("book_1")).position
    assert math.dist((x, y), (2.0, 0.68)) >= 0.35


def test_an_arm_does_not_reach_across_the_room() -> None:
    for agent in ("human", "robot"):
        here = Stand(7.0, 1.0, 0.0, 0.0, 0.0)
        assert posture_for(GROUND, Plan(home()), agent, here, Errand((9.5, 1.0, 0.9), None)) is None
        assert posture_for(GROUND, Plan(home()), agent, here, Errand((7.7, 1.0, 0.8), None)) is not None


def test_a_hand_over_happens_before_the_person_at_arms_length() -> None:
    plan = hand_over(GROUND, home(), "robot", bring("banana"))
    give = plan.steps[-1]
    assert isinstance(give, Give)
    assert 0.6 <= math.dist((give.stand.x, give.stand.y), plan.state.person().place) <= 1.25
    assert plan.state.box["banana_1"].text == "banana"
    assert plan.state.robot().thing is None


def test_the_robot_does_not_hand_a_thing_through_the_wall() -> None:
    behind_the_wall = home(person=(4.1, 0.9), robot=(4.9, 0.9))
    plan = hand_over(GROUND, behind_the_wall, "robot", bring("banana"))
    assert SCENE.room_at(*plan.state.robot().spot).name == "living room"
    assert plan.metres > 2


def test_the_robot_stays_where_it_is_if_the_person_is_at_hand() -> None:
    plan = hand_over(GROUND, home(person=(7.3, 1.2), robot=(8.2, 1.2)), "robot", bring("banana"))
    assert [type(step) for step in plan.steps] == [Give]
    assert plan.metres == 0


def test_a_person_who_sits_takes_up_the_seat_and_the_floor_before_it() -> None:
    sitting = home().with_agent("human", place=(2.0, 0.68), spot=(2.0, 1.35), posture="sit")
    assert [(disc.x, disc.y) for disc in discs(sitting, "human")] == [(2.0, 1.35), (2.0, 0.68)]
    assert len(discs(home(), "human")) == 1


def test_who_is_walled_in_cannot_be_helped() -> None:
    small = SCENE.model_copy(update={"doors": []})
    ground = Ground(small, Navigator(small), load_library(), *WHO, Elbowroom(small))
    with pytest.raises(UnableError):
        pick_place(ground, home(), "human", put("book_1", "dining_table_1"))


def assert_nobody_is_walked_through(state: HomeState, plan: Plan) -> None:
    """No walk of a plan comes nearer to another body than that is wide, or than the walker already was."""
    floor = {agent: discs(state, agent) for agent in state.agents}
    for step in plan.steps:
        if not isinstance(step, Walk):
            continue
        for disc in (disc for agent, taken in floor.items() if agent != step.agent for disc in taken):
            nearest = min(math.dist(point, (disc.x, disc.y)) for point in _along(step.points))
            assert nearest >= min(disc.radius + 0.28, math.dist(step.points[0], (disc.x, disc.y)) - 0.02)
        floor[step.agent] = [Disc(*step.points[-1])]


def corridor() -> Ground:
    """A room, and a corridor from it that ends nowhere, too narrow for two."""
    rooms = [
        {"name": "hall", "kind": "living room", "x0": 0, "y0": 0, "x1": 3, "y1": 3},
        {"name": "corridor", "kind": "hallway", "x0": 3, "y0": 1, "x1": 7, "y1": 2},
    ]
    door = {"between": ["hall", "corridor"], "x": 3, "y": 1.5, "width": 0.9}
    scene = Scene.model_validate({"id": "dead-end", "rooms": rooms, "doors": [door]})
    return Ground(scene, Navigator(scene), load_library(), *WHO, Elbowroom(scene))


def test_who_steps_aside_does_not_walk_through_the_one_who_asked() -> None:
    moved = 0
    for x, y in ((4.1, 2.5), (4.5, 2.5), (4.9, 2.5), (5.6, 2.4), (3.9, 2.9)):
        state = home(person=(x, y), robot=(x - 0.7, 2.5))
        plan = Plan(state)
        walk(GROUND, plan, "human", (1.0, 2.4))
        assert_nobody_is_walked_through(state, plan)
        moved += len(plan.steps) > 1
    assert moved


def test_a_walker_backs_out_of_a_dead_end_to_let_the_other_one_out() -> None:
    ground = corridor()
    state = home(person=(5.5, 1.5), robot=(6.5, 1.5))
    plan = Plan(state)
    walk(ground, plan, "human", (6.6, 1.5))
    assert [step.agent for step in plan.steps] == ["human", "robot", "human"]
    assert_nobody_is_walked_through(state, plan)
    assert math.dist(plan.state.person().spot, (6.6, 1.5)) < 0.05
    assert ground.scene.room_at(*plan.state.robot().spot).name == "hall"
    length = sum(math.dist(a, b) for step in plan.steps if step.agent == "human" for a, b in pairwise(step.points))
    assert plan.metres == pytest.approx(length)


def test_who_can_neither_step_aside_nor_be_let_past_is_in_the_way() -> None:
    room = {"name": "cell", "kind": "hallway", "x0": 0, "y0": 0, "x1": 4, "y1": 1}
    scene = Scene.model_validate({"id": "cell", "rooms": [room]})
    ground = Ground(scene, Navigator(scene), load_library(), *WHO, Elbowroom(scene))
    plan = Plan(home(person=(1.0, 0.5), robot=(3.0, 0.5)))
    with pytest.raises(UnableError, match="the robot stands in the way and has nowhere to step aside"):
        walk(ground, plan, "human", (3.0, 0.5))
