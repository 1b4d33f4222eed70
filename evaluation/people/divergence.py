"""How far apart two distributions are, and two sets of days by what was done on them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from itertools import combinations
from typing import TypeAlias, TypeVar

import numpy as np

from coopera.core.randomness import rng_at
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.lives import LivedDay

Group = TypeVar("Group", bound=Hashable)
Named: TypeAlias = Callable[[str], str]
"""An intention's text -> what it is counted as, such as its activity's id."""


def jensen_shannon(one: Floats, other: Floats) -> Floats:
    """Jensen-Shannon divergence over the last axis, base 2: 0 for equal distributions, 1 for disjoint ones.

    Args:
        one: Distributions, shape (..., k), non-negative and of sum 1; nan gives nan.
        other: The same, of a shape that goes with it.
    """
    middle = (one + other) / 2

    def to_middle(part: Floats) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore"):
            terms = np.where(part == 0, 0.0, part * np.log2(part / middle))
        return np.asarray(terms.sum(axis=-1))

    return np.clip((to_middle(one) + to_middle(other)) / 2, 0.0, 1.0)


def earth_mover(one: Floats, other: Floats, at: Sequence[float]) -> Floats:
    """Earth mover's distance over the last axis, in the unit of `at`: how far mass has to move on average.

    Both sides are divided by their sums; where one of them sums to nothing, the distance is nan.

    Args:
        one: Non-negative masses, shape (..., k).
        other: The same, of a shape that goes with it.
        at: Where the k masses lie, rising.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = np.cumsum(one / one.sum(axis=-1, keepdims=True) - other / other.sum(axis=-1, keepdims=True), axis=-1)
    return np.asarray(np.abs(ahead[..., :-1]) @ np.diff(np.asarray(at, dtype=np.float64)))


def divergence(one: Sequence[LivedDay], other: Sequence[LivedDay], named: Named) -> float:
    """Jensen-Shannon divergence, in bits, of what was done on two sets of days; nan where one has no hour.

    Sets of few days are far apart by chance alone: compare sets of equal size with each other, or with `by_chance`.
    """
    counts = [Counter(named(text) for day in days for text in day.intentions) for days in (one, other)]
    if not all(counts):
        return float("nan")
    names = sorted(counts[0] | counts[1])
    first, second = (np.array([count[name] for name in names]) / count.total() for count in counts)
    return float(jensen_shannon(first, second))


def between_groups(days: Iterable[LivedDay], group: Callable[[LivedDay], Group], named: Named) -> dict[Group, float]:
    """Of each group of days (by id, by persona), the mean divergence to each of the other groups; nan for a single one.

    Args:
        days: All days.
        group: Whose group a day belongs to.
        named: What an intention is counted as.
    """
    groups: dict[Group, list[LivedDay]] = {}
    for day in days:
        groups.setdefault(group(day), []).append(day)
    found: dict[Group, list[float]] = {key: [] for key in groups}
    for one, other in combinations(groups, 2):
        apart = divergence(groups[one], groups[other], named)
        found[one].append(apart)
        found[other].append(apart)
    return {key: float(np.mean(values)) if values else float("nan") for key, values in found.items()}


def by_chance(days: Sequence[LivedDay], named: Named, *, draws: int = 100, seed: int = 0) -> float:
    """Mean divergence of two random halves of some days (at least two): what two equal sets of that size show."""
    if len(days) < 2:
        raise ValueError("it takes at least two days to halve them")
    found = []
    for draw in range(draws):
        order = rng_at(seed, "halves", draw).permutation(len(days))
        half = len(days) // 2
        found.append(divergence([days[at] for at in order[:half]], [days[at] for at in order[half : 2 * half]], named))
    return float(np.mean(found))


def by_lag(days: Iterable[LivedDay], lags: Sequence[int], named: Named) -> Mapping[int, float]:
    """Mean divergence of two single days of one life (a person in a home, of one seed) by the days between them.

    A person who drifts has a curve that rises, one with a rhythm of the week dips at 7. nan for a lag without a pair.
    """
    lives: dict[tuple[str, str, int], dict[int, LivedDay]] = {}
    for day in days:
        lives.setdefault((day.person, day.scene, day.seed), {})[day.number] = day
    found = {}
    for lag in lags:
        pairs = [(day, life[n + lag]) for life in lives.values() for n, day in sorted(life.items()) if n + lag in life]
        apart = [divergence([one], [other], named) for one, other in pairs]
        found[lag] = float(np.mean(apart)) if apart else float("nan")
    return found
