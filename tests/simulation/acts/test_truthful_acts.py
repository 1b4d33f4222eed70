"""Acts move things truthfully, or fail with a reason: those of the graphs and the single steps alike."""

from __future__ import annotations

import json
import math

import pytest

from coopera.core.affordances import affordances
from coopera.core.errors import SimulationError
from coopera.simulation import PersonAgent, RobotAgent, World, load_scene
from coopera.simulation.acts.plans import Handle, Open, Walk
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.library import load_library
from coopera.simulation.state.truth import problems
from tests.simulation.flat import bring, flat, move, put

KITCHEN = [
    ("fridge_1", "large kitchen appliance", (6.8, 4.6, 0.0), math.pi, (0.65, 0.66, 1.28), None, True),
    ("stove_1", "large kitchen appliance", (7.7, 4.6, 0.0), math.pi, (0.62, 0.62, 0.9), None, True),
    ("kitchen_sink_1", "kitchen bathroom fixture", (7.4, 0.35, 0.0), 0.0, (1.1, 0.62, 0.9), None, True),
    ("frying_pan_1", "kitchen ware", (8.6, 2.3, 0.9), 0.0, (0.44, 0.25, 0.05), "kitchen_counter_1", False),
    ("plate_1", "dining ware", (6.65, 3.2, 0.75), 0.0, (0.25, 0.25, 0.025), "dining_table_1", False),
    ("hat_1", "wearable", (2.3, 2.2, 0.44), 0.0, (0.2, 0.2, 0.1), "coffee_table_1", False),
]


def kitchen() -> Scene:
    """The flat with a fridge, a stove and a sink, and some things to use there."""
    home = flat()
    more = [
        SceneObject(
            id=100 + i,
            name=name,
            cls=name.rsplit("_", 1)[0],
            category=category,
            fixed=fixed,
            room="living room" if position[0] < 4.5 else "kitchen",
            position=position,
            yaw=yaw,
            size=size,
            colour="#8a5a32",
            on=on,
        )
        for i, (name, category, position, yaw, size, on, fixed) in enumerate(KITCHEN)
    ]
    return home.model_copy(update={"objects": [*home.objects, *more]})


HOME = kitchen()


@pytest.fixture
def home():
    with World(HOME) as world:
        yield world
        assert list(problems(world.layout, world.state)) == []


def moves(target: str, in_hand: str, motion: str):
    return move(target, in_hand, motion, HOME)


def puts(thing: str, receptacle: str, relation="on"):
    return put(thing, receptacle, relation, HOME)


def condition(home: World, name: str) -> dict[str, bool | str]:
    return home.state.condition(home.state.find(home.layout, name))


def test_what_the_robot_holds_is_brought_to_the_person_who_puts_it_somewhere(home) -> None:
    assert home.pick("robot", "mug_1").ok
    assert home.perform("human", puts("mug_1", "sofa_1")).ok
    assert home.on("mug", "sofa")
    assert home.state.holder("mug_1") is None


def test_the_robot_is_given_what_the_person_holds(home) -> None:
    assert home.pick("human", "mug_1").ok
    assert home.perform("robot", puts("mug_1", "sofa_1")).ok
    assert home.on("mug", "sofa")
    assert home.state.holder("mug_1") is None


def test_what_the_person_carries_is_put_down_where_they_are_before_they_do_something_else(home) -> None:
    assert home.pick("human", "mug_1").ok
    assert home.go_to("human", "living room").ok
    assert home.perform("human", moves("sofa_1", "book", "sit and read")).ok
    where = home.state.thing(home.layout.object("mug_1"))
    assert home.layout.room_at(*where.position[:2]).name == "living room"
    assert where.on is not None


