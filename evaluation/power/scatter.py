"""How much paired differences scatter between people, between a person's lives, and between a life's days."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats

from coopera.evaluation.analysis import Endpoint, late_day_values
from coopera.evaluation.results import Row


class Scatter(NamedTuple):
    """Standard deviations of a method's difference to the reference.

    Attributes:
        people: Between people.
        lives: Between the lives of a person: episodes, homes, seeds. With one life a person it is in `people`.
        days: Between the late days of a life. With one late day it is in `lives`.
        n: Of how many people it was estimated; 0 is no estimate but an assumption.
    """

    people: float
    lives: float
    days: float
    n: int = 0

    @property
    def caution(self) -> float:
        """What to multiply it with for the upper 80 % limit of a standard deviation of so many people."""
        return math.sqrt((self.n - 1) / float(stats.chi2.ppf(0.2, self.n - 1))) if self.n > 1 else 1.0


ASSUMED = Scatter(people=0.04, lives=0.06, days=0.08)
"""Where no results are given: of the 17 comparisons of need F1 in docs/results/offline and offline-seeds, the upper
quartile of each."""


class Seen(NamedTuple):
    """What some results say of a method: its mean difference to the reference over people, and the scatter."""

    difference: float
    scatter: Scatter


def seen(rows: Sequence[Row], endpoint: Endpoint) -> dict[str, Seen]:
    """Each method's difference to the endpoint's reference on the same late days, all settings and types together."""
    days = late_day_values(rows, endpoint)
    reference = days.pop(endpoint.reference, {})
    found = {}
    for method, lives in days.items():
        people: dict[str, list[list[float]]] = defaultdict(list)
        for (*_, person), each in lives.items():
            base = reference.get((*_, person), {})
            if shared := [each[day] - base[day] for day in each if day in base]:
                people[str(person)].append(shared)
        if len(people) > 1:
            mean = float(np.mean([np.mean([np.mean(one) for one in each]) for each in people.values()]))
            found[method] = Seen(mean, estimate(people))
    return found


def estimate(people: Mapping[str, Sequence[Sequence[float]]]) -> Scatter:
    """Variance components by the method of moments, each at least 0.

    Args:
        people: For each of at least two people the values of each day of each life.
    """
    lives = [np.asarray(days, dtype=np.float64) for each in people.values() for days in each]
    days = _pooled(lives)
    means = [np.array([np.mean(one) for one in each]) for each in people.values()]
    # a life's mean scatters by its days, too, and a person's by their lives
    per_life = float(np.mean([1 / len(one) for one in lives]))
    within = _pooled(means)
    between_lives: float = max(0.0, within - days * per_life)
    left = np.mean(
        [
            between_lives / len(each) + days * sum(1 / len(one) for one in each) / len(each) ** 2
            for each in people.values()
        ]
    )
    between = max(0.0, float(np.var([one.mean() for one in means], ddof=1)) - float(left))
    return Scatter(math.sqrt(between), math.sqrt(between_lives), math.sqrt(days), len(people))


def _pooled(groups: Sequence[np.ndarray[tuple[int, ...], np.dtype[np.float64]]]) -> float:
    """Variance within groups; 0 where none has two values."""
    freedom = sum(len(one) - 1 for one in groups)
    return float(sum(((one - one.mean()) ** 2).sum() for one in groups)) / freedom if freedom else 0.0
