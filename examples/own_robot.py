"""Bring your own robot: offer what this person had in hand at this hour on earlier days, and compare it with ours.

Run it with `.venv/bin/python examples/own_robot.py`. To choose it as `coopera run --method habits`, register METHOD as
an entry point of your package in the group "coopera.methods".
"""

from __future__ import annotations

import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from coopera import Config, check_method, run_study
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import FreeMotion, HandOver
from coopera.evaluation import register
from coopera.graphs import Method, RobotView


class Habits:
    """Knows how often each thing was in whose hand at which hour; for collaboration type 2."""

    def __init__(self) -> None:
        self.seen: Counter[tuple[str, int, str]] = Counter()

    def help(self, view: RobotView) -> Proposal:
        """Offer the five things most often in hand within an hour of now."""
        now, near = view.clock.hour, Counter[str]()
        for (person, hour, thing), times in self.seen.items():
            if person == view.person and abs(hour - now) <= 1:
                near[thing] += times
        acts = [HandOver(object=thing) for thing, _ in sorted(near.items(), key=lambda item: (-item[1], item[0]))[:5]]
        usual = IntentionCandidate(text="Do the usual", accepted=True)
        tasks = [TaskCandidate(intention=usual.text, thought="as before", act=act, accepted=True) for act in acts]
        return Proposal(intentions=[usual], tasks=tasks)

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Count what the person says they had in hand."""
        acts = [(hour.hour, act) for hour in account.hours for act in hour.tasks if isinstance(act, FreeMotion)]
        self.seen.update((account.person, hour, act.in_hand) for hour, act in acts)
        return {"things": len(self.seen)}


METHOD = register(Method(name="habits", own=Habits))

if __name__ == "__main__":
    check_method(METHOD, collabs=(2,))
    for method in ("habits", "ours"):
        with tempfile.TemporaryDirectory() as folder:
            summary = run_study(Config(method=method, days=3, pictures="none", out=Path(folder) / method))
            print(method, [day["predicate"]["f1"] for day in summary["days"]])
