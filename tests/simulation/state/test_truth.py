"""What must be true of a home: whatever is wrong with a state is found, and said with the name of the object."""

from __future__ import annotations

import math

import pytest

from coopera.core.household import HUMAN, ROBOT
from coopera.simulation import World, list_scenes, load_scene
from coopera.simulation.state.home_state import HomeState, PersonState, RobotState, ThingState
from coopera.simulation.state.truth import problems, wrong
from coopera.simulation.ways.navigation import Navigator
from tests.simulation.flat import bring, flat, move, put

FLAT = flat()


def home(**change: object) -> HomeState:
    person, robot = PersonState(spot=(3.4, 2.5), place=(3.4, 2.5)), RobotState(spot=(5.2, 1.5))
    state = HomeState(scene=FLAT.id, agents={HUMAN: person, ROBOT: robot})
    return state.model_copy(update=change)


def lying(x: float, y: float, z: float, *, on: str | None = None, inside: str | None = None) -> ThingState:
    return ThingState(position=(x, y, z), yaw=0.0, on=on, inside=inside)


def first_problem(state: HomeState) -> str:
    return next(problems(FLAT, state, Navigator(FLAT)), "")


@pytest.mark.parametrize("scene", list_scenes())
def test_a_home_as_it_was_built_has_no_problems(scene: str) -> None:
    with World(load_scene(scene)) as world:
        assert list(problems(world.layout, world.state, Navigator(world.layout))) == []


def test_a_home_in_which_things_were_carried_about_has_no_problems() -> None:
    with World(flat()) as world:
        for agent, act in (
            (HUMAN, put("mug_1", "dining_table_1")),
            (ROBOT, put("tennis_ball_1", "coffee_table_1")),
            (HUMAN, move("sofa_1", "book", "sit and read")),
            (ROBOT, bring("apple")),
        ):
            assert world.perform(agent, act).ok
        assert list(problems(world.layout, world.state, Navigator(world.layout))) == []


def test_a_thing_in_two_hands_is_in_more_than_one_place() -> None:
    state = home().with_agent(HUMAN, thing="mug_1").with_agent(ROBOT, thing="mug_1")
    assert first_problem(state) == (
        "mug_1 is in more than one place: in the hand of the human and in the hand of the robot."
    )


def test_a_thing_both_held_and_worn_is_in_more_than_one_place() -> None:
    assert "mug_1 is in more than one place" in first_problem(home().with_agent(HUMAN, thing="mug_1", worn=("mug_1",)))


def test_a_thing_worn_twice_is_in_more_than_one_place() -> None:
    assert "mug_1 is in more than one place" in first_problem(home().with_agent(HUMAN, worn=("mug_1", "mug_1")))


def test_a_thing_held_and_put_down_is_in_more_than_one_place() -> None:
    state = home(moved={"mug_1": lying(6.2, 3.2, 0.75, on="dining_table_1")}).with_agent(HUMAN, thing="mug_1")
    assert first_problem(state) == "mug_1 is in more than one place: in the hand of the human and put down."


def test_a_thing_from_the_magic_box_must_be_somewhere() -> None:
    state = home().out_of_box(FLAT, HUMAN, "red pen")
    assert first_problem(state) == ""
    assert first_problem(state.with_agent(HUMAN, thing=None)) == "red_pen_1, from the magic box, is nowhere."


def test_a_held_thing_must_be_of_this_home_and_no_furniture() -> None:
    assert first_problem(home().with_agent(ROBOT, thing="harp_1")) == (
        "The robot holds 'harp_1', which this home does not have."
    )
    assert first_problem(home().with_agent(HUMAN, worn=("sofa_1",))) == "The human wears sofa_1, which is furniture."


@pytest.mark.parametrize("number", [math.nan, math.inf, 1e9])
def test_what_is_nowhere_near_the_home_is_found(number: float) -> None:
    assert "tennis_ball_1" in first_problem(home(moved={"tennis_ball_1": lying(number, 1.0, 0.0)}))
    assert "tennis_ball_1" in first_problem(home(moved={"tennis_ball_1": lying(1.0, 1.0, number)}))
    assert "The robot" in first_problem(home().with_agent(ROBOT, spot=(number, 1.0)))
    assert "The robot" in first_problem(home().with_agent(ROBOT, yaw=number))
    assert "The human" in first_problem(home().with_agent(HUMAN, place=(1.0, number)))
    assert "The human" in first_problem(home().with_agent(HUMAN, support=number))
    assert "The human" in first_problem(home().with_agent(HUMAN, worktop=number))


def test_what_is_moved_must_be_a_thing_of_the_home() -> None:
    assert first_problem(home(moved={"harp_1": lying(1, 1, 0)})) == (
        "'harp_1' is put down, but this home does not have it."
    )
    assert first_problem(home(moved={"sofa_1": lying(1, 1, 0)})) == (
        "sofa_1 is furniture, and cannot be put elsewhere."
    )


def test_what_carries_a_thing_must_be_furniture() -> None:
    state = home(moved={"mug_1": lying(5.0, 4.2, 0.42, on="laundry_basket_1")})
    assert first_problem(state) == "mug_1 is on 'laundry_basket_1', which is no furniture of this home."


