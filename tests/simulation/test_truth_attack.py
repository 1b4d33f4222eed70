"""The attack on a home finds a home that lies: each kind of lie is seen in the state, whatever the answer says."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from benchmarks.random_commands import Answer, Command, Commander, as_told, carry_out
from benchmarks.truth import Watched, attack, parted, violations
from coopera.core.household import HUMAN, ROBOT
from coopera.simulation import World
from coopera.simulation.state.home_state import HomeState, ThingState
from tests.simulation.flat import bring, flat, move, put

Lie = Callable[[HomeState], HomeState]


def seen_after(command: Command, lie: Lie = lambda state: state) -> list[str]:
    """What the attack sees after a command in a home that then changes by itself."""
    with Watched(flat()) as world:
        before = world.state
        answer = carry_out(world, command)
        world.state = lie(world.state)
        return list(violations(world, before, command, world.last, answer))


PUT = Command("perform", HUMAN, put("mug_1", "dining_table_1"))
SIT = Command("perform", HUMAN, move("sofa_1", "book", "sit and read"))
REFUSED = Command("perform", ROBOT, put("mug_1", "nowhere_1"))


@pytest.mark.parametrize(
    "command",
    [
        PUT,
        SIT,
        REFUSED,
        Command("perform", ROBOT, bring("apple")),
        Command("go_to", ROBOT, ("kitchen",)),
        Command("pick", ROBOT, ("tennis_ball_1",)),
        Command("tool look_around", ROBOT, {}),
        Command("perform", "nobody", bring("apple")),
    ],
    ids=str,
)
def test_nothing_is_said_of_a_home_that_keeps_its_word(command: Command) -> None:
    assert seen_after(command) == []


def on_the_floor(name: str, x: float, y: float) -> Lie:
    return lambda state: state.with_thing(name, ThingState(position=(x, y, 0.0), yaw=0.0, on=None))


LIES: dict[str, tuple[Command, Lie, str]] = {
    "somebody jumps": (
        PUT,
        lambda state: state.with_agent(ROBOT, spot=(3.4, 1.5)),
        "m from where their walks lead",
    ),
    "a thing jumps": (PUT, on_the_floor("book_1", 3.4, 1.5), "nobody's hand takes book_1 from where it was"),
    "a thing is put elsewhere": (PUT, on_the_floor("mug_1", 3.4, 1.5), "nobody's hand puts mug_1 where it is"),
    "a thing changes hands": (
        Command("pick", ROBOT, ("tennis_ball_1",)),
        lambda state: state.with_held(HUMAN, "book_1"),
        "nobody's hand takes book_1",
    ),
    "a thing is in two places": (
        PUT,
        lambda state: state.with_agent(ROBOT, thing="mug_1"),
        "mug_1 is in more than one place",
    ),
    "a thing is far from who sits": (
        SIT,
        lambda state: state.with_agent(HUMAN, place=(3.6, 2.0)),
        "m from sofa_1, more than",
    ),
    "a thing sticks through its carrier": (
        Command("perform", HUMAN, put("mug_1", "sofa_1")),
        lambda state: state.with_thing("mug_1", ThingState(position=(1.5, 0.12, 0.82 * 0.5), yaw=0.0, on="sofa_1")),
        "into a part of sofa_1",
    ),
    "a refusal changes something": (
        REFUSED,
        lambda state: state.with_agent(ROBOT, yaw=1.0),
        "it is refused, and the home has changed",
    ),
}


@pytest.mark.parametrize(("command", "lie", "said"), LIES.values(), ids=LIES.keys())
def test_each_lie_is_seen(command: Command, lie: Lie, said: str) -> None:
    assert any(said in one for one in seen_after(command, lie))


@pytest.mark.parametrize("reason", ["", "no full stop", "Two sentences. Not one.", "two\nlines."])
def test_a_reason_is_one_sentence(reason: str) -> None:
    with World(flat()) as world:
        found = list(violations(world, world.state, REFUSED, None, Answer(False, reason)))
    assert found == [f"the reason is no sentence: {reason!r}"]


def test_an_exception_that_is_not_documented_is_told_in_the_answer() -> None:
    with World(flat()) as world:
        assert carry_out(world, Command("dance", HUMAN, ())).raised.startswith("AttributeError")
        assert carry_out(world, Command("go_to", "nobody", ("kitchen",))).raised == ""


def test_a_restored_home_that_does_something_else_is_seen() -> None:
    command = Command("go_to", ROBOT, ("kitchen",))
    with World(flat()) as world, World(flat()) as twin:
        answer = carry_out(world, command)
        assert parted(world, twin, command, answer) == []
        assert parted(world, twin, command, answer) == ["a home restored from a snapshot does something else"]


def test_the_same_seed_gives_the_same_commands() -> None:
    told = []
    for _ in range(2):
        with World(flat()) as world:
            commander = Commander(world, 3)
            told.append([as_told(carry_out(world, commander.command())) for _ in range(40)])
    assert told[0] == told[1]


def test_a_new_home_that_ends_in_another_state_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmarks.truth.relived", lambda *_: "another digest")
    assert "the same commands lead a new home to another state" in attack("pine", "fetch", 3, 0).violations


def test_a_home_keeps_its_word_under_many_random_commands() -> None:
    tally = attack("pine", "fetch", 150, 0)
    assert tally.given == 150
    assert tally.done >= 30
    assert tally.violations == []
