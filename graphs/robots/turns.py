"""How much each told day still counts: whether the person has become another since.

Nothing fades while nothing changes. After a turn in a life (a job, a hobby, an illness) what was told before it is soon
outvoted by what was told since; see `coopera.models.learners.fading`.
DEVIATES: the paper's robot forgets by the hour, whatever happens.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from coopera.core.clock import Clock
from coopera.core.household import Use
from coopera.core.time_use import day_type
from coopera.models.learners.counts import Observations
from coopera.models.learners.habits import faded

TEMPER = 0.05
"""What a day's log-likelihood counts: an hour's things hang together, and most of them are not used on most days. Six
shipped people, fifteen days: without a change the first day kept a weight of 0.89 or more, and two to four days after
one of them had become another one it was below 0.35."""

Uses: TypeAlias = tuple[tuple[int, tuple[str, ...]], ...]
"""The things that were used in each told hour, sorted, by its global index; in order of time. Sets take five times as
much, and those of all days are kept."""


def things_of(hours: Iterable[tuple[int, Sequence[Use]]]) -> Uses:
    """What the turns of a life are seen by."""
    return tuple(
        (now, tuple(sorted({use.thing for use in uses}))) for now, uses in sorted(hours, key=lambda one: one[0])
    )


@lru_cache(maxsize=2)  # what the robot recalls all day, and what the evening learns from, each of up to all days
def still_counts(hours: Uses) -> dict[int, float]:
    """How much each told day still counts, in (0, 1]; near 1 for all while nothing changes.

    Each day was foretold from what was used at its hours on earlier days: on any, and on those of its kind.
    """
    things = sorted({thing for _, used in hours for thing in used})
    if not things:
        return {}
    clocks = [Clock(day=now // 24, hour=now % 24) for now, _ in hours]
    days, place = np.unique([clock.day for clock in clocks], return_inverse=True)
    at = np.array([clock.hour for clock in clocks])
    at_kind = at + 24 * np.array([day_type(clock.day) == "weekend" for clock in clocks])
    contexts = np.stack([at, np.zeros_like(at), at_kind], 1)
    seen = Observations(
        day=np.repeat(place, len(things)),
        thing=np.tile(np.arange(len(things)), len(hours)),
        contexts=np.repeat(contexts, len(things), axis=0),
        numbers=np.zeros((len(hours) * len(things), 0)),
        label=np.array([[thing in used for thing in things] for used in (set(said) for _, said in hours)]).ravel(),
    )
    weights = faded(seen, temper=TEMPER).of(np.arange(len(days)))
    return {int(day): round(float(weight), 6) for day, weight in zip(days, weights, strict=True)}
