"""Power by simulation: studies are drawn, and each meets the interval, the test and the correction of the analysis.

What is drawn is each person's mean difference to the reference. It is normal around the true one, with the variance
that follows from the scatter between people, between this person's lives and between these lives' late days. Methods
share the reference, so their differences are correlated: by one half, as if all methods scattered alike.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coopera.evaluation.comparing import ALPHA, CORRECTIONS, POWER, TESTS, Floats
from coopera.evaluation.power.scatter import Scatter, Seen
from coopera.evaluation.statistics import FEWEST, mean_over_people

STUDIES = 2000
DIFFERENCES = (0.02, 0.05, 0.1)
"""True differences whose power is shown."""
PEOPLE = (6, 9, 12, 16, 24, 32)
_SHARED = 0.5
_HIGHEST = 1.0  # no measure here differs by more


class Simulated(NamedTuple):
    """A figure of simulated studies with its Monte-Carlo error (a standard deviation)."""

    value: float
    error: float

    def __str__(self) -> str:
        """As tables show it."""
        return f"{self.value:.3f} ± {self.error:.3f}"


class Foreseen(NamedTuple):
    """What the study would say of one method.

    Attributes:
        power: By the true difference, where no other method differs from the reference: the least that it can be.
        detectable: The true difference found in 80 % of studies, likewise; None where none up to 1 is.
        cautious: The same if the scatter is at the upper 80 % limit of what was estimated; None if it was assumed.
        expected: The difference that the given results have; None without results.
        at_expected: Power if all methods differ from the reference as in those results.
    """

    method: str
    scatter: Scatter
    power: dict[float, Simulated]
    detectable: Simulated | None
    cautious: float | None
    expected: float | None
    at_expected: Simulated | None


class Forecast(NamedTuple):
    """What a study would find.

    Attributes:
        coverage: Of the 95 % intervals of a difference, if people are normal, and if they are skewed (exponential).
        false_alarms: Share of studies that find any difference where there is none.
    """

    people: int
    comparisons: list[Foreseen]
    coverage: dict[str, Simulated]
    false_alarms: Simulated


@dataclass(frozen=True, slots=True)
class Sample:
    """Whom a study meets: for each person, how many late days each of their lives has."""

    lives: tuple[tuple[int, ...], ...]

    def spread(self, scatter: Scatter) -> Floats:
        """The standard deviation of each person's mean difference, shape (people,)."""
        return np.sqrt([
            scatter.people**2
            + scatter.lives**2 / len(each)
            + scatter.days**2 * sum(1 / days for days in each) / len(each) ** 2
            for each in self.lives
        ])  # fmt: skip

    def of_size(self, people: int) -> Sample:
        """So many people, who are met as these are, in turn."""
        return Sample(tuple(self.lives[n % len(self.lives)] for n in range(people)))


@dataclass(frozen=True, slots=True)
class _Studies:
    """Simulated studies in which no method differs.

    Attributes:
        null: People's mean differences, shape (methods, studies, people).
        p: Of each, shape (studies, methods).
    """

    null: Floats
    p: Floats
    test: str
    correction: str

    @classmethod
    def draw(
        cls,
        spreads: Sequence[Floats],
        test: str,
        correction: str,
        seed: int,
        *,
        skewed: bool = False,
        studies: int = STUDIES,
    ) -> _Studies:
        rng = np.random.default_rng(seed)
        people = len(spreads[0])

        def noise(*shape: int) -> Floats:
            return rng.exponential(size=shape) - 1 if skewed else rng.normal(size=shape)

        shared = noise(studies, people)
        own = (_SHARED**0.5 * shared + (1 - _SHARED) ** 0.5 * noise(studies, people) for _ in spreads)
        null = np.array([z * spread for z, spread in zip(own, spreads, strict=True)])
        return cls(null, np.array([TESTS[test](z) for z in null]).T, test, correction)

    def found(self, differences: Floats) -> Floats:
        """The share of studies that find each method's difference, where the true ones are these, shape (methods,)."""
        p = np.array([TESTS[self.test](z + true) for z, true in zip(self.null, differences, strict=True)]).T
        return np.asarray((CORRECTIONS[self.correction](p) < ALPHA).mean(axis=0))

    def power(self, place: int, difference: float) -> Simulated:
        """The power for one method that differs so much, where no other does."""
        p = self.p.copy()
        p[:, place] = TESTS[self.test](self.null[place] + difference)
        return _share((CORRECTIONS[self.correction](p)[:, place] < ALPHA).mean())

    def detectable(self, place: int) -> Simulated | None:
        """Bisection to a hundredth of the way; the same draws serve all differences, so power only grows with them."""
        low, high = 0.0, 2.0 * float(self.null[place].std())
        while self.power(place, high).value < POWER:
            if high >= _HIGHEST:
                return None
            low, high = high, min(2 * high, _HIGHEST)
        near, width = high / 100, high / 20
        while high - low > near:
            middle = (low + high) / 2
            low, high = (low, middle) if self.power(place, middle).value >= POWER else (middle, high)
        slope = (self.power(place, high + width).value - self.power(place, high - width).value) / (2 * width)
        error = (POWER * (1 - POWER) / self.null.shape[1]) ** 0.5
        return Simulated(high, error / slope if slope > 0 else 0.0)

    def false_alarms(self) -> Simulated:
        """The share of studies that find anything."""
        return _share((CORRECTIONS[self.correction](self.p) < ALPHA).any(axis=1).mean())


