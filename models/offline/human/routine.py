"""What a person does in an hour: what each day needs, what is due, what goes on, and else what they feel like.

No text is read here: a person's day is a list of activities, so that a life of many days takes milliseconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.models.offline.household.knowledge import Floats, Household
from coopera.models.offline.human.circumstances import Job
from coopera.models.offline.human.person import PrivateLife

USUAL_TEMPERATURE = 0.7  # PAPER App. A: proposing at 0.7; the logits are meant for it
NEXT = 0.9  # logits for an activity that tends to follow what was done last
LATER = 0.25  # the same for what was done before that
AGAIN_AFTER = 3  # hours until a repeatable activity may come again
AT_WORK = 0.97  # chance to go on working in an hour of work
TO_WORK = 0.94  # chance to begin on a day of work; else it is a day off
RESUMED = 0.8  # share of the chance to go on that is left after something short came between
ORDER = 0.12  # what a point of conscientiousness adds to the chance that a chore follows its cause at once
NEVER = -1e9

Why = Literal["need", "work", "going on", "chore", "asleep", "wish"]


class Done(NamedTuple):
    """An hour of today: the place of its activity in the household's order, and the hour of day."""

    activity: int
    hour: int


class Moment(NamedTuple):
    """An hour to be filled.

    Attributes:
        hour: Of the day, 0-23.
        weekday: Monday is 0.
        today: What was done today, in order.
        lasting: Whether something may go on for more than an hour; else nothing comes twice running.
        absence: Whether the person may be away from home.
        possible: What the home and the circumstances allow; shape (activities,).
        extra: Logits of today: moods, changes, dirty dishes; shape (activities,).
        job: A job that came with a change, in place of what the person has.
    """

    hour: int
    weekday: int
    today: Sequence[Done]
    lasting: bool
    absence: bool
    possible: NDArray[np.bool_]
    extra: Floats
    job: Job | None = None


class Choice(NamedTuple):
    """What is done: the place of the activity, whether it goes on with something begun before, and what led to it."""

    activity: int
    continues: bool
    why: Why


def choose(life: PrivateLife, moment: Moment, rng: np.random.Generator, temperature: float) -> Choice:
    """Choose what to do in an hour."""
    day = _Day(life, moment)
    return (
        day.still_asleep(rng)
        or day.work_away(rng)
        or day.what_is_needed(rng)
        or day.chore(rng)
        or day.work(rng)
        or day.going_on(rng)
        or Choice(day.wish(rng, temperature), continues=False, why="wish")
    )


def live_day(
    life: PrivateLife, moment: Moment, hours: Sequence[int], draws: Iterable[np.random.Generator]
) -> list[Choice]:
    """Choose hour after hour of a day, each after what was done before it.

    Args:
        life: Whose day it is.
        moment: What holds all day; its `hour` and `today` do not count.
        hours: Of the day, in order.
        draws: What each of the hours is drawn with.
    """
    today: list[Done] = []
    lived: list[Choice] = []
    for hour, rng in zip(hours, draws, strict=False):
        choice = choose(life, moment._replace(hour=hour, today=tuple(today)), rng, USUAL_TEMPERATURE)
        today.append(Done(choice.activity, hour))
        lived.append(choice)
    return lived


