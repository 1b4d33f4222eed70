"""Whether a goal holds at a moment, whether a day met it, and when it was met first."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from operator import or_
from typing import NamedTuple

from coopera.core.errors import ConfigError
from coopera.simulation.goals.atoms import Moment, Similarity, true
from coopera.simulation.goals.checking import check
from coopera.simulation.goals.tree import And, Atom, Eventually, Goal, Not, Or, over_a_day
from coopera.simulation.homes.scene import Scene
from coopera.simulation.state.home_state import HomeState


class Met(NamedTuple):
    """How a day came out: whether it met the goal, and the first moment (from 0) at which the day so far did.

    A day that met a goal only for a while has a first moment, and did not meet it.
    """

    met: bool
    first: int | None


def holds(goal: Goal, scene: Scene, state: HomeState, similarity: Similarity | None = None) -> bool:
    """Whether a goal holds at one moment.

    Raises:
        ConfigError: If the goal is about a day, or has a word that means nothing in this home.
    """
    part = over_a_day(goal)
    if part is not None:
        raise ConfigError(f"{part} is about a day, of which one moment says nothing; ask `met` with all its moments.")
    check(goal, [scene], {agent: body.kind for agent, body in state.agents.items()})
    return course(goal, [Moment(scene, state, similarity)])[0]


def met(goal: Goal, scene: Scene, states: Sequence[HomeState], similarity: Similarity | None = None) -> Met:
    """Whether a day met a goal.

    Args:
        goal: What is said of no particular moment (neither `then` nor `eventually`) is asked of the last one.
        scene: The home of the day.
        states: The home at each moment of the day, that is after each act; a day without any meets no goal.
        similarity: Compares motions; without it only equal captions count.

    Raises:
        ConfigError: If the goal has a word that means nothing in this home.
    """
    if states:
        check(goal, [scene], {agent: body.kind for agent, body in states[0].agents.items()})
    return outcome(goal, [Moment(scene, state, similarity) for state in states])


def outcome(goal: Goal, moments: Sequence[Moment]) -> Met:
    """The same for a goal that was checked."""
    found = course(goal, moments)
    return Met(bool(found) and found[-1], found.index(True) if True in found else None)


def course(goal: Goal, moments: Sequence[Moment]) -> list[bool]:
    """For each moment, whether the day up to it meets a goal."""
    if isinstance(goal, Atom):
        return [true(now, goal) for now in moments]
    if isinstance(goal, Not):
        return [not so for so in course(goal.goal, moments)]
    if isinstance(goal, Eventually):
        return list(accumulate(course(goal.goal, moments), or_))
    rows = [course(part, moments) for part in goal.goals]
    if isinstance(goal, And):
        return [all(so) for so in zip(*rows, strict=True)]
    if isinstance(goal, Or):
        return [any(so) for so in zip(*rows, strict=True)]
    return _in_order(rows, len(moments))


def _in_order(rows: Sequence[Sequence[bool]], moments: int) -> list[bool]:
    """`then`: whether, up to each moment, the rows were true one after the other; several may be so at one moment."""
    reached, found = 0, []
    for now in range(moments):
        while reached < len(rows) and rows[reached][now]:
            reached += 1
        found.append(reached == len(rows))
    return found
