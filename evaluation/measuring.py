"""Measures of an hour, as values: what each makes of an hour, how hours add up, and under which names it is shown.

A measure that ships is one file in `evaluation/measures/`, named as the measure is. It names a `MeasureSpec` MEASURE.
Its figures then stand in each hour's trace, in metrics.csv, in the days of summary.json and in the report.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeAlias, TypeVar

from pydantic import ValidationError

from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import Evening, FeedbackItem, HourRecord, Intention, Task, TaskCandidate
from coopera.core.household import Act, Outcome
from coopera.core.people import Frozen
from coopera.core.protocols import Ask, Home, Role
from coopera.core.randomness import Address
from coopera.core.registry import Registry
from coopera.core.success import Counts, Success
from coopera.evaluation.counts import count, pool

F = TypeVar("F", bound=Frozen)
Pooled: TypeAlias = Mapping[str, float | int | None]

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_HOUR = {"day", "episode", "episode_day", "hour", "person", "scene", "measure", "status"}
_TAKEN = _HOUR | {"hours", "failed_hours", "need"}


@dataclass(frozen=True, slots=True)
class MeasuredHour:
    """What a measure sees of an hour.

    Attributes:
        home: The home as the hour left it; for a measure that is taken in the evening, as the day left it.
        at: The hour's address, for draws and for `ask`.
        intention: The person's true one.
        remaining: The person's tasks after the first, which the robot has watched.
        candidates: The robot's superset, with `accepted`, and `correct` by the predicate.
        outcomes: What came of the robot's acts, in the order in which they were done.
        ask: The one door to language models, for a measure that asks one.
        helps: The predicate: whether an act of the robot helps with an act of the person.
        alike: Cosine of two sentences by the run's embeddings.
    """

    home: Home
    at: Address
    intention: Intention
    remaining: Sequence[Task]
    candidates: Sequence[TaskCandidate]
    outcomes: Sequence[Outcome]
    ask: Ask
    helps: Callable[[Act, Act], bool]
    alike: Callable[[str, str], float]


@dataclass(frozen=True, slots=True)
class MeasureSpec(Generic[F]):
    """A measure of success.

    Attributes:
        name: Its key in the trace and in summary.json, and in metrics.csv the value of the column `measure`.
        about: What it says, in a line.
        title: The heading of its one figure in tables, such as "predicate F1".
        figures: The figures of an hour: a frozen model of numbers. They are columns of metrics.csv.
        measure: Measures an hour as soon as it is lived; None for a measure that is taken from the answers.
        pool: Adds up hours for summary.json. There may be none: all of a day's may have failed.
        headline: Which of the pooled figures is the one that tables show.
        beside: Other pooled figures that the table at a run's end has room for.
        short: The heading in that table, where `title` is long.
        row: The measure in whose rows of metrics.csv the figures stand; None gives them rows of their own.
        order: Lower ones stand first; equal ones by name.
        asks: The role whose language model it asks. Unless that model answers at once, the measure is taken in the
            evening, for all hours together, so that nobody waits for it.
        answers: Measures an hour by what the person answered about it in the evening (`told_in_the_evening`).
        at_end: Whether it stands in the table at a run's end, which has to fit 80 columns.
    """

    name: str
    about: str
    title: str
    figures: type[F]
    measure: Callable[[MeasuredHour], F] | None
    pool: Callable[[Sequence[F]], Pooled]
    headline: str
    beside: tuple[str, ...] = ()
    short: str = ""
    row: str | None = None
    order: int = 100
    asks: Role | None = None
    answers: Callable[[Sequence[FeedbackItem]], F] | None = None
    at_end: bool = True

    def __post_init__(self) -> None:
        """Refuse names that stand for something else in the files, and a measure that is never taken.

        Raises:
            ConfigError: Naming what is wrong.
        """
        for name in (self.name, *self.figures.model_fields):
            if not _NAME.fullmatch(name) or name in _TAKEN:
                raise ConfigError(
                    f"measure: {self.name}: {name!r} cannot be the name of a measure or of a figure; it must be a "
                    f"lower-case word such as path_length, and none of {', '.join(sorted(_TAKEN))}."
                )
        if (self.measure is None) == (self.answers is None):
            raise ConfigError(f"measure: {self.name}: one of `measure` and `answers` must be given, and one alone.")

    def read(self, success: Success) -> F | None:
        """Return an hour's figures; None in traces of before there was this measure.

        Raises:
            RunError: If the figures are not this measure's.
        """
        found = success.of(self.name)
        if found is None or isinstance(found, self.figures):
            return found
        try:
            return self.figures.model_validate(found)
        except ValidationError:
            wanted = ", ".join(self.figures.model_fields)
            raise RunError(f"success.{self.name}: the trace has {found!r}, and the measure has {wanted}.") from None


def by_counts(
    name: str,
    about: str,
    truth: Callable[[MeasuredHour], Sequence[bool | None]],
    *,
    beside: tuple[str, ...] = (),
    short: str = "",
    order: int = 100,
    at_end: bool = True,
) -> MeasureSpec[Counts]:
    """Return a measure of F1 over the superset: what was accepted is the prediction, and `truth` says what was right.

    Args:
        name: The measure's name.
        about: What it says, in a line.
        truth: Whether each candidate was right; None leaves it unscored.
        beside: As in `MeasureSpec`, as are `short` and `order`.
        short: Its heading where there is little room.
        order: Its place.
        at_end: Whether it stands in the table at a run's end.
    """

    def measure(hour: MeasuredHour) -> Counts:
        verdicts = list(truth(hour))
        counted = count([bool(one.accepted) for one in hour.candidates], verdicts)
        return counted.model_copy(update={"verdicts": verdicts})

    return MeasureSpec(
        name=name,
        about=about,
        title=f"{name} F1",
        figures=Counts,
        measure=measure,
        pool=lambda hours: pool(hours).model_dump(),
        headline="f1",
        beside=beside,
        short=short,
        order=order,
        at_end=at_end,
    )


def sums(figures: type[F]) -> Callable[[Sequence[F]], dict[str, float | int]]:
    """Return what adds up each figure over hours, to six decimals; hours without a value are left out."""
    return lambda hours: {name: round(sum(_values(hours, name)), 6) for name in figures.model_fields}


def means(figures: type[F]) -> Callable[[Sequence[F]], dict[str, float | int | None]]:
    """Return what takes each figure's mean over the hours that have a value, to six decimals; None where none has."""

    def mean(hours: Sequence[F], name: str) -> float | None:
        values = _values(hours, name)
        return round(sum(values) / len(values), 6) if values else None

    return lambda hours: {name: mean(hours, name) for name in figures.model_fields}


