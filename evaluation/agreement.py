"""How far automatic success is from the person's own answers in the evening (PAPER §4.4)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from coopera.core.hour import FeedbackItem
from coopera.core.success import Counts
from coopera.evaluation.counts import count


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
