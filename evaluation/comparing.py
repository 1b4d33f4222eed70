"""Comparing methods honestly: intervals over people, paired permutation tests, Holm, and power.

Hours of one person are alike, so the unit of inference is the person: what a person has in several homes, episodes and
seeds is averaged first. So the figures speak of other people in these homes, and not of other homes.
"""

from __future__ import annotations

import functools
import math
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Sequence
from itertools import product
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from coopera.evaluation.statistics import FEWEST, Mean, mean_over_people

Floats: TypeAlias = NDArray[np.float64]

ALPHA = 0.05
POWER = 0.8
_EXACT = 12  # up to so many people every assignment of signs is tried
_AT_ONCE = 250  # studies, so that a table of their permutations stays small


Of: TypeAlias = tuple[Hashable, ...]
"""What a unit is of: setting, type, seed, episode and person."""
_SEED = 2


class Unit(NamedTuple):
    """One number of one person in one home under one seed."""

    person: str
    scene: str
    seed: int
    value: float


class Noise(NamedTuple):
    """How much a figure moves with the seed, with nothing else changed.

    Attributes:
        sd: Standard deviation between seeds of one person's figure in one episode, pooled, with its 95 % interval.
        freedom: Degrees of freedom of it.
        floor: What the mean over people moves by under other seeds: 95 % of such studies stay within it.
    """

    sd: float
    low: float
    high: float
    freedom: int
    floor: float


class Comparison(NamedTuple):
    """A method against the reference, on the same days.

    Attributes:
        difference: Mean over people of the paired differences, with its interval.
        p: Of a test over people, two-sided; 1 where there is nothing to test.
        p_corrected: After the correction among the methods compared; None for one that no hypothesis names.
        people: How many people are tested; the smallest p that the sign-flip test can give is 2 / 2^people.
        noise: Its noise floor; None with a single seed.
        detectable: The difference that a t test of so many people at this scatter finds with 80 % power; None where
            the permutation test can give no p below 0.05.
    """

    method: str
    difference: Mean
    p: float
    p_corrected: float | None
    people: int
    detectable: float | None
    noise: Noise | None = None

    @property
    def below_noise(self) -> bool:
        """Whether other seeds alone could have made it."""
        return self.noise is not None and abs(self.difference.mean) < self.noise.floor


def person_means(units: Sequence[Unit]) -> list[float]:
    """Each person's mean over their homes, episodes and seeds, by name."""
    people = sorted({unit.person for unit in units})
    return [float(np.mean([unit.value for unit in units if unit.person == person])) for person in people]


def clustered_mean(units: Sequence[Unit], *, level: float = 0.95) -> Mean:
    """The mean over people with its interval; a person weighs the same however often they were met.

    Args:
        units: At least one.
        level: Coverage in (0, 1).
    """
    return mean_over_people(person_means(units), level=level)


def noise(units: dict[Of, Unit], of: dict[Of, Unit] | None = None, *, level: float = 0.95) -> Noise | None:
    """The noise floor of the mean over people, from what the same people had in the same episode under several seeds.

    Seeds are drawn anew for each person, so that their noise averages out over people.

    Args:
        units: What they had; with a single seed there is no floor.
        of: The units whose mean the floor is of; by default the same.
        level: Share of such studies that stay within the floor.
    """
    groups: dict[Of, list[float]] = defaultdict(list)
    for key, unit in units.items():
        groups[(*key[:_SEED], *key[_SEED + 1 :])].append(unit.value)
    freedom = sum(len(values) - 1 for values in groups.values())
    if not freedom:
        return None
    squares = sum(float(np.var(values)) * len(values) for values in groups.values())
    met = Counter(unit.person for unit in (of or units).values())
    share = sum(1 / times for times in met.values()) / len(met) ** 2
    sd = math.sqrt(squares / freedom)
    low, high = (sd * math.sqrt(freedom / float(stats.chi2.ppf(at, freedom))) for at in (0.975, 0.025))
    return Noise(sd, low, high, freedom, float(stats.t.ppf((1 + level) / 2, freedom)) * sd * math.sqrt(share))


def sign_flip(differences: Sequence[float]) -> float:
    """P-value of a two-sided permutation test that the differences (one per person) scatter around 0.

    Every assignment of signs for up to 12 people, 10,000 random ones for more; 1 for fewer than two people.
    """
    return float(sign_flips(np.asarray(differences, dtype=np.float64)[None])[0])


