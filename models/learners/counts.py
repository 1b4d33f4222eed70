"""Smoothed counts of exact identities: how often a thing was used in a context, over how often the context was met.

An observation is a yes or no about a thing at a moment. Its contexts are whole numbers that name what was so then: the
hour, the weekday's type, the activity before, where the thing is, the person. The first few are also counted two at a
time. A pair is met less often than either of the two and says more, so its rate starts from the mean of their rates.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

PRIOR = 1.0
"""How many observations the coarser rate is worth, that a finer one starts from."""
PAIRED = 3
"""So many contexts, from the first, are paired; the others are for what learns on top of counts."""
_RARE = 0.02
"""The rate of a thing of which nothing is known."""
TINY = 1e-4
"""No probability is nearer than this to 0 or 1."""
NEAR = (1.0, 0.6, 0.14)
"""What a count weighs at a distance of 0, 1 and 2 hours: a Gaussian of one hour."""


@dataclass(frozen=True, slots=True)
class Observations:
    """n observations; row by row.

    Attributes:
        day: Shape (n,), from 0.
        thing: Shape (n,), from 0.
        contexts: Shape (n, c), from 0 and below 2**20. The first is the hour, or another scale on which near values are
            alike; the first `PAIRED` are those that say most.
        numbers: Shape (n, k): whatever else is known beforehand; counts do not use it.
        label: Shape (n,).
    """

    day: Ints
    thing: Ints
    contexts: Ints
    numbers: Floats
    label: Bools

    def __len__(self) -> int:
        return len(self.day)

    def take(self, rows: Bools) -> Observations:
        """Return the observations that are marked."""
        return replace(self, **{field.name: getattr(self, field.name)[rows] for field in fields(self)})


class Rates(NamedTuple):
    """What counts say of each observation, where c contexts make p pairs."""

    probabilities: Floats
    """(n,): P(yes), by the mean log-odds of the pairs; by the one context where there is no pair."""
    shares: Floats
    """(n, c + p + 1): smoothed rate per context, per pair, and that of the hour with near hours."""
    evidence: Floats
    """(n, c + p): how many weighed observations each rate stands on."""
    before: Floats
    """(n,): expected uses today before this hour."""
    after: Floats
    """(n,): expected uses today from this hour on."""


class Counts:
    """Tallies of labelled observations."""

    def __init__(self, seen: Observations, weights: Floats | None = None) -> None:
        """Count.

        Args:
            seen: What was observed; there may be none.
            weights: What each observation counts, shape (n,); 1 by default.
        """
        self._weights = np.ones(len(seen)) if weights is None else weights
        self._seen = seen
        self._base = _Tally(seen.thing, seen, self._weights)
        self._single = [_Tally(keys, seen, self._weights) for keys in _single(seen)]
        self._paired = [_Tally(keys, seen, self._weights) for keys in _paired(seen)]
        self._hours = int(seen.contexts[:, 0].max()) + 1 if len(seen) else 0

    def rates(self, asked: Observations, *, own_day: bool = True) -> Rates:
        """Return what was counted for each observation.

        Args:
            asked: The labels are not looked at.
            own_day: False leaves out what was observed on the same day, so that a day from which was learned can be
                treated as one that is still to come.
        """
        day = None if own_day else asked.day
        yes, met = self._base.at(asked.thing, day)
        base = (yes + PRIOR * _RARE) / (met + PRIOR)
        single = [tally.at(keys, day) for tally, keys in zip(self._single, _single(asked), strict=True)]
        paired = [tally.at(keys, day) for tally, keys in zip(self._paired, _paired(asked), strict=True)]
        shares = [(yes + PRIOR * base) / (met + PRIOR) for yes, met in single]
        starts = [(one + other) / 2 for one, other in combinations(shares[:PAIRED], 2)]
        pairs = [(yes + PRIOR * start) / (met + PRIOR) for (yes, met), start in zip(paired, starts, strict=True)]
        chance = probability(np.mean([log_odds(share) for share in pairs or shares[:1]], axis=0))
        near, before, after = self._by_hour(asked, base, day)
        evidence = np.stack([met for _, met in single + paired], 1)
        return Rates(chance, np.stack([*shares, *pairs, near], 1), evidence, before, after)

    def _by_hour(self, asked: Observations, base: Floats, day: Ints | None) -> tuple[Floats, Floats, Floats]:
        """Return the rate at near hours, and the expected uses before and from this hour on; shape (n,) each."""
        hour = asked.contexts[:, 0]
        near_yes, near_met, before, after = (np.zeros(len(asked)) for _ in range(4))
        for other in range(self._hours):
            yes, met = self._single[0].at(_keys(np.full_like(hour, other), asked.thing), day)
            apart = np.abs(hour - other)
            weight = np.array([*NEAR, 0.0])[np.minimum(apart, len(NEAR))]
            near_yes, near_met = near_yes + weight * yes, near_met + weight * met
            rate = yes / np.maximum(met, 1e-9)
            before, after = before + (other < hour) * rate, after + (other >= hour) * rate
        return (near_yes + PRIOR * base) / (near_met + PRIOR), before, after


class _Tally:
    """Weighed counts of yes and of all by key, and the same by key and day."""

    def __init__(self, keys: Ints, seen: Observations, weights: Floats) -> None:
        self._days = int(seen.day.max()) + 1 if len(seen) else 1
        self._all = _counted(keys, seen.label, weights)
        self._daily = _counted(keys * self._days + seen.day, seen.label, weights)

    def at(self, keys: Ints, without: Ints | None) -> tuple[Floats, Floats]:
        """Return yes and all per key, shape (n,) each, without those of a day of each row's own."""
        yes, met = _found(self._all, keys)
        if without is not None:
            known = without < self._days
            own_yes, own_met = _found(self._daily, np.where(known, keys * self._days + without, -1))
            yes, met = yes - own_yes, np.maximum(met - own_met, 0.0)
        return np.clip(yes, 0.0, met), met


def _counted(keys: Ints, label: Bools, weights: Floats) -> tuple[Ints, Floats, Floats]:
    names, place = np.unique(keys, return_inverse=True)
    yes, met = (np.bincount(place, one, len(names)).astype(np.float64) for one in (weights * label, weights))
    return names, yes, met


def _found(tally: tuple[Ints, Floats, Floats], keys: Ints) -> tuple[Floats, Floats]:
    names, yes, met = tally
    if not len(names):
        return np.zeros(len(keys)), np.zeros(len(keys))
    place = np.minimum(np.searchsorted(names, keys), len(names) - 1)
    there = names[place] == keys
    return yes[place] * there, met[place] * there


def log_odds(chance: Floats) -> Floats:
    """Return the log-odds of probabilities, which are kept from 0 and 1 by `TINY`."""
    kept = np.clip(chance, TINY, 1 - TINY)
    found: Floats = np.log(kept) - np.log1p(-kept)
    return found


def probability(odds: Floats) -> Floats:
    """Return the probabilities of log-odds."""
    found: Floats = 1.0 / (1.0 + np.exp(-odds))
    return found


def _single(rows: Observations) -> list[Ints]:
    """One number per context and thing."""
    return [_keys(column, rows.thing) for column in rows.contexts.T]


def _paired(rows: Observations) -> list[Ints]:
    """One number per pair of contexts and thing."""
    return [_keys(one * _MOST + other, rows.thing) for one, other in combinations(rows.contexts.T[:PAIRED], 2)]


def _keys(context: Ints, thing: Ints) -> Ints:
    return context * _MOST + thing


_MOST = 1 << 16  # more things than any home has
