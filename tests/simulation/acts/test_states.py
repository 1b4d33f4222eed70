"""What acts change besides places: containers that open, tools that are fetched, states, what is worn."""

from __future__ import annotations

import json
import math

import pytest

from coopera.simulation import PersonAgent, RobotAgent, World, load_scene
from coopera.simulation.acts.plans import Handle, Open
from tests.simulation.flat import bring, move, put
from tests.simulation.kitchen import condition, moves, puts


def test_what_is_put_inside_a_closed_fridge_is_inside_and_the_fridge_was_opened_and_closed_for_it(home) -> None:
    act = puts("apple_1", "fridge_1", "inside")
    plan = home.plan("human", act)
    assert [type(step) for step in plan.steps if isinstance(step, Open | Handle)] == [Handle, Open, Handle, Open]
    outcome = home.perform("human", act)
    assert outcome.opened == ("fridge_1",)
    apple = home.state.thing(home.layout.object("apple_1"))
    assert (apple.on, apple.inside) == (None, "fridge_1")
    assert not home.on("apple", "fridge")
    assert condition(home, "fridge_1")["open"] is False
    assert "apple_1" not in home.things_on("kitchen")
    assert home.go_to("robot", "apple_1").ok
    assert home.near("robot", "fridge")
    taken = home.perform("robot", puts("apple_1", "dining_table_1"))
    assert taken.opened == ("fridge_1",)
    assert home.on("apple", "dining_table")


def test_what_stands_open_stays_open_and_shows_what_is_in_it(home) -> None:
    home.perform("human", puts("apple_1", "fridge_1", "inside"))
    assert home.set_open("robot", "fridge_1", True).ok
    assert home.states() == {"fridge_1": "open"}
    assert home.things_on("kitchen")["apple_1"] == "inside fridge_1"
    assert home.perform("human", puts("apple_1", "dining_table_1")).opened == ()
    assert home.states("kitchen") == {"fridge_1": "open"}
    assert home.states("living room") == {}
    assert home.set_open("human", "fridge_1", False).ok
    assert home.states() == {}
    assert "cannot be opened or closed" in home.set_open("human", "sofa_1", True).reason


def test_what_is_in_a_basket_is_carried_with_it(home) -> None:
    assert home.perform("human", puts("tennis_ball_1", "laundry_basket_1", "inside")).ok
    assert (
        home.perform("human", puts("laundry_basket_1", "coffee_table_1")).ok
        or home.perform("human", puts("laundry_basket_1", "bed_1")).ok
    )
    basket, ball = (home.state.thing(home.layout.object(name)) for name in ("laundry_basket_1", "tennis_ball_1"))
    assert ball.inside == "laundry_basket_1"
    assert math.dist(ball.position[:2], basket.position[:2]) < 0.3
    assert home.objects("movable")["tennis_ball_1"][1] == "living room"
    kept = json.loads(json.dumps(home.snapshot()))
    home.restore(kept)
    assert home.perform("robot", puts("tennis_ball_1", "dining_table_1")).ok


def test_the_pan_is_brought_to_the_stove_and_the_stove_is_on_while_one_cooks(home) -> None:
    outcome = home.perform("human", moves("stove_1", "egg", "fry in a pan"))
    assert outcome.fetched == ("frying_pan_1",)
    assert home.on("frying_pan", "stove")
    assert home.states()["stove_1"] == "on, dirty"
    again = home.perform("human", moves("stove_1", "spatula", "fry in a pan"))
    assert again.fetched == ()
    assert home.perform("human", moves("sofa_1", "book", "sit and read")).ok
    assert home.states()["stove_1"] == "dirty"


def test_what_a_motion_needs_and_the_home_lacks_must_be_in_hand(home) -> None:
    refused = home.perform("human", moves("dining_table_1", "cup", "type on a keyboard"))
    assert refused.reason.startswith("to type on a keyboard one needs a laptop or a keyboard")
    assert home.misfit("human", moves("dining_table_1", "cup", "type on a keyboard")) == refused.reason
    assert home.perform("human", moves("dining_table_1", "laptop", "type on a keyboard")).ok


def test_eating_dirties_the_plate_washing_cleans_it_and_both_last(home) -> None:
    assert home.perform("human", moves("dining_table_1", "fork", "eat a meal")).ok
    assert condition(home, "plate_1")["clean"] is False
    kept = json.loads(json.dumps(home.snapshot()))
    home.restore({})
    assert condition(home, "plate_1")["clean"] is True
    home.restore(kept)
    assert home.states() == {"plate_1": "dirty"}
    washed = home.perform("human", moves("kitchen_sink_1", "sponge", "wash dishes"))
    assert washed.fetched == ("plate_1",)
    assert home.on("plate", "kitchen_sink")
    assert condition(home, "plate_1")["clean"] is True
    assert home.states() == {"kitchen_sink_1": "on"}  # the water runs
    assert home.perform("human", moves("sofa_1", "book", "sit and read")).ok
    assert home.states() == {}


@pytest.mark.parametrize("poured", ["ginger tea jug", "jug of ginger tea", "a jug with some ginger tea"])
def test_what_is_poured_is_told_apart_from_what_it_is_poured_out_of(home, poured: str) -> None:
    assert home.perform("human", moves("dining_table_1", poured, "pour a drink")).ok
    assert home.states() == {"mug_1": "with ginger tea in it"}


def test_a_poured_drink_is_in_the_cup_until_it_is_drunk(home) -> None:
    assert home.perform("human", moves("dining_table_1", "milk carton", "pour a drink")).fetched == ("mug_1",)
    assert home.states() == {"mug_1": "with milk in it"}
    assert home.perform("human", moves("sofa_1", "mug_1", "drink from a cup")).ok
    assert home.states() == {}  # what is in a hand has to be recognised
    assert home.place("human", "coffee_table_1").ok
    assert home.states() == {"mug_1": "dirty"}


