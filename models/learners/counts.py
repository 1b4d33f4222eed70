"""Smoothed counts of exact identities: how often a thing was used in a context, over how often the context was met.

An observation is a yes or no about a thing at a moment. Its contexts are whole numbers that name what was so then: the
hour, the weekday's type, the activity before, the person, or any two of them together.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

PRIOR = 1.0
"""How many observations the coarser rate is worth, that a finer one starts from."""
COARSE = 2
"""The finest rate starts from the mean of so many, from the first; the others are for what learns on top of counts."""
_RARE = 0.02
"""The rate of a thing of which nothing is known."""
NEAR = (1.0, 0.6, 0.14)
"""What a count weighs at a distance of 0, 1 and 2 hours: a Gaussian of one hour."""


@dataclass(frozen=True, slots=True)
class Observations:
    """n observations; row by row.

    Attributes:
        day: Shape (n,), from 0.
        thing: Shape (n,), from 0.
        contexts: Shape (n, c), from 0. The first is the hour, or another scale on which near values are alike; the last
            is the finest, and starts from the mean of the first `COARSE`.
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
    """What counts say of each observation."""

    shares: Floats
    """(n, c + 1): smoothed rate per context, then that of the hour with near hours."""
    evidence: Floats
    """(n, c): how many weighed observations each rate stands on."""
    before: Floats
    """(n,): expected uses today before this hour."""
    after: Floats
    """(n,): expected uses today from this hour on."""

    @property
    def probabilities(self) -> Floats:
        """P(yes), shape (n,): the finest rate, which is the mean of the coarse ones where it was never met."""
        return self.shares[:, -2]


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
        self._tallies = [_Tally(_keys(column, seen.thing), seen, self._weights) for column in seen.contexts.T]
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
        counted = [
            tally.at(_keys(asked.contexts[:, place], asked.thing), day) for place, tally in enumerate(self._tallies)
        ]
        shares = [(yes + PRIOR * base) / (met + PRIOR) for yes, met in counted]
        if len(shares) > 1:
            yes, met = counted[-1]
            shares[-1] = (yes + PRIOR * np.mean(shares[:COARSE], axis=0)) / (met + PRIOR)
        near, before, after = self._by_hour(asked, base, day)
        return Rates(np.stack([*shares, near], 1), np.stack([met for _, met in counted], 1), before, after)

    def _by_hour(self, asked: Observations, base: Floats, day: Ints | None) -> tuple[Floats, Floats, Floats]:
        """Return the rate at near hours, and the expected uses before and from this hour on; shape (n,) each."""
        hour = asked.contexts[:, 0]
        near_yes, near_met, before, after = (np.zeros(len(asked)) for _ in range(4))
        for other in range(self._hours):
            yes, met = self._tallies[0].at(_keys(np.full_like(hour, other), asked.thing), day)
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


def _keys(context: Ints, thing: Ints) -> Ints:
    """One number per context and thing."""
    return context * _THINGS + thing


_THINGS = 1 << 20  # more things than any home has