def test_what_holds_a_thing_must_be_a_container() -> None:
    state = home(moved={"mug_1": lying(2.0, 0.5, 0.42, inside="sofa_1")})
    assert first_problem(state) == "mug_1 is inside 'sofa_1', which holds nothing."


def test_a_container_that_holds_something_is_inside_nothing() -> None:
    state = home(moved={"laundry_basket_1": lying(5.0, 4.2, 0.0, inside="laundry_basket_1")})
    assert first_problem(state) == ("laundry_basket_1 is inside laundry_basket_1, which is itself inside something.")


def test_a_thing_inside_a_container_lies_within_it() -> None:
    assert first_problem(home(moved={"mug_1": lying(5.0, 4.2, 0.02, inside="laundry_basket_1")})) == ""
    out = home(moved={"mug_1": lying(5.5, 4.2, 0.02, inside="laundry_basket_1")})
    assert first_problem(out) == "mug_1 sticks out of laundry_basket_1, which it should be inside of."


def test_what_is_in_a_held_container_is_with_it() -> None:
    state = home(moved={"mug_1": lying(5.0, 4.2, 0.02, inside="laundry_basket_1")})
    assert first_problem(state.with_held(HUMAN, "laundry_basket_1")) == ""


def test_a_thing_lies_over_what_carries_it_and_at_one_of_its_heights() -> None:
    beside = home(moved={"mug_1": lying(5.0, 1.0, 0.75, on="dining_table_1")})
    assert first_problem(beside) == "mug_1 does not lie over dining_table_1, which should carry it."
    above = home(moved={"mug_1": lying(6.0, 3.1, 1.0, on="dining_table_1")})
    assert first_problem(above).startswith("mug_1 is at a height of 1.00 m, but dining_table_1 carries things at 0.75")


def test_a_thing_on_nothing_lies_on_the_floor_of_a_room() -> None:
    assert first_problem(home(moved={"mug_1": lying(3.4, 1.5, 0.0)})) == ""
    assert first_problem(home(moved={"mug_1": lying(3.4, 1.5, 0.5)})) == "mug_1 is 0.50 m above the floor, on nothing."
    assert first_problem(home(moved={"mug_1": lying(3.4, -0.2, 0.0)})) == "mug_1 sticks out of the living room."


def test_things_do_not_overlap() -> None:
    with_book = home(moved={"mug_1": lying(2.0, 2.2, 0.44, on="coffee_table_1")})
    assert first_problem(with_book) == "book_1 and mug_1 overlap."
    in_sofa = home(moved={"mug_1": lying(2.0, 0.5, 0.0)})
    assert first_problem(in_sofa) == "mug_1 and sofa_1 overlap."


def test_a_person_stays_near_the_place_where_they_would_stand() -> None:
    far = home().with_agent(HUMAN, place=(0.5, 4.5))
    assert first_problem(far).startswith("The human is at (0.5, 4.5), too far from (3.4, 2.5)")


def test_everybody_stands_where_a_body_fits() -> None:
    assert first_problem(home().with_agent(ROBOT, spot=(2.0, 0.5))) == (
        "The robot stands at (2.00, 0.50), where no body fits."
    )


def test_a_person_is_at_furniture_and_switches_on_what_there_is() -> None:
    assert first_problem(home().with_agent(HUMAN, at="mug_1")) == (
        "The human is at 'mug_1', which is no furniture of this home."
    )
    assert first_problem(home().with_agent(HUMAN, switched=("harp_1",))) == (
        "The human switched on 'harp_1', which this home does not have."
    )


def test_a_person_does_a_motion_that_there_is() -> None:
    state = home().with_agent(HUMAN, motion="fly")
    assert list(wrong(FLAT, state)) == []
    assert list(wrong(FLAT, state, motions=["stand and wait"])) == ["The human does 'fly', which is no motion."]


@pytest.mark.parametrize(
    ("conditions", "said"),
    [
        ({"harp_1": {"clean": False}}, "'harp_1' has conditions, but this home does not have it."),
        ({"mug_1": {"powered": True}}, "mug_1 has no state 'powered'."),
        ({"mug_1": {"clean": "very"}}, "The state 'clean' of mug_1 must be yes or no, and is 'very'."),
        ({"mug_1": {"clean": True}}, "The conditions of mug_1 hold what is as at first."),
        ({"mug_1": {"clean": False, "filled": "tea"}}, ""),
    ],
)
def test_conditions_are_such_as_their_objects_have(conditions: dict[str, object], said: str) -> None:
    assert first_problem(home(conditions=conditions)) == said


def test_a_thing_from_the_box_has_a_name_and_an_id_of_its_own() -> None:
    state = home().out_of_box(FLAT, HUMAN, "red pen")
    taken = state.box["red_pen_1"].model_copy(update={"id": FLAT.objects[0].id})
    assert first_problem(state.model_copy(update={"box": {"red_pen_1": taken}})) == (
        f"red_pen_1 and {FLAT.objects[0].name} have the same object id {FLAT.objects[0].id}."
    )
