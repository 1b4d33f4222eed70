"""Whole lives of the offline person by `routine.choose` alone: no text is read, so a hundred days take a second."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from coopera.core.people import BigFive
from coopera.core.randomness import rng_at
from coopera.models.offline.household.knowledge import FIRST, LAST, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.circumstances import circumstances
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.routine import Moment, Why, live_day
from tests.models.offline.questions import WORDS

HOURS = range(FIRST, LAST + 1)


class Hour(NamedTuple):
    """An hour that was lived."""

    weekday: int
    hour: int
    doing: str
    continues: bool
    why: Why


@lru_cache(maxsize=1)
def sense() -> CommonSense:
    """The person's household file by the words encoder."""
    return CommonSense(shipped(), WORDS)


@lru_cache(maxsize=400)
def somebody(profile: str, **traits: float) -> PrivateLife:
    """Whoever says this of themselves."""
    return PrivateLife(sense(), profile, BigFive(**traits))


def lived(
    life: PrivateLife,
    days: int | Sequence[int],
    *,
    seed: int = 0,
    lasting: bool = True,
    absence: bool = False,
    changes: Sequence[Mapping[str, Any]] = (),
) -> list[list[Hour]]:
    """Days of a life in a home with every room; day 0 is a Monday."""
    household = life.household
    changed = circumstances(household, changes, absence=absence)
    lives: list[list[Hour]] = []
    for day in range(days) if isinstance(days, int) else days:
        moment = Moment(
            hour=FIRST,
            weekday=day % 7,
            today=(),
            lasting=lasting,
            absence=absence,
            possible=changed.can_do,
            extra=changed.pull,
            job=changed.job,
        )
        draws = (rng_at(seed, "a life", float(life.liking[0]), day, hour) for hour in HOURS)
        choices = live_day(life, moment, HOURS, draws)
        lives.append(
            [
                Hour(day % 7, hour, household.activities[one.activity].id, one.continues, one.why)
                for hour, one in zip(HOURS, choices, strict=True)
            ]
        )
    return lives


def share(days: Sequence[Sequence[Hour]], *doing: str) -> float:
    """Share of days on which something of these is done."""
    return float(np.mean([any(hour.doing in doing for hour in day) for day in days]))


def of_hours(days: Sequence[Sequence[Hour]], *doing: str) -> float:
    """Share of hours that are one of these."""
    return float(np.mean([hour.doing in doing for day in days for hour in day]))
