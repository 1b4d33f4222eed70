"""Means over people with intervals that hold, and bootstrap intervals for other statistics of people."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from scipy import stats

Unit = TypeVar("Unit")

FEWEST = 3
"""Of so many people at least an interval is given; two say next to nothing of how people scatter."""
TOO_SMALL = "n too small"
"""What stands in place of an interval."""


class Interval(NamedTuple):
    """A statistic with its bootstrap interval."""

    mean: float
    low: float
    high: float


class Mean(NamedTuple):
    """A mean over people; `low` and `high` are None for fewer than `FEWEST` people."""

    mean: float
    low: float | None
    high: float | None
    people: int

    def __str__(self) -> str:
        """As tables show it."""
        return f"{self.mean:.3f} {self.interval}"

    @property
    def interval(self) -> str:
        """The interval in brackets, or that there is none."""
        if self.low is None or self.high is None:
            return f"({TOO_SMALL})"
        return f"[{self.low:.3f}, {self.high:.3f}]"


def mean_over_people(values: Sequence[float], *, level: float = 0.95) -> Mean:
    """The mean with its interval by Student's t.

    The percentile bootstrap that stood here covered 0.76 with three people and 0.89 with six to ten where it said 0.95.
    The tests simulate what this one covers with 6, 12 and 20 people.

    Args:
        values: One number per person, at least one. Whoever has several (days, homes, seeds) has their mean here.
        level: Coverage in (0, 1).
    """
    sample = np.asarray(values, dtype=np.float64)
    mean, count = float(sample.mean()), len(sample)
    if count < FEWEST:
        return Mean(mean, None, None, count)
    half = _quantile((1 + level) / 2, count - 1) * float(sample.std(ddof=1)) / math.sqrt(count)
    return Mean(mean, mean - half, mean + half, count)


@functools.cache
def _quantile(share: float, freedom: int) -> float:
    return float(stats.t.ppf(share, freedom))


def bootstrap(
    units: Sequence[Unit],
    statistic: Callable[[Sequence[Unit]], float],
    *,
    level: float = 0.95,
    draws: int = 2000,
    seed: int = 0,
) -> Interval:
    """Any statistic of independent units with a percentile bootstrap interval; `mean` is its value on all of them.

    For statistics that are no mean over people (accuracies, correlations, divergences), which have no t interval; for
    means there is `mean_over_people`. With ten units or fewer it covers less than it says.

    Where measurements belong together (a person's days), the unit is all of a person's, so that the interval is
    clustered by person. A resample on which the statistic is nan is left out; if it is nan on all, so are the ends.

    Args:
        units: The independent units, at least one.
        statistic: A number from some units; nan where it has no meaning.
        level: Coverage in (0, 1).
        draws: Resamples.
        seed: Of the resampling.
    """
    rng = np.random.default_rng(seed)
    drawn = rng.integers(0, len(units), (draws, len(units)))
    values = np.array([statistic([units[at] for at in row]) for row in drawn])
    values = values[~np.isnan(values)]
    low, high = np.quantile(values, [(1 - level) / 2, (1 + level) / 2]) if len(values) else (np.nan, np.nan)
    return Interval(float(statistic(units)), float(low), float(high))