def test_a_thing_of_the_home_is_fetched_before_it_is_in_hand(home) -> None:
    act = moves("sofa_1", "mug_1", "sit and rest")
    plan = home.plan("human", act)
    grasp = next(step for step in plan.steps if isinstance(step, Handle))
    assert isinstance(plan.steps[0], Walk)
    assert math.dist((grasp.stand.x, grasp.stand.y), home.layout.object("mug_1").xy) <= 1.0
    outcome = home.perform("human", act)
    assert outcome.fetched == ("mug_1",)
    assert home.state.holder("mug_1") == "human"
    assert home.state.box == {}


def test_the_robot_fetches_the_very_thing_that_it_hands_over(home) -> None:
    plan = home.plan("robot", bring("mug_1"))
    assert any(isinstance(step, Handle) and step.name == "mug_1" for step in plan.steps)
    assert home.perform("robot", bring("mug_1")).ok
    assert home.state.holder("mug_1") == "human"
    assert not home.on("mug", "kitchen_counter")


def test_nothing_is_handed_over_into_a_hand_that_has_a_thing_of_the_home(home) -> None:
    home.pick("human", "mug_1")
    before = home.snapshot()
    assert home.perform("robot", bring("banana")).reason == "the human has the mug in hand."
    assert home.snapshot() == before


@pytest.mark.parametrize("home_id", ["maple", "pine"])
def test_every_motion_is_done_at_the_named_furniture_or_refused_with_what_would_do(home_id) -> None:
    scene = load_scene(home_id)
    reach = {"roomy": 1.5, "sight": 5.0, "hands": 0.9}
    with World(scene) as world:
        for number, motion in enumerate(load_library().motions):
            target = scene.fixed[(7 * number) % len(scene.fixed)]
            world.restore({})
            outcome = world.perform("human", move(target.name, "mug", motion.caption, scene))
            if not outcome.ok:
                assert len(outcome.reason) > 20
                continue
            said = affordances().of(motion.caption)
            assert affordances().suits(motion.caption, target.cls)
            far = "sight" if target.cls in affordances().looked_at else "roomy" if said.roomy else "hands"
            far = "roomy" if motion.posture == "floor" else far
            chair_and_knees = 0.6 if world.state.person().posture == "sit" else 0.0
            assert target.bounds.distance(*world.state.person().place) <= reach[far] + chair_and_knees, outcome


def test_a_motion_that_does_not_fit_is_refused_with_furniture_that_would_do(home) -> None:
    refused = home.perform("human", moves("dining_table_1", "blanket", "lie down"))
    assert refused.reason == "nobody can lie down at the dining table; bed_1 or sofa_1 would do."
    assert home.misfit("human", moves("dining_table_1", "blanket", "lie down")) == refused.reason
    assert home.misfit("human", moves("bed_1", "blanket", "lie down")) == ""


def test_a_text_that_means_no_motion_is_refused_with_the_nearest_ones() -> None:
    ranked = [("spin around", 0.27), ("comb the hair", 0.24), ("dance", 0.2)]
    with World(HOME, match=lambda _: ranked) as home:
        refused = home.perform("human", moves("sofa_1", "mug", "qwertz blorp"))
    assert not refused.ok
    assert refused.reason.startswith("nobody here knows how to 'qwertz blorp'; known motions are: spin around; comb")


def test_an_outcome_says_which_motion_was_played_and_how_near_it_was_asked_for() -> None:
    ranked = [("pour a drink", 0.62), ("drink from a cup", 0.46)]
    with World(HOME, match=lambda _: ranked) as home:
        on_the_sofa = home.perform("human", moves("sofa_1", "mug", "sip slowly"))
        at_the_table = home.perform("human", moves("dining_table_1", "mug", "sip slowly"))
    assert (on_the_sofa.motion, on_the_sofa.cosine) == ("drink from a cup", 0.46)
    assert (at_the_table.motion, at_the_table.cosine) == ("pour a drink", 0.62)


