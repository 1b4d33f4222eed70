"""Are people diverse, and do their days show who they are? (PAPER §4.2, Diverse Humans; Psychometrics Coherence)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coopera.core.people import TRAITS, BigFive, PersonId
from coopera.evaluation.people.figures import Figure, unmeasured
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.lives import Lives
from coopera.evaluation.statistics import bootstrap

_COHERENCE = ("aligned", "mismatched", "aligned, pooled", "mismatched, pooled")
_FEWEST = 3  # people of whom a correlation says anything at all


def diversity(lives: Lives, *, seed: int = 0) -> list[Figure]:
    """Mean over the traits of the sample standard deviation over the people (PAPER: above 0.7-0.9 of real people)."""
    people = [lives.personas[person].big_five for person in lives.people]
    if len(people) < 2:
        return unmeasured("diverse", "SD", why="it takes at least two people to differ")
    interval = bootstrap(people, mean_sd, seed=seed)
    return [
        Figure(
            check="diverse",
            measure="SD",
            value=interval.mean,
            low=interval.low,
            high=interval.high,
            n=len(people),
            unit="people",
            note="resamples repeat people, so the interval lies low",
        )
    ]


def mean_sd(people: Sequence[BigFive]) -> float:
    """Mean over the five traits of the sample standard deviation (n - 1)."""
    return float(_scores(people).std(axis=0, ddof=1).mean())


class Pair(NamedTuple):
    """What a robot believes of a person, and what is true of that person (or, mismatched, of another)."""

    believed: Floats
    true: Floats


def coherence(lives: Lives, *, seed: int = 0) -> list[Figure]:
    """Pearson correlation of inferred and true Big Five: each with their own, and one step mismatched.

    `aligned` and `mismatched` are the mean over the traits of the correlation over people; nothing is gained there by
    knowing only what people are like on average. `pooled` takes all traits of all people as one sample. The paper does
    not say which it reports. What several robots came to believe of a person is averaged. The control of the
    mismatch is its mean over all steps.
    """
    beliefs: dict[PersonId, list[BigFive]] = {}
    for belief in lives.beliefs:
        beliefs.setdefault(belief.person, []).append(belief.big_five)
    if not beliefs:
        return unmeasured("coherent", *_COHERENCE, why="no robot in these runs has inferred traits")
    if len(beliefs) < _FEWEST:
        return unmeasured("coherent", *_COHERENCE, why=f"it takes at least {_FEWEST} people to correlate")
    people = sorted(beliefs)
    believed = [_scores(beliefs[person]).mean(axis=0) for person in people]
    true = list(_scores([lives.personas[person].big_five for person in people]))
    figures = []
    for suffix, statistic in (("", by_trait), (", pooled", pooled)):
        steps = [[Pair(b, true[(at + step) % len(true)]) for at, b in enumerate(believed)] for step in range(len(true))]
        for name, pairs in (("aligned", steps[0]), ("mismatched", steps[1])):
            interval = bootstrap(pairs, statistic, seed=seed)
            others = [r for step in steps[1:] if not np.isnan(r := statistic(step))] if name == "mismatched" else []
            figures.append(
                Figure(
                    check="coherent",
                    measure=name + suffix,
                    value=_finite(interval.mean),
                    low=_finite(interval.low),
                    high=_finite(interval.high),
                    n=len(people),
                    unit="people",
                    control=float(np.mean(others)) if others else None,
                    control_is="mean over all steps" if others else "",
                    note=f"{len(lives.beliefs)} robots" if not np.isnan(interval.mean) else "no trait varies",
                )
            )
    return figures


def by_trait(pairs: Sequence[Pair]) -> float:
    """Mean over the traits of Pearson's r over people; a trait that does not vary is left out, nan if none does."""
    believed, true = np.stack([p.believed for p in pairs]), np.stack([p.true for p in pairs])
    found = [pearson(believed[:, trait], true[:, trait]) for trait in range(believed.shape[1])]
    known = [r for r in found if not np.isnan(r)]
    return float(np.mean(known)) if known else float("nan")


def pooled(pairs: Sequence[Pair]) -> float:
    """Pearson's r over all traits of all people together."""
    return pearson(np.concatenate([p.believed for p in pairs]), np.concatenate([p.true for p in pairs]))


def pearson(one: Floats, other: Floats) -> float:
    """Pearson's r of two samples of one length; nan where either does not vary."""
    a, b = one - one.mean(), other - other.mean()
    norm = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / norm if norm > 1e-12 else float("nan")


def _scores(people: Sequence[BigFive]) -> Floats:
    return np.array([[getattr(person, trait) for trait in TRAITS] for person in people], dtype=np.float64)


def _finite(value: float) -> float | None:
    return None if np.isnan(value) else value
