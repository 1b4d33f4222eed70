"""When a person does what: hours of work, needs of the day, habitual hours, sleep. Person's side only.

Drawn from the rhythm of a population (rhythm.py), and bound by what the person states.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from coopera.core.people import BigFive
from coopera.models.offline.household.knowledge import FIRST, LAST, Floats, Household
from coopera.models.offline.human.facts import Facts
from coopera.models.offline.human.rhythm import WEEKEND, Rhythm, Schedule, due_by_hour, of_day_type

HABIT = 1.6  # logits that the habitual hour of an activity gains
NEVER = -60.0  # logits of what is not done at an hour
NAPPING = 13  # who sleeps at this hour has not slept late, but naps
LATE = 0.7  # what a standard deviation of lateness adds to the log of the chance to sleep late
OF_AGE = 18  # years up to which somebody of whom nothing else is stated goes to school
OCCUPATIONS: Mapping[tuple[str, str, bool], str] = {
    ("employed", "home", False): "desk_work",
    ("employed", "home", True): "desk_work",
    ("employed", "outside", True): "work_out_of_home",
    ("student", "outside", True): "school",
    ("student", "home", False): "study",
    ("student", "home", True): "study",
}
"""What the hours of work are for, by employment, workplace and whether people may be away; else they are free."""
AGREES: Mapping[str, Callable[[Schedule], bool]] = {
    "mornings": lambda one: one.start <= 9 and one.end <= 16,
    "evenings": lambda one: one.end >= 20,
    "nights": lambda one: one.end >= 22,
    "weekdays": lambda one: max(one.days) < 5,
    "weekends": lambda one: max(one.days) >= 5,
}
"""Which hours of work agree with what people state. DEVIATES: nights are the late shift; no day here begins so late."""
_SET_HOURS = ("sleep_in", "desk_work", "work_out_of_home", "school")

Draw = Callable[..., np.random.Generator]
"""Gives the person's generator for a purpose."""