def sign_flips(studies: Floats) -> Floats:
    """The p-values of `sign_flip` of many studies at once.

    Args:
        studies: Differences, shape (studies, people).

    Returns:
        Shape (studies,).
    """
    count = studies.shape[1]
    if count < 2:
        return np.ones(len(studies))
    signs, exact = _signs(count), count <= _EXACT
    # sums that differ by rounding alone are equal
    bound = np.abs(studies.sum(axis=1)) - 1e-12 * np.abs(studies).sum(axis=1)
    found = np.empty(len(studies))
    for start in range(0, len(studies), _AT_ONCE):
        part = slice(start, start + _AT_ONCE)
        extreme = (np.abs(studies[part] @ signs) >= bound[part, None]).sum(axis=1)
        found[part] = extreme / signs.shape[1] if exact else (extreme + 1) / (signs.shape[1] + 1)
    return found


@functools.cache
def _signs(count: int) -> Floats:
    """Assignments of signs in columns; of each and its opposite, which are equally extreme, one stands for both."""
    if count <= _EXACT:
        rest = np.array(list(product((1.0, -1.0), repeat=count - 1))).T
        return np.vstack([np.ones((1, rest.shape[1])), rest])
    return np.random.default_rng(0).choice((1.0, -1.0), (count, 9999))


def t_tests(studies: Floats) -> Floats:
    """P-values of two-sided t tests that the differences of each study have the mean 0; arguments as `sign_flips`."""
    count = studies.shape[1]
    if count < FEWEST:
        return np.ones(len(studies))
    error = studies.std(axis=1, ddof=1) / math.sqrt(count)
    means = studies.mean(axis=1)
    ratio = np.divide(means, error, out=np.where(means == 0, 0.0, np.inf), where=error > 0)
    return np.asarray(2 * stats.t.sf(np.abs(ratio), count - 1), dtype=np.float64)


TESTS: dict[str, Callable[[Floats], Floats]] = {"sign_flip": sign_flips, "t": t_tests}
"""The tests over people that an endpoint may name."""


def holm(p_values: Sequence[float]) -> list[float]:
    """Holm's step-down correction: the family-wise error stays below alpha whatever the dependence."""
    return [float(p) for p in holm_all(np.asarray(p_values, dtype=np.float64)[None])[0]]


def holm_all(p_values: Floats) -> Floats:
    """Holm's correction of many studies at once, shape (studies, comparisons)."""
    order = np.argsort(p_values, axis=1, kind="stable")
    weights = np.arange(p_values.shape[1], 0, -1)
    raised = np.minimum(1.0, np.maximum.accumulate(weights * np.take_along_axis(p_values, order, axis=1), axis=1))
    found = np.empty_like(p_values)
    np.put_along_axis(found, order, raised, axis=1)
    return found


CORRECTIONS: dict[str, Callable[[Floats], Floats]] = {"holm": holm_all, "none": np.copy}
"""The corrections for several comparisons that an endpoint may name."""


def smallest_p(people: int) -> float:
    """The smallest p that the sign-flip test can give: only + + + … and - - - … are as extreme."""
    return 2.0 ** (1 - people) if people > 1 else 1.0


def people_needed(comparisons: int) -> int:
    """How many people the sign-flip test takes for its smallest p, times so many comparisons, to be below 0.05."""
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
    reference: dict[Of, Unit],
    others: dict[str, dict[Of, Unit]],
    *,
    test: str = "sign_flip",
    correction: str = "holm",
) -> list[Comparison]:
    """Compare methods with a reference on the days that both lived.

    Args:
        reference: Unit by what it is of (setting, type, seed, episode, person).
        others: The same of each other method, by name.
        test: One of `TESTS`.
        correction: One of `CORRECTIONS`, among all methods compared.

    Returns:
        One comparison per method that shares a unit with the reference.
    """
    found: list[tuple[str, list[float], Noise | None]] = []
    for method, units in others.items():
        if shared := paired(reference, units):
            found.append((method, person_means(list(shared.values())), noise(shared)))
    p_values = np.array([[TESTS[test](np.array([means]))[0] for _, means, _ in found]])
    corrected = CORRECTIONS[correction](p_values)[0]
    return [
        Comparison(method, mean_over_people(means), float(p), float(q), len(means), detectable(means), floor)
        for (method, means, floor), p, q in zip(found, p_values[0], corrected, strict=True)
    ]


def paired(reference: dict[Of, Unit], units: dict[Of, Unit]) -> dict[Of, Unit]:
    """What a method has more than the reference, for each unit that both have."""
    return {key: one._replace(value=one.value - reference[key].value) for key, one in units.items() if key in reference}
