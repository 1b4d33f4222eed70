"""Success of the robot's help: an hour measured by every measure there is (PAPER §4.3).

A candidate is *correct* if it helps with one of the person's remaining tasks (those after the first, which the
robot has watched). The classifier's verdict is the prediction: accepted and correct is a true positive.

Worked example: six candidates, four accepted, three of these correct, one correct one rejected:
tp 3, fp 1, fn 1, tn 1; precision 3/4, recall 3/4, F1 = 6/8 = 0.75.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from langchain_core.embeddings import Embeddings

from coopera.core.hour import Intention, Task, TaskCandidate
from coopera.core.household import Outcome
from coopera.core.protocols import Ask, Home
from coopera.core.randomness import Address
from coopera.core.success import Success
from coopera.evaluation.measuring import MeasuredHour, MeasureSpec, all_measures
from coopera.evaluation.predicate import Predicate


class Measure:
    """Scores an hour by every measure; implements `coopera.graphs.services.Score`."""

    def __init__(self, ask: Ask, embeddings: Embeddings, measures: Sequence[MeasureSpec[Any]] | None = None) -> None:
        """Prepare to measure, by default by all measures that there are.

        Raises:
            ConfigError: If another package offers a measure that cannot be loaded.
        """
        self._ask, self._predicate = ask, Predicate(embeddings)
        self._measures = all_measures() if measures is None else list(measures)

    def __call__(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        candidates: Sequence[TaskCandidate],
        outcomes: Sequence[Outcome] = (),
    ) -> tuple[list[TaskCandidate], Success]:
        """Set `correct` (by the predicate) on the candidates, and take every measure that needs no evening."""
        scored = [
            one.model_copy(update={"correct": self._predicate.matches(home, one, remaining)}) for one in candidates
        ]
        helps = partial(self._predicate.helps, home)
        alike = self._predicate.alike
        hour = MeasuredHour(home, at, intention, remaining, scored, outcomes, self._ask, helps, alike)
        figures = {spec.name: spec.measure(hour).model_dump() for spec in self._measures if spec.measure}
        return scored, Success.model_validate(figures)
