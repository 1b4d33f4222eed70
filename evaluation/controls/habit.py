"""The habit learner: smoothed counts of what was told, times what is seen. No model, no feedback, forty lines.

What a person does at an hour is their habit of that hour: each told hour speaks for its intention and its things, more
at a like time of day, and more if it began with the thing that is now in hand. A thing is brought if it was used in at
least 0.3 of the hours so weighted, one hour without any thing being added to them. A robot that learns with models and
feedback should do better.
"""

from __future__ import annotations

from typing import Any

from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.evaluation.controls.acts import help_with
from coopera.graphs.robots.method import Method
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.told import held, shares, told_hours

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
            act = help_with(view, use)
            if act and chance > WORTH / 3:
                task = TaskCandidate(intention=best.intention, thought="as before", act=act)
                done = {"probability": chance, "accepted": chance >= WORTH}
                tasks.setdefault(act.describe(), task.model_copy(update=done))
        intention = IntentionCandidate(text=best.intention, probability=round(certain, 6), accepted=True)
        return Proposal(intentions=[intention], tasks=list(tasks.values()))

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Learn nothing else: what is told stands in the history."""
        return {"hours": len(account.hours)}


HABIT = Method(name="habit", traits=False, own=Habits)
