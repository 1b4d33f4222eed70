"""Success of the robot's help: an hour measured by every measure there is (PAPER §4.3).

A candidate is *correct* if it helps with one of the person's remaining tasks (those after the first, which the
robot has watched). The classifier's verdict is the prediction: accepted and correct is a true positive.

Worked example: six candidates, four accepted, three of these correct, one correct one rejected:
tp 3, fp 1, fn 1, tn 1; precision 3/4, recall 3/4, F1 = 6/8 = 0.75.

A measure that asks a language model, as the judge's does, holds nothing up: unless that model answers at once, it is
taken in the evening, for all hours together.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any

from langchain_core.embeddings import Embeddings

from coopera.core.hour import HourRecord, Intention, Task, TaskCandidate
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
        known = all_measures() if measures is None else measures
        self._of_hours = [spec for spec in known if spec.measure]

    def __call__(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        candidates: Sequence[TaskCandidate],
        outcomes: Sequence[Outcome] = (),
    ) -> tuple[list[TaskCandidate], Success]:
        """Set `correct` (by the predicate) on the candidates, and take every measure that nobody need wait for."""
        scored = [
            one.model_copy(update={"correct": self._predicate.matches(home, one, remaining)}) for one in candidates
        ]
        now = [spec for spec in self._of_hours if spec.asks is None or self._ask.instant(spec.asks)]
        hour = self._measured(home, at, intention, remaining, scored, outcomes)
        return scored, Success.model_validate(_figures(now, hour))

    def misses(self, success: Success) -> bool:
        """Whether measures of an hour are still to be taken."""
        return any(success.of(spec.name) is None for spec in self._of_hours)

    def complete(self, home: Home, at: Address, hour: HourRecord) -> Success:
        """Take the measures that an hour still misses, once its day is over; those that it has stay as they are."""
        assert hour.success, "an hour is measured first"
        assert hour.human, "by what the person did"
        assert hour.robot, "and the robot"
        late = [spec for spec in self._of_hours if hour.success.of(spec.name) is None]
        human, robot = hour.human, hour.robot
        measured = self._measured(home, at, human.intention, human.tasks[1:], robot.tasks, robot.outcomes)
        return Success.model_validate({**hour.success.model_dump(), **_figures(late, measured)})

    def _measured(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        scored: Sequence[TaskCandidate],
        outcomes: Sequence[Outcome],
    ) -> MeasuredHour:
        helps, alike = partial(self._predicate.helps, home), self._predicate.alike
        return MeasuredHour(home, at, intention, remaining, scored, outcomes, self._ask, helps, alike)


def _figures(measures: Iterable[MeasureSpec[Any]], hour: MeasuredHour) -> dict[str, Any]:
    return {spec.name: spec.measure(hour).model_dump() for spec in measures if spec.measure}
