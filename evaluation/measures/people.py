"""Success by the person: what they meant by their answers in the evening.

A measure is not noisy on purpose: where people slip (`--feedback-noise`), the robot hears the slip, and this counts
what was meant. What was left open (`--feedback-rate`), or could not be read, is unscored.
"""

from __future__ import annotations

from collections.abc import Sequence

from coopera.core.hour import FeedbackItem
from coopera.core.success import Counts
from coopera.evaluation.counts import count, pool
from coopera.evaluation.measuring import MeasureSpec


def by_person(feedback: Sequence[FeedbackItem]) -> Counts:
    """Count what the robot accepted against what the person meant, task by task."""
    tasks = [item for item in feedback if item.kind == "task"]
    meant = [None if item.helpful is None else item.helpful != item.slip for item in tasks]
    return count([item.accepted for item in tasks], meant).model_copy(update={"verdicts": meant})


MEASURE = MeasureSpec(
    name="people",
    about="F1 over the robot's candidates; the person says in the evening which of them helped",
    title="people F1",
    figures=Counts,
    measure=None,
    answers=by_person,
    pool=lambda hours: pool(hours).model_dump(),
    headline="f1",
    short="people",
    order=3,
)