class OwnTime:
    """The hours of one person. Arrays are in the household file's order of activities."""

    def __init__(self, household: Household, big_five: BigFive, facts: Facts, rng: Draw, rhythm: Rhythm) -> None:
        self.household = household
        self._big_five, self._facts, self._rng, self._rhythm = big_five, facts, rng, rhythm
        self._own_hours = self._drawn_hours()
        self._ever = self._hours_at_all()
        self._usual = self._usual_hours()
        self.schedule: Schedule | None = self._drawn_schedule()
        """The hours of work or lessons, for those who have such."""
        self.daily: tuple[int, ...] = self._own_needs()
        """Places of what belongs to each day: meals, and this person's way to wash."""
        self._due = {index: self._due_by_hour(index) for index in self.daily}
        self.set_hours = self._has_set_hours()
        """What is done at its own hours, and not because somebody feels like it; shape (activities,)."""
        self._late = self._lateness()

    def usual(self, weekday: int, hour: int) -> Floats:
        """Logits of how usual each activity is in a free hour, for this person; shape (activities,).

        Who has no work has weekends all week.
        """
        kind = WEEKEND if self._employment in ("retired", "not_working") else of_day_type(weekday)
        return self._usual[kind, :, hour]

    def due(self, index: int, hour: int) -> float:
        """Chance that a need is met in an hour if it was not before."""
        return float(self._due[index][hour])

    def serves(self, index: int) -> tuple[int, ...]:
        """Places of what meets the same need."""
        same = {self.household.activities[index].id, *self.household.activities[index].instead}
        return tuple(
            i for i, one in enumerate(self.household.activities) if one.id in same or same & {one.id, *one.instead}
        )

    def occupation(self, *, absence: bool) -> int | None:
        """Place of what fills the hours of work: at home, or away where people may be."""
        if self.schedule is None:
            return None
        return self.household.index.get(OCCUPATIONS.get((self._employment, self._workplace, absence), ""))

    def asleep(self, weekday: int, hour: int, *, already: bool) -> float:
        """Chance to be asleep in an hour of the morning, given that one was until then."""
        share = self._rhythm.morning_sleep[of_day_type(weekday)]
        share = np.maximum(share - share[NAPPING], 0.0)
        if not already:
            return float(np.clip(share[hour] * self._late, 0.0, 0.97)) if hour == FIRST else 0.0
        return float(np.clip(share[hour] / max(share[hour - 1], 1e-9) * self._late**0.5, 0.0, 0.97))

    def _usual_hours(self) -> Floats:
        """Logits by day type, activity and hour; `NEVER` where the file, by the person's clock, has no weight."""
        usual = self._rhythm.hours_of(self.household) + (self._own_hours - self.household.log_hours)
        return np.where(self._ever, usual, NEVER)

    def _hours_at_all(self) -> NDArray[np.bool_]:
        """Whether the file, by the person's clock, has any weight; shape (activities, 24)."""
        clock = np.clip(np.arange(24) - round(self._facts.hours_shift), FIRST, LAST) - FIRST
        return np.array([activity.hours for activity in self.household.activities])[:, clock] > 0

    def _drawn_hours(self) -> Floats:
        """Common hours, moved to an earlier or later type, sharpened by orderliness, with a habitual hour each.

        Conscientious people are earlier types (Tsaousis 2010, a meta-analysis) and keep to a schedule.
        """
        household, order = self.household, self._big_five.conscientiousness - 3.0
        rng = self._rng("hours")
        shift = float(rng.normal(-0.35 * order, 0.6)) + self._facts.hours_shift
        hours = np.arange(24, dtype=np.float64)
        curves = np.stack([np.interp(hours - shift, hours, row) for row in household.log_hours])
        usual = np.exp(curves[:, FIRST : LAST + 1])
        usual /= usual.sum(axis=1, keepdims=True)
        habitual = np.array([FIRST + rng.choice(LAST - FIRST + 1, p=row) for row in usual])
        width = float(np.clip(1.1 - 0.2 * order + rng.normal(0.0, 0.15), 0.6, 1.8))
        bump = np.exp(-0.5 * ((hours[None, :] - habitual[:, None]) / width) ** 2)
        return np.asarray(curves + (HABIT + 0.25 * order) * bump, dtype=np.float64)

    @property
    def _employment(self) -> str:
        """What is stated; else by age, and of most people that they are employed."""
        if self._facts.employment:
            return self._facts.employment
        if self._facts.age is not None and self._facts.age < OF_AGE:
            return "student"
        return "retired" if self._facts.life_stage == "older" else "employed"

    @property
    def _workplace(self) -> str:
        """What is stated; else students learn outside, and the others work at home, where the study is."""
        return self._facts.workplace or ("outside" if self._employment == "student" else "home")

    def _drawn_schedule(self) -> Schedule | None:
        """Draw the hours of work or lessons from those of the population that agree with what is stated."""
        if self._employment not in ("employed", "student"):
            return None
        schedules, drawn = self._rhythm.schedules, float(self._rng("schedule").random())
        if stated := self._facts.work_time:
            schedules = tuple(one for one in schedules if AGREES[stated](one))
            drawn *= sum(one.share for one in schedules)
        place = int(np.searchsorted(np.cumsum([one.share for one in schedules]), drawn))
        return schedules[place] if place < len(schedules) else None

    def _own_needs(self) -> tuple[int, ...]:
        """What this person does daily; where something else serves as well, one of them is their habit."""
        own = []
        for activity in self.household.activities:
            if activity.daily:
                ways = [activity.id, *activity.instead]
                own.append(self.household.index[ways[int(self._rng("way", activity.id).integers(len(ways)))]])
        return tuple(own)

    def _due_by_hour(self, index: int) -> Floats:
        daily = max(self.household.activities[i].daily for i in self.serves(index))
        return due_by_hour(np.where(self._ever[index], np.exp(self._own_hours[index]) - 0.005, 0.0), daily)

    def _has_set_hours(self) -> NDArray[np.bool_]:
        own = [self.household.index[name] for name in _SET_HOURS if name in self.household.index]
        mask = np.zeros(len(self.household.activities), dtype=bool)
        mask[[*own, *self.daily]] = True
        return mask

    def _lateness(self) -> float:
        """How much likelier than others this person sleeps late; conscientious people rise earlier (Tsaousis 2010)."""
        z = float(self._rng("lateness").normal()) - 0.5 * (self._big_five.conscientiousness - 3.0)
        z += self._facts.hours_shift
        return float(np.exp(LATE * z - LATE**2 / 2))
