"""Acts move things truthfully, or fail with a reason: those of the graphs and the single steps alike."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from coopera.core.affordances import affordances
from coopera.core.errors import SimulationError
from coopera.simulation import World, load_scene
from coopera.simulation.acts.plans import Handle, Walk
from coopera.simulation.motions.library import Library, load_library
from tests.simulation.flat import bring, move
from tests.simulation.kitchen import HOME, moves, puts


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


def _meaning(**near: dict[str, float]) -> Any:
    """Ranks all captions for a text: those given for a word of it, and the others far away."""

    def rank(text: str) -> list[tuple[str, float]]:
        given = {caption: cosine for word, some in near.items() if word in text for caption, cosine in some.items()}
        captions = load_library().captions
        return sorted(((caption, given.get(caption, 0.0)) for caption in captions), key=lambda one: -one[1])

    return rank


def test_words_that_mean_no_motion_are_shown_by_a_neutral_one_that_says_so() -> None:
    with World(HOME, match=_meaning(qwertz={"spin around": 0.27, "comb the hair": 0.24})) as home:
        seated = home.perform("human", moves("sofa_1", "mug", "qwertz blorp"))
        standing = home.perform("human", moves("fridge_1", "mug", "qwertz blorp"))
    assert (seated.ok, seated.motion, seated.neutral) == (True, "sit and rest", True)
    assert (standing.ok, standing.motion, standing.neutral) == (True, "stand and wait", True)
    assert seated.asked == "qwertz blorp with mug at sofa"


def test_a_body_without_a_neutral_motion_refuses_words_that_mean_none_with_the_nearest_ones() -> None:
    dancer = Library([motion for motion in load_library().motions if "dance" in motion.caption])
    with World(HOME, motions=dancer, match=lambda _: [("dance", 0.2)]) as home:
        refused = home.perform("human", moves("sofa_1", "mug", "qwertz blorp"))
    assert refused.reason == "nobody here knows how to 'qwertz blorp'; known motions are: dance and others."


def test_words_mean_a_motion_together_with_thing_and_place() -> None:
    said = {"wash it": {"wash the face": 0.6, "wash dishes": 0.5, "wipe the surface": 0.4}}
    together = {"cup at kitchen sink": {"wash dishes": 0.8}, "cloth at kitchen sink": {"wipe the surface": 0.9}}

    def rank(text: str) -> list[tuple[str, float]]:
        near = next((some for words, some in together.items() if words in text), said["wash it"])
        return sorted(((one, near.get(one, 0.1)) for one in load_library().captions), key=lambda pair: -pair[1])

    with World(HOME, match=rank) as home:
        assert home.plan("human", moves("kitchen_sink_1", "cup", "wash it")).meant.caption == "wash dishes"
        assert home.plan("human", moves("kitchen_sink_1", "cloth", "wash it")).meant.caption == "wipe the surface"


def test_of_two_motions_that_are_as_near_the_one_that_is_done_with_the_thing_in_hand_is_made() -> None:
    with World(HOME, match=_meaning(busy={"write by hand": 0.5, "type on a keyboard": 0.5})) as home:
        assert home.plan("human", moves("dining_table_1", "notebook", "be busy")).meant.caption == "write by hand"
        assert home.plan("human", moves("dining_table_1", "laptop", "be busy")).meant.caption == "type on a keyboard"


def test_a_posture_that_is_said_counts() -> None:
    with World(HOME, match=_meaning(sip={"stand and drink": 0.55, "drink from a cup": 0.5})) as home:
        assert home.plan("human", moves("sofa_1", "mug", "sip slowly")).meant.caption == "stand and drink"
        assert home.plan("human", moves("sofa_1", "mug", "sit down and sip")).meant.caption == "drink from a cup"


def test_words_that_surely_mean_what_cannot_be_done_there_are_refused() -> None:
    with World(HOME, match=_meaning(soup={"stir a pot": 0.8, "sit and rest": 0.2})) as home:
        assert "stove_1 would do" in home.misfit("human", moves("sofa_1", "cooking pot", "stir the soup"))


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