def _values(hours: Sequence[Frozen], name: str) -> list[float]:
    return [value for one in hours if (value := getattr(one, name)) is not None]


_MEASURES: Registry[MeasureSpec[Any]] = Registry("measure", MeasureSpec, package="coopera.evaluation.measures")


def known_measures() -> list[str]:
    """Names of all measures."""
    return _MEASURES.known()


def find_measure(name: str) -> MeasureSpec[Any]:
    """Return a measure by its name.

    Raises:
        ConfigError: If there is none, or another package offers it and it cannot be loaded.
    """
    return _MEASURES.find(name)


def register_measure(spec: MeasureSpec[Any]) -> MeasureSpec[Any]:
    """Have this process measure one thing more; packages use an entry point in the group `coopera.measures`.

    Raises:
        ConfigError: If another measure has its name already.
    """
    return _MEASURES.register(spec)


def all_measures() -> list[MeasureSpec[Any]]:
    """Return every measure in its order: each hour is measured by all of them.

    Raises:
        ConfigError: If another package offers one that cannot be loaded.
    """
    return sorted(map(find_measure, known_measures()), key=lambda spec: (spec.order, spec.name))


def told_in_the_evening(hours: Iterable[HourRecord], evenings: Iterable[Evening]) -> list[HourRecord]:
    """Return the hours with the measures that are taken from the evening's answers beside the others.

    They are in no trace of an hour, since the person answers after it. Hours without a success, and those of a day
    that has not ended, come back as they are.
    """
    told = {evening.day: evening.feedback for evening in evenings}
    specs = [spec for spec in all_measures() if spec.answers is not None]
    return [_told(hour, told[hour.day], specs) if hour.day in told else hour for hour in hours]


def _told(hour: HourRecord, feedback: Sequence[FeedbackItem], specs: Sequence[MeasureSpec[Any]]) -> HourRecord:
    if hour.success is None:
        return hour
    said = [item for item in feedback if item.hour == hour.hour]
    figures = {spec.name: spec.answers(said).model_dump() for spec in specs if spec.answers is not None}
    return hour.model_copy(update={"success": Success.model_validate({**hour.success.model_dump(), **figures})})
