"""From lived days to minutes: what each clock hour of a simulated day was spent on, in the categories of time use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

import numpy as np

from coopera.core.people import PersonId
from coopera.core.time_use import CATEGORIES, Category, DayType, day_type
from coopera.evaluation.people.figures import Figure, unmeasured
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.lives import LivedDay, Lives
from coopera.models.offline.household.sense import CommonSense, Recognised

Uses: TypeAlias = Callable[[str], Mapping[Category, int]]
"""An intention's text -> the minutes of its hour by category; at most 60 in all, and at least one."""
_HOUR = 60


class ActivityUses:
    """What an intention's hour counts as, by the household's activity that it speaks of. Implements `Uses`.

    A known wording is its activity's; any other text is of the activity that is nearest in meaning, however far.
    """

    def __init__(self, sense: CommonSense) -> None:
        """Use a household and its encoder of texts."""
        self._sense = sense
        self._known: dict[str, Recognised] = {}

    def __call__(self, intention: str) -> Mapping[Category, int]:
        """Minutes of the hour by category."""
        return self._recognised(intention).activity.minutes

    def activity(self, intention: str) -> str:
        """The id of the activity that the text speaks of."""
        return self._recognised(intention).activity.id

    def known(self, intention: str) -> bool:
        """Whether the text is a known wording, rather than recognised by meaning."""
        return self._recognised(intention).certainty == 1.0

    def _recognised(self, intention: str) -> Recognised:
        if intention not in self._known:
            self._known[intention] = self._sense.recognise(intention)
        return self._known[intention]


class SpentDay(NamedTuple):
    """One lived day: shares of each clock hour by category, shape (24, 9); hours not lived are nan."""

    person: PersonId
    seed: int
    number: int
    shares: Floats

    @property
    def day_type(self) -> DayType:
        """Whether it is a day of the working week."""
        return day_type(self.number)


def spent(day: LivedDay, uses: Uses) -> SpentDay:
    """What a day's hours were spent on.

    Minutes that an hour's intention leaves over (a lunch takes 35 of 60) go to what takes whole hours before and after
    it: half to each if there is something on both sides, in the proportions of its own minutes. Other short intentions
    in between, such as the dishes after lunch, are passed over. If there is nothing on either side, they are "other".
    """
    taken = dict(zip(day.hours, map(uses, day.intentions), strict=True))
    return SpentDay(day.person, day.seed, day.number, filled(taken))


def filled(uses: Mapping[int, Mapping[Category, int]]) -> Floats:
    """Shares of each clock hour by category, shape (24, 9), from what each hour's intention takes; else nan."""
    minutes = {hour: _row(row) for hour, row in uses.items()}
    shares = np.full((24, len(CATEGORIES)), np.nan)
    for hour, row in minutes.items():
        sides = [side for step in (-1, 1) if (side := _whole_hour(minutes, hour, step)) is not None]
        left = (_HOUR - row.sum()) * (np.mean(sides, axis=0) / _HOUR if sides else _row({"other": 1}))
        shares[hour] = (row + left) / _HOUR
    return shares


def _whole_hour(minutes: Mapping[int, Floats], hour: int, step: int) -> Floats | None:
    """The nearest intention on one side that takes whole hours."""
    at = hour + step
    while at in minutes and minutes[at].sum() < _HOUR:
        at += step
    return minutes.get(at)


def recognised(lives: Lives, uses: ActivityUses) -> Figure:
    """The share of hours whose intention is a known wording; the others' activity is a guess by meaning."""
    texts = [text for day in lives.days for text in day.intentions]
    if not texts:
        return unmeasured("time use", "hours of a known wording", why="no hour was lived")[0]
    return Figure(
        check="time use",
        measure="hours of a known wording",
        value=sum(map(uses.known, texts)) / len(texts),
        n=len(texts),
        unit="hours",
        note="the others are counted as the activity nearest in meaning",
    )


def _row(minutes: Mapping[Category, int]) -> Floats:
    row = np.array([minutes.get(category, 0) for category in CATEGORIES], dtype=np.float64)
    if not 0 < row.sum() <= _HOUR:
        raise ValueError(f"an hour has 1 to {_HOUR} minutes, not {row.sum():g}")
    return row