def test_a_thing_from_the_magic_box_can_be_put_down_taken_and_put_down_again(home) -> None:
    assert home.perform("human", moves("sofa_1", "red mug", "sit and rest")).ok
    name = home.state.person().thing
    assert home.place("human", "coffee_table_1").ok
    assert home.state.thing(home.state.find(home.layout, name)).on == "coffee_table_1"
    assert name in home.objects("movable")
    assert home.pick("robot", name).ok
    assert home.place("robot", "dining_table_1").ok
    assert home.state.box[name].text == "red mug"


def test_a_robot_with_a_thing_in_its_gripper_can_always_put_it_down(home) -> None:
    assert home.pick("robot", "mug_1").ok
    assert home.perform("robot", bring("banana")).reason == "the robot must first put down the mug."
    assert home.place("robot", "sofa_1").ok
    assert home.perform("robot", bring("banana")).ok


@pytest.mark.parametrize("agent", ["dog", "", "Human"])
def test_who_does_not_live_here_does_nothing(home, agent) -> None:
    before = home.snapshot()
    for deed in (
        lambda: home.go_to(agent, "sofa_1"),
        lambda: home.perform(agent, moves("sofa_1", "mug", "sit and rest")),
        lambda: home.set_open(agent, "fridge_1", True),
        lambda: home.misfit(agent, puts("mug_1", "sofa_1")),
    ):
        with pytest.raises(SimulationError, match="There is no agent"):
            deed()
    assert home.snapshot() == before


@pytest.mark.parametrize(
    ("where", "value"),
    [
        (("agents", "human", "spot"), [math.nan, 1.0]),
        (("agents", "robot", "spot"), [1e9, 1.0]),
        (("moved",), {"mug_1": {"position": [math.nan, 0, 0], "yaw": 0, "on": None}}),
        (("moved",), {"mug_1": {"position": [1e9, 0, 0], "yaw": 0, "on": None}}),
        (("moved",), {"mug_1": {"position": [1, 1, 0], "yaw": 0, "on": "sofa_1", "inside": "fridge_1"}}),
        (("moved",), {"mug_1": {"position": [1, 1, 0], "yaw": 0, "on": "unicorn_1"}}),
        (("conditions",), {"sofa_1": {"open": True}}),
        (("conditions",), {"fridge_1": {"open": "wide"}}),
        (("agents", "human", "thing"), "unicorn_1"),
    ],
)
def test_a_snapshot_that_cannot_be_true_is_refused(home, where, value) -> None:
    before = home.snapshot()
    damaged = json.loads(json.dumps(before))
    place = damaged
    for key in where[:-1]:
        place = place[key]
    place[where[-1]] = value
    with pytest.raises(SimulationError):
        home.restore(damaged)
    assert home.snapshot() == before


@pytest.mark.parametrize(
    ("act", "reason"),
    [
        (puts("mug_1", "sofa_1").model_copy(update={"object_id": 3}), "mug_1 has the id 17, not 3."),
        (puts("mug_1", "sofa_1").model_copy(update={"receptacle_id": 3}), "sofa_1 has the id 10, not 3."),
        (moves("sofa_1", "mug", "sit and rest").model_copy(update={"target_id": 3}), "sofa_1 has the id 10, not 3."),
        (puts("laundry_basket_1", "laundry_basket_1"), "the laundry basket cannot be put on itself."),
        (puts("mug_1", "sofa_1", "inside"), "nothing can be put inside the sofa; fridge_1 would do."),
        (puts("cushion_1", "mug_1", "inside"), "the mug is no piece of furniture."),
        (moves("sofa_1", "bed_1", "sit and rest"), "the bed cannot be held in a hand."),
        (moves("washbasin_1", "phone", "sit and rest"), "nobody can sit and rest at the washbasin; dining_chair_1"),
    ],
)
def test_what_cannot_be_meant_is_refused_by_the_check_and_by_the_act_alike(home, act, reason) -> None:
    before = home.snapshot()
    assert home.perform("human", act).reason.startswith(reason)
    assert home.misfit("human", act).startswith(reason)
    assert home.snapshot() == before


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
