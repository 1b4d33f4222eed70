"""What becomes different in a life: moods for a day, slow drift, and what changes from one day to the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from coopera.core.people import ChangeKind, Circumstance, Frozen, PersonId

Logits = Annotated[float, Field(ge=-10, le=10)]
DayNumber = Annotated[int, Field(strict=True, ge=0, le=100_000)]


class Work(Frozen):
    """Hours of work from a change on: where, on which days (Monday is 0), from `start` until before `end`."""

    at: Literal["home", "outside", "nowhere"]
    days: tuple[Annotated[int, Field(ge=0, le=6)], ...] = (0, 1, 2, 3, 4)
    start: Annotated[int, Field(ge=0, le=24)] = 9
    end: Annotated[int, Field(ge=0, le=24)] = 17

    @model_validator(mode="after")
    def _some_hours(self) -> Self:
        if self.end <= self.start:
            raise ValueError(f"the end, {self.end}, must come after the start, {self.start}")
        return self


class Change(Frozen):
    """One thing that becomes different; days are the person's own, from 0.

    Attributes:
        kind: What it is.
        text: How the person would put it.
        day: The first day on which it shows.
        until: The first day on which it is over; None stays.
        ramp: Days until it is at full strength; 0 is at once.
        more: Logits that activities gain at full strength, by the household's id; below 0 they lose.
        never: Activities that are not done from the first day on.
        work: What becomes of the hours of work; None leaves them as they are.
        person: Whom it befalls; None is everybody.
    """

    kind: ChangeKind = "other"
    text: Annotated[str, Field(min_length=1, max_length=200)]
    day: DayNumber
    until: DayNumber | None = None
    ramp: Annotated[int, Field(strict=True, ge=0, le=10_000)] = 0
    more: dict[str, Logits] = {}
    never: tuple[str, ...] = ()
    work: Work | None = None
    person: PersonId | None = None

    def strength(self, day: int) -> float:
        """How far it has come on a day: 0 before and after it, else up to 1."""
        if day < self.day or (self.until is not None and day >= self.until):
            return 0.0
        return min(1.0, (day - self.day + 1) / self.ramp) if self.ramp else 1.0


Changes: TypeAlias = Callable[[PersonId, int], Sequence[Change]]
"""What is different for a person on a day of theirs."""


def no_changes(person: PersonId, day: int) -> Sequence[Change]:
    """The paper's life: nothing ever becomes different."""
    return ()


def felt(changes: Sequence[Change], day: int) -> list[Circumstance]:
    """The changes as the trace tells them."""
    return [Circumstance(kind=one.kind, text=one.text, strength=round(one.strength(day), 4)) for one in changes]


def as_variables(changes: Sequence[Change], day: int) -> list[dict[str, Any]]:
    """The changes as prompts read them."""
    return [
        {
            "kind": one.kind,
            "text": one.text,
            "strength": round(one.strength(day), 4),
            "more": dict(one.more),
            "never": list(one.never),
            "work": one.work.model_dump(mode="json") if one.work else None,
        }
        for one in changes
    ]
