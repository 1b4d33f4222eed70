"""Feedback of a first evening that was short, or of one kind, and what every classifier owes it."""

from __future__ import annotations

import math
from collections.abc import Callable

from coopera.core.hour import Example
from coopera.core.people import PersonId
from coopera.core.protocols import Classifier
from tests.models.classifiers.feedback import THINGS

Make = Callable[[], Classifier]


def lived(hours: int, likes: Callable[[str, int], bool | None], **fields: object) -> list[Example]:
    """Answers to all five things in each of some hours of one day."""
    return [
        Example(
            person=PersonId("ann"),
            day=0,
            hour=9 + number,
            candidate=thing,
            label=likes(thing, number),
            **{name: value[place] if isinstance(value, list) else value for name, value in fields.items()},
        )
        for number in range(hours)
        for place, thing in enumerate(THINGS)
    ]


def tea(thing: str, _: int = 0) -> bool:
    return thing == "drink tea"


BOTH = {
    "one hour": lived(1, tea),
    "two hours": lived(2, tea),
    "three hours": lived(3, tea),
    "mostly yes": lived(1, lambda thing, _: thing != "drink tea"),
    "mostly yes, two hours": lived(2, lambda thing, _: thing != "drink tea"),
    "one yes, in the second hour": lived(2, lambda thing, hour: tea(thing) and hour == 1),
    "one yes and one no": [one for one in lived(1, tea) if one.candidate in THINGS[:2]],
    "each answer twice": [one for one in lived(1, tea) for _ in range(2)],
    "most unanswered": lived(2, lambda thing, hour: tea(thing) if hour == 0 else None),
}
ONE_SIDED = {
    "only yes": lived(1, lambda *_: True),
    "only no": lived(2, lambda *_: False),
    "a single yes": lived(1, tea)[:1],
    "a single no": lived(1, tea)[1:2],
    "nothing": [],
}


def chances(make: Make, taught: list[Example]) -> list[float]:
    """What a classifier taught these says of them on the next day; always numbers between 0 and 1."""
    judge = make()
    judge.train(taught, seed=0)
    asked = [one.model_copy(update={"label": None, "day": one.day + 1}) for one in taught or lived(1, tea)]
    said = judge.probabilities(asked)
    assert all(math.isfinite(p) and 0 <= p <= 1 for p in said)
    return said


def never_constant(make: Make, case: str) -> None:
    """Whatever has both answers gets both, and what cannot be told apart stays undecided."""
    assert {p >= 0.5 for p in chances(make, BOTH[case])} == {True, False}


def undecided_without_a_difference(make: Make) -> None:
    """One label alone, or the same candidate with either answer, decides nothing."""
    for case, taught in ONE_SIDED.items():
        assert set(chances(make, taught)) == {0.5}, case
    same = lived(1, tea)[:1] * 4
    mixed = [one.model_copy(update={"label": number == 0}) for number, one in enumerate(same)]
    assert set(chances(make, mixed)) == {0.5}
