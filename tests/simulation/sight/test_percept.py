from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from coopera.core.errors import SimulationError
from coopera.core.household import PerceptErrors
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put
from tests.simulation.kitchen import HOME, moves, puts

SURE = PerceptErrors(motion_confused=0.0, in_hand_missed=0.0)


@pytest.fixture(scope="module")
def home():
    with World(flat(), errors=SURE) as world:
        yield world


@pytest.fixture
def kitchen():
    with World(HOME, errors=SURE) as world:
        yield world


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def test_a_percept_tells_room_furniture_motion_class_and_thing(home) -> None:
    assert home.perform("human", move("dining_table_1", "bowl", "eat a meal"), record=True).ok
    percept = home.percept(rng())
    assert percept.room == "kitchen"
    assert percept.near == ["dining_table_1", "dining_chair_1"]
    assert percept.motion == "eat or drink"
    assert percept.in_hand == "bowl"
    assert percept.visible == sorted(percept.visible)
    assert "dining_table_1" in percept.visible
    assert "bed_1" not in percept.visible


def test_a_percept_of_carrying_names_where_the_thing_went_before_where_it_came_from(home) -> None:
    assert home.perform("human", put("mug_1", "dining_table_1"), record=True).ok
    percept = home.percept(rng())
    assert percept.near == ["dining_table_1", "kitchen_counter_1"]
    assert percept.motion == "carry or tidy things"
    assert percept.in_hand == "mug"


def test_a_percept_tells_the_states_that_an_act_leaves_visible_objects_in(kitchen) -> None:
    assert kitchen.perform("human", moves("stove_1", "egg", "fry in a pan"), record=True).ok
    percept = kitchen.percept(rng())
    assert percept.states["stove_1"] == "on, dirty"
    assert set(percept.states) <= set(percept.visible)
    assert kitchen.perform("human", moves("dining_table_1", "fork", "eat a meal"), record=True).ok
    percept = kitchen.percept(rng())
    assert percept.states["plate_1"] == "dirty"
    assert "stove_1" in kitchen.states()
    assert "stove_1" not in percept.visible
    assert "stove_1" not in percept.states


def test_a_percept_tells_of_what_stands_open_only_where_it_is_seen(kitchen) -> None:
    assert kitchen.set_open("robot", "fridge_1", True).ok
    assert kitchen.perform("human", puts("apple_1", "dining_table_1"), record=True).ok
    assert kitchen.percept(rng()).states == {"fridge_1": "open"}
    assert kitchen.perform("human", moves("sofa_1", "book_1", "sit and read"), record=True).ok
    assert kitchen.percept(rng()).states == {}
    assert kitchen.states() == {"fridge_1": "open"}


def test_a_percept_tells_no_state_of_what_is_inside_something_closed_or_in_a_hand(kitchen) -> None:
    assert kitchen.perform("human", moves("dining_table_1", "fork", "eat a meal")).ok
    assert kitchen.perform("human", puts("plate_1", "fridge_1", "inside"), record=True).ok
    percept = kitchen.percept(rng())
    assert "fridge_1" in percept.visible
    assert percept.states == {}
    assert kitchen.perform("human", moves("sofa_1", "plate_1", "sit and rest"), record=True).ok
    assert kitchen.state.condition(HOME.object("plate_1"))["clean"] is False
    assert kitchen.percept(rng()).states == {}


def test_a_percept_tells_states_as_they_were_when_the_act_ended_or_failed(kitchen) -> None:
    assert kitchen.set_open("robot", "fridge_1", True).ok
    assert kitchen.perform("human", puts("apple_1", "dining_table_1"), record=True).ok
    assert kitchen.set_open("robot", "fridge_1", False).ok
    assert kitchen.percept(rng()).states == {"fridge_1": "open"}
    assert not kitchen.perform("human", puts("unicorn_1", "sofa_1"), record=True).ok
    percept = kitchen.percept(rng())
    assert "fridge_1" in percept.visible
    assert percept.states == {}
    assert kitchen.set_open("robot", "fridge_1", True).ok
    assert not kitchen.perform("human", puts("unicorn_1", "sofa_1"), record=True).ok
    assert kitchen.percept(rng()).states == {"fridge_1": "open"}


@pytest.mark.parametrize("motion", ["take a nap", "knit and sew", "do squats", "talk on the phone"])
def test_a_percept_never_contains_the_task_or_the_caption_of_the_motion(home, motion) -> None:
    act = move("sofa_1", "knitting_basket", motion)
    assert home.perform("human", act, record=True).ok
    for seed in range(20):
        said = home.percept(rng(seed))
        text = f"{said.caption()} {said.model_dump_json()}".lower()
        assert motion not in text
        assert act.describe() not in text


def test_the_same_draw_gives_the_same_percept_and_recording_does_not_depend_on_it(home) -> None:
    home.perform("human", move("sofa_1", "book", "sit and read"), record=True)
    assert home.percept(rng(5)) == home.percept(rng(5))


def test_errors_come_at_their_rates() -> None:
    with World(flat()) as world:
        world.perform("human", move("sofa_1", "book", "sit and read"), record=True)
        draws = rng(1)
        seen = [world.percept(draws) for _ in range(150)]
    wrong = np.mean([percept.motion != "look at something held" for percept in seen])
    missed = np.mean([percept.in_hand is None for percept in seen])
    assert wrong == pytest.approx(0.15, abs=0.06)
    assert missed == pytest.approx(0.20, abs=0.07)
    assert "exercise" not in {percept.motion for percept in seen}  # nobody takes a sitter for an athlete


def test_always_confused_is_never_right() -> None:
    with World(flat(), errors=PerceptErrors(motion_confused=1.0, in_hand_missed=1.0)) as world:
        world.perform("human", move("bed_1", "book", "lie and read"), record=True)
        percept = world.percept(rng())
    assert percept.motion == "rest lying"
    assert percept.in_hand is None


def test_a_failed_act_shows_the_person_as_they_are(home) -> None:
    home.perform("human", move("sofa_1", "book", "sit and read"))
    assert not home.perform("human", put("unicorn_1", "sofa_1"), record=True).ok
    percept = home.percept(rng())
    assert (percept.room, percept.near, percept.motion) == ("living room", ["sofa_1"], "look at something held")


def test_without_a_recording_there_is_no_percept(tmp_path) -> None:
    with World(flat()) as world:
        world.perform("human", move("sofa_1", "book", "sit and read"))
        with pytest.raises(SimulationError, match="Nothing has been recorded"):
            world.percept(rng())
        with pytest.raises(SimulationError, match="Nothing has been recorded"):
            world.frames(2, tmp_path)


def test_the_newest_recording_counts(home) -> None:
    home.perform("human", move("sofa_1", "book", "sit and read"), record=True)
    home.perform("robot", bring("banana"))
    assert home.percept(rng()).in_hand == "book"
    home.perform("human", move("bed_1", "book", "take a nap"), record=True)
    assert home.percept(rng()).near == ["bed_1"]


def test_an_error_rate_is_a_share() -> None:
    with pytest.raises(ValidationError):
        PerceptErrors(motion_confused=1.5)
