"""When people do what: who works when, who sleeps late, and how much of each hour an activity takes, in all.

Reads rhythm.yaml, which `python -m benchmarks.fit_time_use` fits to a time-use table. Nothing here is about one person.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
import yaml
from pydantic import Field

from coopera.core.lazy import made_once
from coopera.core.people import Frozen
from coopera.core.time_use import CATEGORIES, DAY_TYPES, Category, DayType, day_type
from coopera.models.offline.household.knowledge import FIRST, LAST, Floats, Household

_FILE = Path(__file__).parent / "rhythm.yaml"
_HOURS = LAST - FIRST + 1
WEEKEND = DAY_TYPES.index("weekend")

Share = Annotated[float, Field(ge=0, le=1)]
ByHour = Annotated[tuple[Share, ...], Field(min_length=_HOURS, max_length=_HOURS)]
Logits = Annotated[tuple[float, ...], Field(min_length=_HOURS, max_length=_HOURS)]


class Schedule(Frozen):
    """Hours of work of a `share` of the people: on days of the week (Monday is 0), from `start` until before `end`."""

    days: tuple[Annotated[int, Field(ge=0, le=6)], ...]
    start: Annotated[int, Field(ge=0, le=24)]
    end: Annotated[int, Field(ge=0, le=24)]
    share: Share = 1.0

    def covers(self, weekday: int, hour: int) -> bool:
        """Whether an hour is one of work."""
        return weekday in self.days and self.start <= hour < self.end


class Rhythm(Frozen):
    """The rhythm of a population; hours are those from `FIRST` to `LAST`.

    Attributes:
        source: Where the figures come from.
        command: What made them.
        asleep: Share still asleep in the morning, by day type and hour.
        schedules: Hours of work of those who are employed.
        logits: How strongly each category draws those who are free, by day type, category and hour; "other" is 0.
    """

    source: str
    command: str
    asleep: dict[DayType, ByHour]
    schedules: tuple[Schedule, ...]
    logits: dict[DayType, dict[Category, Logits]]

    @cached_property
    def morning_sleep(self) -> Floats:
        """Share still asleep; shape (day types, 24), 0 where the file says nothing."""
        asleep = np.zeros((len(DAY_TYPES), 24))
        for d, kind in enumerate(DAY_TYPES):
            asleep[d, FIRST : LAST + 1] = self.asleep[kind]
        return asleep

    @cached_property
    def category_logits(self) -> Floats:
        """Logits of each category; shape (day types, categories, 24), hours outside as their nearest covered one."""
        table = np.zeros((len(DAY_TYPES), len(CATEGORIES), _HOURS))
        for d, kind in enumerate(DAY_TYPES):
            for name, row in self.logits[kind].items():
                table[d, CATEGORIES.index(name)] = row
        return table[:, :, np.clip(np.arange(24), FIRST, LAST) - FIRST]

    def hours_of(self, household: Household) -> Floats:
        """Logits of each activity by hour on a free day, for the average person; shape (day types, activities, 24).

        The file's logits say how much a category takes of an hour, the activities' own hours how it is shared there.
        """
        weights = np.exp(household.log_hours)
        shared = np.zeros_like(weights)
        for category in {activity.category for activity in household.activities}:
            rows = [i for i, one in enumerate(household.activities) if one.category == category]
            competing = [i for i in rows if not household.activities[i].daily] or rows
            shared[rows] = weights[rows] / weights[competing].sum(axis=0)
        which = [CATEGORIES.index(activity.category) for activity in household.activities]
        return np.asarray(self.category_logits[:, which] + np.log(shared), dtype=np.float64)


@made_once()
def shipped_rhythm() -> Rhythm:
    """Return the rhythm that comes with the package."""
    return Rhythm.model_validate(yaml.safe_load(_FILE.read_text(encoding="utf-8")))


def due_by_hour(weights: Floats, daily: float) -> Floats:
    """Chance that something daily is done in an hour if it was not done before, by hour of day; shape (24,).

    Followed hour by hour from `FIRST` to `LAST`, it is done on the share `daily` of days, at hours as `weights` say.
    """
    hours = np.arange(24)
    wanted = np.where((hours >= FIRST) & (hours <= LAST), np.maximum(weights, 0.0), 0.0)
    wanted = daily * wanted / max(float(wanted.sum()), 1e-12)
    left = 1.0 - np.concatenate([[0.0], np.cumsum(wanted)[:-1]])
    return np.asarray(np.clip(wanted / np.maximum(left, 1e-9), 0.0, 1.0), dtype=np.float64)


def of_day_type(weekday: int) -> int:
    """Place in `DAY_TYPES` of a day of the week, Monday being 0."""
    return DAY_TYPES.index(day_type(weekday))