def foresee(
    sample: Sample,
    scatters: Mapping[str, Scatter],
    *,
    test: str = "sign_flip",
    correction: str = "holm",
    results: Mapping[str, Seen] | None = None,
    seed: int = 0,
) -> Forecast:
    """Simulate the comparisons of a study.

    Args:
        sample: Whom it meets.
        scatters: Of each method that is compared, at least one.
        test: As the endpoint states, as is `correction`.
        correction: Among all these methods.
        results: What earlier results say, where there are any.
        seed: Of the simulation.
    """
    spreads = [sample.spread(scatter) for scatter in scatters.values()]
    studies = _Studies.draw(spreads, test, correction, seed)
    names, seen = list(scatters), results or {}
    expected = [seen[name].difference if name in seen else None for name in names]
    joint = studies.found(np.array([one or 0.0 for one in expected])) if results else np.zeros(len(names))
    limits: dict[bytes, tuple[dict[float, Simulated], Simulated | None]] = {}
    made = []
    for place, (name, scatter) in enumerate(scatters.items()):
        key = spreads[place].tobytes()  # methods that scatter alike are found alike
        if key not in limits:
            power = {true: studies.power(place, true) for true in DIFFERENCES}
            limits[key] = power, studies.detectable(place)
        power, detectable = limits[key]
        wanted = expected[place]
        made.append(
            Foreseen(
                name,
                scatter,
                power,
                detectable,
                detectable.value * scatter.caution if detectable and scatter.n else None,
                wanted,
                None if wanted is None else _share(joint[place]),
            )
        )
    widest = max(spreads, key=lambda spread: float(spread.mean()))
    return Forecast(len(sample.lives), made, _coverage(widest, seed), studies.false_alarms())


def by_people(
    sample: Sample,
    scatters: Sequence[Scatter],
    *,
    test: str = "sign_flip",
    correction: str = "holm",
    sizes: Sequence[int] = PEOPLE,
    seed: int = 0,
) -> dict[int, Simulated | None]:
    """The detectable difference of the method that scatters most by the number of people, who are met as these are."""
    widest = max(scatters, key=lambda scatter: float(sample.spread(scatter).mean()))
    found = {}
    for people in sizes:
        spread = sample.of_size(people).spread(widest)
        found[people] = _Studies.draw(
            [spread] * len(scatters), test, correction, seed, studies=STUDIES // 4
        ).detectable(0)
    return found


def _coverage(spread: Floats, seed: int) -> dict[str, Simulated]:
    if len(spread) < FEWEST:
        return {}
    found = {}
    for name in ("normal", "skewed"):
        drawn = _Studies.draw([spread], "t", "none", seed + 1, skewed=name == "skewed").null[0]
        intervals = [mean_over_people(one) for one in drawn.tolist()]
        held = [one.low is not None and one.high is not None and one.low <= 0 <= one.high for one in intervals]
        found[name] = _share(np.mean(held))
    return found


def _share(value: float | np.floating[np.typing.NBitBase]) -> Simulated:
    share = float(value)
    return Simulated(share, (share * (1 - share) / STUDIES) ** 0.5)
