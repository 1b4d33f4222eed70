"""Comparing methods honestly: intervals clustered by person and home, paired permutation tests, Holm, and power.

Hours of one person are alike, and so are those in one home; the units of inference are people, homes and seeds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats

from coopera.evaluation.statistics import Interval

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
        difference: Mean of the paired differences, with its clustered interval.
        p: Of a sign-flip permutation test over people, two-sided; 1 where there is nothing to test.
        p_holm: After Holm's correction among the methods compared.
        people: How many people the test flips; the smallest p it can give is 2 / 2^people.
        detectable: The difference that would be found with 80 % power at this scatter; None for fewer than 3 people.
    """

    method: str
    difference: Interval
    p: float
    p_holm: float
    people: int
    detectable: float | None


def clustered_mean(units: Sequence[Unit], *, level: float = 0.95, draws: int = 4000, seed: int = 0) -> Interval:
    """The mean of units with a bootstrap interval that resamples people and homes (a pigeonhole bootstrap).

    People and homes are drawn with replacement, each by itself, and a unit weighs by the product of how often its
    person and its home were drawn; a draw that meets no unit is left out. With one person and one home the interval is
    the mean alone, which says that nothing is known of its spread.

    Args:
        units: At least one.
        level: Coverage in (0, 1).
        draws: Resamples.
        seed: Of the resampling.
    """
    rng = np.random.default_rng(seed)
    values = np.array([unit.value for unit in units])
    weights = np.ones((draws, len(units)))
    for names in ([unit.person for unit in units], [unit.scene for unit in units]):
        groups, member = np.unique(names, return_inverse=True)
        weights *= rng.multinomial(len(groups), np.full(len(groups), 1 / len(groups)), size=draws)[:, member]
    weights = weights[weights.sum(axis=1) > 0]
    means = weights @ values / weights.sum(axis=1)
    low, high = np.quantile(means, [(1 - level) / 2, (1 + level) / 2])
    return Interval(float(values.mean()), float(low), float(high))


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


def detectable(differences: Sequence[float]) -> float | None:
    """The true difference that a two-sided test at 5 % would find with 80 % power, by the normal approximation."""
    if len(differences) < 3:
        return None
    spread = float(np.std(differences, ddof=1))
    return float((stats.norm.ppf(1 - ALPHA / 2) + stats.norm.ppf(POWER)) * spread / math.sqrt(len(differences)))


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
    found: list[tuple[str, Interval, list[float]]] = []
    for method, units in others.items():
        shared = [
            unit._replace(value=unit.value - reference[key].value) for key, unit in units.items() if key in reference
        ]
        if not shared:
            continue
        people = sorted({unit.person for unit in shared})
        means = [float(np.mean([unit.value for unit in shared if unit.person == person])) for person in people]
        found.append((method, clustered_mean(shared), means))
    p_values = [sign_flip(means) for *_, means in found]
    return [
        Comparison(method, interval, p, p_holm, len(means), detectable(means))
        for (method, interval, means), p, p_holm in zip(found, p_values, holm(p_values), strict=True)
    ]