def test_an_apple_that_was_cut_stays_cut(home) -> None:
    assert home.perform("human", moves("kitchen_counter_1", "apple_1", "chop vegetables")).ok
    assert condition(home, "apple_1")["form"] == "cut"
    assert home.perform("human", puts("apple_1", "fridge_1", "inside")).ok
    assert condition(home, "apple_1")["form"] == "cut"
    assert "apple_1" not in home.states()  # it is in the closed fridge


def test_a_hat_that_is_put_on_is_worn_until_the_bath_and_is_nowhere_else(home) -> None:
    assert home.perform("human", moves("sofa_1", "hat_1", "put on clothes")).ok
    assert home.state.wearer("hat_1") == "human"
    assert home.state.person().thing is None
    assert not home.on("hat", "coffee_table")
    assert home.perform("robot", puts("hat_1", "sofa_1")).reason == "the human wears the hat."
    assert home.perform("human", moves("bed_1", "book", "lie and read")).ok
    assert home.state.wearer("hat_1") == "human"
    assert home.perform("human", puts("hat_1", "coffee_table_1")).ok
    assert home.on("hat", "coffee_table")


def test_a_lamp_or_a_set_is_switched_by_a_step_and_what_has_no_switch_is_not(home) -> None:
    assert home.switch("robot", "stove_1", True).ok
    assert home.states() == {"stove_1": "on"}
    assert home.switch("human", "stove_1", False).ok
    assert home.states() == {}
    assert "cannot be switched" in home.switch("human", "sofa_1", True).reason


def test_a_basket_in_a_hand_is_not_filled_and_a_full_one_goes_inside_nothing(home) -> None:
    assert home.pick("robot", "laundry_basket_1").ok
    assert "the robot has the laundry basket" in home.perform("human", puts("apple_1", "laundry_basket_1")).reason
    assert home.place("robot", "bed_1").ok
    assert home.perform("human", puts("apple_1", "laundry_basket_1")).ok
    refused = home.perform("human", puts("laundry_basket_1", "fridge_1", "inside"))
    assert not refused.ok
    home.restore(json.loads(json.dumps(home.snapshot())))


def test_a_bag_from_the_magic_box_does_not_vanish_with_a_thing_of_the_home(home) -> None:
    assert home.perform("robot", bring("laundry basket")).ok
    basket = home.state.person().thing
    assert home.place("human", "bed_1").ok
    ball = home.layout.object("tennis_ball_1")
    assert home.pick("human", "tennis_ball_1").ok
    assert home.place("human", basket).ok
    assert home.state.thing(ball).inside == basket
    assert home.pick("human", basket).ok
    assert home.perform("human", moves("sofa_1", "book", "sit and rest")).ok
    assert basket in home.state.box
    assert home.state.thing(ball).inside == basket


def test_the_pan_in_the_robots_gripper_is_brought_to_who_cooks(home) -> None:
    assert home.pick("robot", "frying_pan_1").ok
    assert home.perform("human", moves("stove_1", "egg", "fry in a pan")).fetched == ("frying_pan_1",)
    assert home.on("frying_pan", "stove")


def test_a_tool_in_the_hand_is_used_like_one_that_lies_there(home) -> None:
    assert home.perform("human", moves("dining_table_1", "plate_1", "eat a meal")).ok
    assert condition(home, "plate_1")["clean"] is False
    assert home.perform("human", moves("dining_table_1", "mug_1", "pour a drink")).ok
    assert condition(home, "mug_1")["filled"] == "water"


def test_a_second_apron_takes_the_place_of_the_first(home) -> None:
    for colour in ("red", "blue", "green"):
        assert home.perform("human", moves("bed_1", f"{colour} apron", "put on clothes")).ok
    assert [home.state.box[name].text for name in home.state.person().worn] == ["green apron"]
    assert len(home.state.box) == 1


def test_what_is_put_on_is_seen_to_be_worn_and_seen_to_come_off(home) -> None:
    assert home.perform("human", moves("sofa_1", "hat_1", "put on clothes"), record=True).ok
    shot = home._recording.shots[-1]
    assert shot.at(shot.deed).held["human"].name == "hat_1"
    last = shot.at(shot.ticks - 1)
    assert (last.worn["human"], last.held.get("human")) == (("hat_1",), None)
    assert home.perform("human", puts("hat_1", "coffee_table_1"), record=True).ok
    shot = home._recording.shots[-1]
    assert shot.at(0).worn["human"] == ()
    assert shot.at(0).held["human"].name == "hat_1"


def test_what_is_inside_something_is_taken_out_before_it_is_switched() -> None:
    scene = load_scene("oak")
    with World(scene) as world:
        phone, dresser = scene.object("phone_1"), next(thing for thing in scene.fixed if thing.cls == "dresser")
        assert world.perform("human", put(phone.name, dresser.name, "inside", scene)).ok
        assert "has to be taken out first" in world.switch("robot", phone.name, True).reason


def test_two_watch_the_set_and_it_goes_off_with_the_second() -> None:
    scene = load_scene("maple")
    watch = [move(seat, "cushion", "sit and watch the screen", scene) for seat in ("sofa_1", "armchair_1")]
    with World(scene, agents=[PersonAgent("ann"), PersonAgent("bob"), RobotAgent()]) as world:
        assert world.perform("ann", watch[0]).ok
        assert world.perform("bob", watch[1]).ok
        assert world.go_to("ann", "kitchen").ok
        assert world.states() == {"television_1": "on"}
        assert world.go_to("bob", "kitchen").ok
        assert world.states() == {}
