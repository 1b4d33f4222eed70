"""Comparing methods honestly: intervals over people, paired permutation tests, Holm, and power.

Hours of one person are alike, so the unit of inference is the person: what a person has in several homes, episodes and
seeds is averaged first. So the figures speak of other people in these homes, and not of other homes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats

from coopera.evaluation.statistics import FEWEST, Mean, mean_over_people

ALPHA = 0.05
POWER = 0.8
_EXACT = 12  # up to so many people every assignment of signs is tried


class Unit(NamedTuple):
    """One number of one person in one home under one seed."""

    person: str
    scene: str
    seed: int
    value: float


class Comparison(NamedTuple):
    """A method against the reference, on the same days.

    Attributes:
        difference: Mean over people of the paired differences, with its t interval.
        p: Of a sign-flip permutation test over people, two-sided; 1 where there is nothing to test.
        p_holm: After Holm's correction among the methods compared.
        people: How many people the test flips; the smallest p it can give is 2 / 2^people.
        detectable: The difference that a t test of so many people at this scatter finds with 80 % power; None where
            the permutation test can give no p below 0.05.
    """

    method: str
    difference: Mean
    p: float
    p_holm: float
    people: int
    detectable: float | None


def person_means(units: Sequence[Unit]) -> list[float]:
    """Each person's mean over their homes, episodes and seeds, by name."""
    people = sorted({unit.person for unit in units})
    return [float(np.mean([unit.value for unit in units if unit.person == person])) for person in people]


def clustered_mean(units: Sequence[Unit], *, level: float = 0.95) -> Mean:
    """The mean over people with its t interval; a person weighs the same however often they were met.

    Args:
        units: At least one.
        level: Coverage in (0, 1).
    """
    return mean_over_people(person_means(units), level=level)


def sign_flip(differences: Sequence[float], *, seed: int = 0) -> float:
    """P-value of a two-sided permutation test that the differences (one per person) scatter around 0.

    Every assignment of signs for up to 12 people, 10,000 random ones for more; 1 for fewer than two people.
    """
    if len(differences) < 2 or not np.any(differences):
        return 1.0
    exact = len(differences) <= _EXACT
    test = stats.permutation_test(
        (np.asarray(differences, dtype=np.float64),),
        lambda x, axis: np.mean(x, axis=axis),
        permutation_type="samples",
        vectorized=True,
        n_resamples=np.inf if exact else 9999,
        alternative="two-sided",
        rng=np.random.default_rng(seed),
    )
    return float(min(1.0, test.pvalue))


def holm(p_values: Sequence[float]) -> list[float]:
    """Holm's step-down correction: the family-wise error stays below alpha whatever the dependence."""
    order = sorted(range(len(p_values)), key=lambda place: p_values[place])
    adjusted, most = [0.0] * len(p_values), 0.0
    for step, place in enumerate(order):
        most = max(most, min(1.0, (len(p_values) - step) * p_values[place]))
        adjusted[place] = most
    return adjusted


def smallest_p(people: int) -> float:
    """The smallest p that the sign-flip test can give: only + + + … and - - - … are as extreme."""
    return 2.0 ** (1 - people) if people > 1 else 1.0


def people_needed(comparisons: int) -> int:
    """How many people it takes for the smallest p of so many comparisons to stay below 0.05 after Holm's correction."""
    return next(people for people in range(2, 100) if comparisons * smallest_p(people) < ALPHA)


def detectable(differences: Sequence[float]) -> float | None:
    """The true difference that a two-sided test at 5 % would find with 80 % power, by the t approximation.

    None where a test of so many people cannot give p < 0.05 at all.
    """
    count = len(differences)
    if count < FEWEST or smallest_p(count) >= ALPHA:
        return None
    spread = float(np.std(differences, ddof=1))
    return float((stats.t.ppf(1 - ALPHA / 2, count - 1) + stats.t.ppf(POWER, count - 1)) * spread / math.sqrt(count))


def compare(
    reference: dict[tuple[object, ...], Unit], others: dict[str, dict[tuple[object, ...], Unit]]
) -> list[Comparison]:
    """Compare methods with a reference on the days that both lived.

    Args:
        reference: Unit by what it is of (setting, seed, episode, person).
        others: The same of each other method, by name.

    Returns:
        One comparison per method that shares a unit with the reference.
    """
    found: list[tuple[str, list[float]]] = []
    for method, units in others.items():
        shared = [
            unit._replace(value=unit.value - reference[key].value) for key, unit in units.items() if key in reference
        ]
        if not shared:
            continue
        found.append((method, person_means(shared)))
    p_values = [sign_flip(means) for _, means in found]
    return [
        Comparison(method, mean_over_people(means), p, p_holm, len(means), detectable(means))
        for (method, means), p, p_holm in zip(found, p_values, holm(p_values), strict=True)
    ]