class _Day:
    """One person's day up to an hour."""

    def __init__(self, life: PrivateLife, moment: Moment) -> None:
        self._life, self._moment = life, moment
        self._household: Household = life.household
        self._done = {one.activity for one in moment.today}
        allowed = np.where(self._household.away, moment.absence, moment.possible) & life.can_do
        self._allowed = allowed if allowed.any() else np.ones_like(allowed)
        if moment.job and moment.job.occupation is not None:
            self._allowed[moment.job.occupation] = True  # whatever the profile says of work: that was before
        self._job = moment.job or Job(life.time.occupation(absence=moment.absence), life.time.schedule)
        self._fresh = self._allowed & self._not_done_lately()
        self._closing = [one.activity for one in moment.today if self._household.activities[one.activity].closes]
        # What ends the day, as far as it has been done: after it nothing begins that is not part of ending it.
        self._needs = {*life.time.daily, self._household.index.get("sleep_in", -1)}

    def still_asleep(self, rng: np.random.Generator) -> Choice | None:
        """Sleep late: as many as the rhythm has it, the late types among them."""
        index = self._household.index.get("sleep_in")
        if index is None or not self._allowed[index] or self._done - {index}:
            return None
        went_on = index in self._done
        if went_on and not self._moment.lasting:
            return None
        chance = self._life.time.asleep(self._moment.weekday, self._moment.hour, already=went_on)
        return Choice(index, went_on, "asleep") if rng.random() < chance else None

    def what_is_needed(self, rng: np.random.Generator) -> Choice | None:
        """Do what belongs to each day, at the hours that are this person's; of several, the most pressing."""
        if self._closing:
            return None
        due = {}
        for index in self._life.time.daily:
            if self._fresh[index] and not self._served(index) and self._life.time.due(index, self._moment.hour):
                missed = 1.0
                for hour in (self._moment.hour, *self._taken_up()):
                    missed *= 1.0 - self._life.time.due(index, hour)
                if rng.random() < 1.0 - missed:
                    due[index] = 1.0 - missed
        return Choice(max(due, key=lambda index: (due[index], -index)), False, "need") if due else None

    def chore(self, rng: np.random.Generator) -> Choice | None:
        """Do what the last thing leaves to be done, such as the dishes."""
        last = self._last
        if last is None:
            return None
        cause = self._household.activities[last].id
        more = ORDER * (self._life.big_five.conscientiousness - 3.0)
        for index, usual in self._household.chores[cause].items():
            if self._fresh[index] and rng.random() < min(max(usual + more, 0.0), 0.95):
                return Choice(index, continues=False, why="chore")
        return None

    def work_away(self, rng: np.random.Generator) -> Choice | None:
        """Work where nothing of home is done in between, not even a meal."""
        index = self._job.occupation
        return self.work(rng) if index is not None and self._household.activities[index].away else None

    def work(self, rng: np.random.Generator) -> Choice | None:
        """Work in the hours of work; a day that did not begin with it is a day off."""
        index, schedule = self._job
        if index is None or schedule is None or not self._allowed[index]:
            return None
        if not schedule.covers(self._moment.weekday, self._moment.hour):
            return None
        begun = index in self._done
        if self._closing or not (begun or self._may_begin(schedule.start)):
            return None
        if not self._moment.lasting and not self._fresh[index]:
            return None
        stays = 1.0 if self._household.activities[index].away else AT_WORK  # nobody is home for an hour in between
        if rng.random() >= (stays if begun else TO_WORK):
            return None
        return Choice(index, continues=begun and self._moment.lasting, why="work")

    def going_on(self, rng: np.random.Generator) -> Choice | None:
        """Go on with what takes longer than an hour, also after something short came between."""
        if not self._moment.lasting or not self._moment.today:
            return None
        recent = [one.activity for one in reversed(self._moment.today[-2:])]
        between = 1.0
        for index in recent:
            activity = self._household.activities[index]
            if activity.lasts > 1 and self._allowed[index] and not self._life.time.set_hours[index]:
                chance = between * (1.0 - 1.0 / activity.lasts)
                return Choice(index, continues=True, why="going on") if rng.random() < chance else None
            if activity.whole or activity.closes:
                return None
            between = RESUMED
        return None

    def wish(self, rng: np.random.Generator, temperature: float) -> int:
        """Draw from what the person feels like; without anything new, from all that is possible."""
        open_to = self._fresh & ~self._life.time.set_hours
        if self._closing:
            follows = self._allowed & (self._household.follow_matrix[self._closing[-1]] > 0)
            open_to = follows & self._fresh if (follows & self._fresh).any() else follows
        for mask in (open_to, self._fresh, self._allowed):
            if mask.any():
                break
        wish = self._life.wish(self._moment.weekday, self._moment.hour) + self._flow() + self._moment.extra
        logits = np.where(mask, wish * USUAL_TEMPERATURE / max(temperature, 0.01), NEVER)
        weights = np.exp(logits - logits.max())
        return int(rng.choice(len(weights), p=weights / weights.sum()))

    @property
    def _last(self) -> int | None:
        return self._moment.today[-1].activity if self._moment.today else None

    def _served(self, index: int) -> bool:
        """Whether a need has been met today, by this or by what serves as well."""
        return not self._done.isdisjoint(self._life.time.serves(index))

    def _taken_up(self) -> list[int]:
        """The hours just before this one that sleep or another need took: what was due then still is."""
        hours: list[int] = []
        for one in reversed(self._moment.today):
            if one.activity not in self._needs:
                break
            hours.append(one.hour)
        return hours

    def _not_done_lately(self) -> NDArray[np.bool_]:
        """Nothing of today again, unless it is repeatable and three hours old."""
        fresh = np.ones(len(self._household.activities), dtype=bool)
        for one in self._moment.today:
            again = self._household.activities[one.activity].repeatable
            fresh[one.activity] &= again and self._moment.hour - one.hour >= AGAIN_AFTER
        return fresh

    def _may_begin(self, start: int) -> bool:
        """Whether work may begin now: at its first hour, or where only needs and sleep have come before."""
        needs = self._needs.union(*map(self._life.time.serves, self._life.time.daily))
        since = [one.activity for one in self._moment.today if one.hour >= start]
        return all(index in needs or self._household.activities[index].after for index in since)

    def _flow(self) -> Floats:
        """Logits for what tends to follow the day so far, the last activity most."""
        total = np.zeros(len(self._household.activities))
        for one, weight in zip(reversed(self._moment.today), (NEXT, LATER, LATER), strict=False):
            total = total + weight * self._household.follow_matrix[one.activity]
        return total
