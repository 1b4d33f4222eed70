"""The habit learner: smoothed counts of what was told, times what is seen. No model, no feedback, forty lines.

What a person does at an hour is their habit of that hour: each told hour speaks for its intention and its things, more
at a like time of day, and more if it began with the thing that is now in hand. A thing is brought if it was used in at
least 0.3 of the hours so weighted, one hour without any thing being added to them. A robot that learns with models and
feedback should do better.
"""

from __future__ import annotations

from typing import Any

from coopera.core.affordances import affordances
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import Act, HandOver, PickPlace, Use, plain
from coopera.graphs.robots.method import Method
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.told import held, same, shares, told_hours

PATIENCE = 0.5
WORTH = 0.3  # half of an F1 of 0.6: see `coopera.graphs.robots.verdicts`


class Habits:
    """Smoothed counts of told activities by hour and of things per activity, times the percept's likelihood."""

    def help(self, view: RobotView) -> Proposal:
        """Propose what was used often enough in hours like this one, and the likeliest of their intentions."""
        told = told_hours(view)
        if not told:
            return Proposal(fallbacks=["nothing has been told yet"])
        weights = [hour.speaks for hour in told]
        total = sum(weights)
        best = max(zip(weights, told, strict=True), key=lambda pair: (round(pair[0], 9), pair[1].now))[1]
        certain = total / (total + PATIENCE)
        used = shares(told, weights, held(view.observation), places=view.collab == 1)
        chances = {use: round(one * certain, 6) for use, one in used.items()}
        tasks: dict[str, TaskCandidate] = {}
        for use, chance in sorted(chances.items(), key=lambda pair: (-pair[1], str(pair[0]))):
            act = _act(view, use)
            if act and not view.home.misfit(act) and chance > WORTH / 3:
                task = TaskCandidate(intention=best.intention, thought="as before", act=act)
                done = {"probability": chance, "accepted": chance >= WORTH}
                tasks.setdefault(act.describe(), task.model_copy(update=done))
        intention = IntentionCandidate(text=best.intention, probability=round(certain, 6), accepted=True)
        return Proposal(intentions=[intention], tasks=list(tasks.values()))

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Learn nothing else: what is told stands in the history."""
        return {"hours": len(account.hours)}


def _act(view: RobotView, use: Use) -> Act | None:
    """The help for a use: bring the thing or, in type 1, put one of its kind where it was put."""
    if view.collab != 1:
        return HandOver(object=use.thing)
    things = [name for name in view.home.movable if plain(name) == use.thing]
    spots = [name for name in view.home.fixed if plain(name) == use.place]
    if not things or not spots:
        return None
    return PickPlace(
        object_id=view.home.movable[things[0]][0],
        object=things[0],
        receptacle_id=view.home.fixed[spots[0]][0],
        receptacle=spots[0],
        relation=affordances().relation(view.home.class_of(things[0]), view.home.class_of(spots[0])),
    )


HABIT = Method(name="habit", traits=False, own=Habits)
