"""What the robot's help was worth, beyond F1 over the superset: coverage, effort saved, false help, latency, people.

F1 asks how well the robot judged *what it proposed*; a robot that proposes nothing useful can score well on it. The
measures here ask about the person's tasks instead. `docs/measures.md` defines all of them with worked examples.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from coopera.core.hour import Counts, FeedbackItem, Help, HourRecord
from coopera.core.household import Outcome
from coopera.evaluation.counts import count


def help_given(outcomes: Sequence[Outcome], useful: Sequence[Sequence[bool]], *, remaining: int) -> Help:
    """Measure an hour's help.

    Args:
        outcomes: What came of the robot's acts, in the order in which they were done.
        useful: For each of them, whether it helps with each of the person's remaining tasks (one row per outcome).
        remaining: How many tasks remained.
    """
    helped: set[int] = set()
    useless, saved = 0, 0.0
    for outcome, row in zip(outcomes, useful, strict=True):
        if not outcome.ok:
            continue
        met = {task for task, yes in enumerate(row) if yes}
        useless += not met
        if met - helped:
            saved += outcome.metres
            helped |= met
    return Help(
        remaining=remaining,
        helped=len(helped),
        done=sum(outcome.ok for outcome in outcomes),
        useless=useless,
        metres=round(sum(outcome.metres for outcome in outcomes), 6),
        saved_metres=round(saved, 6),
    )


def pool_help(hours: Iterable[Help]) -> Help:
    """Add up hours."""
    every = list(hours)
    totals = {name: sum(getattr(one, name) for one in every) for name in Help.model_fields}
    return Help(**{name: round(total, 6) for name, total in totals.items()})


def help_score(given: Help) -> float | None:
    """Share of the person's remaining tasks that were really helped, in [0, 1]; None where no task remained."""
    return given.helped / given.remaining if given.remaining else None


def false_help(given: Help, hours: int) -> float | None:
    """Acts per hour that were done and helped with nothing; None where no hour was scored."""
    return given.useless / hours if hours else None


def by_person(feedback: Iterable[FeedbackItem]) -> Counts:
    """Success as the person said it in the evening, task by task; an answer that could not be read is unscored."""
    tasks = [item for item in feedback if item.kind == "task"]
    return count([item.accepted for item in tasks], [item.helpful for item in tasks])


def l1(one: Sequence[float | None], other: Sequence[float | None]) -> float | None:
    """Mean absolute difference of two measures over the same hours (PAPER §4.4); hours without either are left out.

    None where no hour has both.
    """
    gaps = [abs(a - b) for a, b in zip(one, other, strict=True) if a is not None and b is not None]
    return float(np.mean(gaps)) if gaps else None


def robot_seconds(hours: Iterable[HourRecord]) -> list[float]:
    """Seconds per hour that the robot's own language-model calls took, replies from the cache left out.

    The person waits for these between showing the first task and being helped. Failed hours are left out.
    """
    return [
        sum(call.seconds for call in hour.calls if call.prompt.startswith("robot/") and not call.cached)
        for hour in hours
        if hour.status == "ok" and hour.robot is not None
    ]
