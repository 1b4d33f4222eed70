"""How reliably a person answers in the evening: not always, and not always what they meant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coopera.core.hour import FeedbackItem

UNANSWERED = "The person did not answer this."
BEST, WORST = 5, 1


@dataclass(frozen=True, slots=True)
class Answering:
    """A way of answering; as it stands here, the paper's.

    Attributes:
        rate: Chance that a question is answered, 0 to 1.
        noise: Chance that an answer is the opposite of what the person meant, 0 to 0.5. Above 0, no reasons are given:
            they would tell which answers are slips.
    """

    rate: float = 1.0
    noise: float = 0.0

    def given(self, meant: Sequence[FeedbackItem], rng: np.random.Generator) -> list[FeedbackItem]:
        """What the person says, given what they mean; one draw of each kind per question, whatever is asked."""
        draws = rng.random((len(meant), 2))
        return [self._said(item, *map(float, draw)) for item, draw in zip(meant, draws, strict=True)]

    def _said(self, item: FeedbackItem, answers: float, slips: float) -> FeedbackItem:
        if item.helpful is None:
            return item
        if answers >= self.rate:
            return item.model_copy(update={"helpful": None, "reason": UNANSWERED, "grade": None})
        if slips >= self.noise:
            return item.model_copy(update={"reason": ""}) if self.noise else item
        grade = None if item.grade is None else BEST + WORST - item.grade
        return item.model_copy(update={"helpful": not item.helpful, "grade": grade, "reason": "", "slip": True})
