"""What a film of single steps shows."""

from __future__ import annotations

import gc
import weakref

import pytest

from coopera.simulation.acts.plans import Open, Play, Walk
from coopera.simulation.bodies.humanoid_reach import standing
from coopera.simulation.sight.recording import Filming
from coopera.simulation.sight.stances import still
from coopera.simulation.state.home_state import HomeState, PersonState
from coopera.simulation.ways.navigation import Stand
from coopera.simulation.world import World
from tests.simulation.flat import flat


@pytest.fixture(scope="module")
def ground():
    with World(flat(), frame_size=(64, 48)) as world:
        yield world._ground, HomeState.model_validate(world.snapshot())


def test_furniture_is_open_from_the_reach_on_and_the_hand_keeps_what_it_has(ground) -> None:
    known, start = ground
    start = start.with_held("human", "mug_1")
    step = Open("human", Stand(2.0, 2.0, 0.0, 0.0, 0.0), standing(), "fridge_1", opens=True)
    shut = Open("human", Stand(2.0, 2.0, 0.0, 0.0, 0.0), standing(), "fridge_1", opens=False)
    recording = Filming(known, start, "robot", "human").film([step, shut], "human")
    first, second = recording.shots
    assert first.at(0).opened == frozenset()
    assert first.at(first.ticks - 1).opened == {"fridge_1"}
    assert second.at(0).opened == {"fridge_1"}
    assert second.at(second.ticks - 1).opened == frozenset()
    assert {shot.at(tick).held["human"].name for shot in (first, second) for tick in (0, shot.deed)} == {"mug_1"}


def test_a_film_that_nobody_keeps_goes_at_once_without_a_look_for_garbage(ground) -> None:
    known, start = ground
    walk = Walk("human", [(0.0, 0.0), (2.0, 2.0)])
    step = Open("human", Stand(2.0, 2.0, 0.0, 0.0, 0.0), standing(), "fridge_1", opens=True)
    recording = Filming(known, start, "robot", "human").film([walk, step], "human")
    assert recording.shots[0].at(3).bodies
    left = weakref.ref(recording.shots[0].at)
    gc.disable()
    try:
        del recording
        assert left() is None
    finally:
        gc.enable()


def test_what_was_left_open_is_open_in_the_next_film(ground) -> None:
    known, start = ground
    left = start.model_copy(update={"conditions": {"fridge_1": {"open": True}, "stove_1": {"powered": True}}})
    assert Filming(known, left, "robot", "human").opened == {"fridge_1"}


def test_what_is_put_on_is_in_the_hand_while_it_is_put_on_and_worn_afterwards(ground) -> None:
    known, start = ground
    start = start.with_held("human", "mug_1")
    body = start.person("human")
    plays = [
        Play("human", body.model_copy(update={"worn": ("hat_1",)}), known.motions["put on clothes"]),
        Play("human", body.model_copy(update={"worn": ("hat_1",)}), known.motions["stand and wait"]),
    ]
    first, second = Filming(known, start, "robot", "human").film(plays, "human").shots
    assert "human" not in first.at(first.deed).worn
    assert second.at(0).worn == {"human": ("hat_1",)}


def test_who_has_something_before_them_still_has_it_there_between_two_acts(ground) -> None:
    known, start = ground
    table = next(piece for piece in known.scene.fixed if piece.cls == "dining_table")
    x, y, _ = table.to_world(0.0, table.size[1] / 2 + 0.4, 0.0)
    sits = PersonState(
        spot=(x, y),
        place=(x, y),
        yaw=table.facing + 3.141592653589793,
        support=0.45,
        worktop=table.top,
        posture="sit",
        motion="type on a keyboard",
        thing="laptop_7",
        at=table.name,
    )
    filming = Filming(known, start.put("human", sits), "robot", "human")
    laid = filming.held["human"].grip.laid
    assert laid is not None
    assert laid.z == pytest.approx(table.top)
    assert still(known, start.put("human", sits), "human").pose.shape == (43,)
