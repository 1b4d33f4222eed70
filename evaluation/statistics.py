"""Intervals for figures that come from a few people and seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

Unit = TypeVar("Unit")


class Interval(NamedTuple):
    """A mean with its bootstrap interval."""

    mean: float
    low: float
    high: float


def bootstrap_mean(values: Sequence[float], *, level: float = 0.95, draws: int = 10_000, seed: int = 0) -> Interval:
    """The mean of independent units (runs, people) with a percentile bootstrap interval.

    Args:
        values: One number per unit, at least one.
        level: Coverage in (0, 1).
        draws: Resamples.
        seed: Of the resampling.
    """
    sample = np.asarray(values, dtype=np.float64)
    rng = np.random.default_rng(seed)
    means = sample[rng.integers(0, len(sample), (draws, len(sample)))].mean(axis=1)
    low, high = np.quantile(means, [(1 - level) / 2, (1 + level) / 2])
    return Interval(float(sample.mean()), float(low), float(high))


def bootstrap(
    units: Sequence[Unit],
    statistic: Callable[[Sequence[Unit]], float],
    *,
    level: float = 0.95,
    draws: int = 2000,
    seed: int = 0,
) -> Interval:
    """Any statistic of independent units with a percentile bootstrap interval; `mean` is its value on all of them.

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
