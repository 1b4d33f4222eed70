"""What an act achieves where it succeeds, as a goal: the measures compare acts by it."""

from __future__ import annotations

from collections.abc import Callable

from coopera.core.household import Act, HandOver, PickPlace
from coopera.simulation.goals.tree import And, Atom, Goal


def goal_of(act: Act, class_of: Callable[[str], str] = str) -> Goal:
    """The goal that a successful act brings about.

    A pick-and-place is on(thing, furniture) or inside(thing, container), a hand-over holding(receiver, thing), and a
    free motion both performed(motion) and holding(person, thing).

    Args:
        act: The act.
        class_of: Turns an object's name into what the goal calls it: its class, or (`str`) its name.
    """
    if isinstance(act, PickPlace):
        return Atom(act.relation, (class_of(act.object), class_of(act.receptacle)))
    if isinstance(act, HandOver):
        return Atom("holding", (act.receiver or "person", class_of(act.object)))
    return And((Atom("performed", (act.motion,)), Atom("holding", ("person", class_of(act.in_hand)))))
