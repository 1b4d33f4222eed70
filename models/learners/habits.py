"""What a person does when: counts from the first day on, and what is learned on top of them once it foretells better.

Which of them speaks is chosen each time on days held out, and not by a number of days.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

from coopera.models.learners.counts import (
    TINY,
    Bools,
    Counts,
    Floats,
    Ints,
    Observations,
    Rates,
    log_odds,
    probability,
)
from coopera.models.learners.fading import HAZARD, REMNANT, Fading

Model = Callable[[Floats], Floats]

FOLDS = 5
_FIRST_THRESHOLD = 0.25
"""F1 is best where yes is said above half of the F1 reached (Lipton et al. 2014), and some 0.5 is reached at first."""
_THRESHOLDS = np.arange(0.15, 0.51, 0.025)
TEMPER = 0.3
"""What a day's log-likelihood counts for a change: what is observed in an hour hangs together, so rows say less."""
_SEED = 0  # only splits held-out rows within boosting, which is switched off: nothing here is random


@dataclass(frozen=True, slots=True)
class Chosen:
    """What held-out days decided.

    Attributes:
        name: "counts"; or "learned", counts with a logistic regression and boosted trees on top of them.
        threshold: P(yes) from which to say yes, for the best F1.
        losses: Mean negative log-likelihood on held-out days, in nats per observation, by name; empty where there was
            one day only.
    """

    name: str
    threshold: float
    losses: dict[str, float]


class Habits:
    """P(a thing is used now), from counts and what is learned on top of them.

    Attributes:
        chosen: What speaks, and from where on it says yes.
        fading: How much each day still counts.
    """

    def __init__(self, *, hazard: float = HAZARD) -> None:
        """Start with nothing learned; everything is then improbable."""
        self._hazard = hazard
        self.chosen = Chosen("counts", _FIRST_THRESHOLD, {})
        self.fading = Fading(hazard=hazard)
        self._counts: Counts | None = None
        self._fitted: list[Model] = []

    def train(self, seen: Observations) -> None:
        """Learn anew from all that was observed."""
        if not len(seen):
            return
        self.fading = faded(seen, hazard=self._hazard)
        weights = self.fading.of(seen.day)
        self.chosen = _choose(seen, weights)
        self._counts = Counts(seen, weights)
        self._fitted = [] if self.chosen.name == "counts" else _fit(seen, weights)

    def probabilities(self, asked: Observations) -> Floats:
        """Return P(yes) of each observation, shape (n,), in (0, 1)."""
        if self._counts is None:
            return np.full(len(asked), TINY)
        return _speak(self._fitted, self._counts.rates(asked), asked)[self.chosen.name]

    def says_yes(self, asked: Observations) -> Bools:
        """Return whether each thing is expected, shape (n,)."""
        yes: Bools = self.probabilities(asked) >= self.chosen.threshold
        return yes


def faded(seen: Observations, *, hazard: float = HAZARD, temper: float = TEMPER) -> Fading:
    """Find how much each day still counts, from how well counts since each day foretold the days after.

    Foretelling uses the mean rate of the single contexts; see `Fading`.
    """
    fading = Fading(hazard=hazard)
    days = int(seen.day.max()) + 1
    summed = [_by_day(seen, column, days) for column in range(seen.contexts.shape[1])]
    for day in range(1, days):
        fading.begin(day)
        today = seen.day == day
        label = seen.label[today]
        if not len(label):
            continue
        foretold = np.zeros((len(fading.starts), len(label)))
        for place, yes, met in summed:
            at = place[today]
            starts = np.array(fading.starts)
            since_yes = yes[day][at] - (1 - REMNANT) * yes[starts][:, at]
            since_met = met[day][at] - (1 - REMNANT) * met[starts][:, at]
            foretold += (since_yes + 0.05) / (since_met + 1.0)
        chance = np.clip(foretold / len(summed), TINY, 1 - TINY)
        fading.learn(temper * np.where(label, np.log(chance), np.log1p(-chance)).sum(1))
    return fading


def _by_day(seen: Observations, column: int, days: int) -> tuple[Ints, Floats, Floats]:
    """Return each row's key, and the counts of yes and of all before each day, (days + 1, keys)."""
    things = int(seen.thing.max()) + 1
    names, place = np.unique(seen.contexts[:, column] * things + seen.thing, return_inverse=True)
    of_day, size = (seen.day + 1) * len(names) + place, (days + 1) * len(names)
    yes, met = (np.bincount(of_day, counted, size).reshape(days + 1, -1) for counted in (seen.label, None))
    return place, yes.cumsum(0), met.cumsum(0)


def _choose(seen: Observations, weights: Floats) -> Chosen:
    """Choose what speaks by the likelihood of held-out days, and the threshold by their F1."""
    days = np.unique(seen.day)
    if len(days) < 2:
        return Chosen("counts", _FIRST_THRESHOLD, {})
    unseen: dict[str, Floats] = {}
    complete = True
    for fold in range(min(FOLDS, len(days))):
        out = np.isin(seen.day, days[fold::FOLDS])
        rest, asked = seen.take(~out), seen.take(out)
        said = _speak(_fit(rest, weights[~out]), Counts(rest, weights[~out]).rates(asked), asked)
        complete &= len(said) > 1
        for name, chance in said.items():
            unseen.setdefault(name, np.zeros(len(seen)))[out] = chance
    losses = {
        name: _loss(chance, seen.label, weights) for name, chance in unseen.items() if complete or name == "counts"
    }
    name = min(losses, key=lambda one: losses[one])
    return Chosen(name, _threshold(unseen[name], seen.label, weights), losses)


def _speak(fitted: Sequence[Model], rates: Rates, asked: Observations) -> dict[str, Floats]:
    """Return P(yes) by counts, and by the mean log-odds of counts and of what is fitted on top of them.

    What is fitted does not speak without counts: at like thresholds its F1 on later days was seldom higher.
    """
    said = {"counts": rates.probabilities}
    if fitted:
        given = features(rates, asked)
        odds = [log_odds(model(given)) for model in fitted]
        said["learned"] = probability(np.mean([*odds, log_odds(rates.probabilities)], axis=0))
    return said


def features(rates: Rates, asked: Observations) -> Floats:
    """Return what is learned from, shape (n, m): rates, their log-odds and evidence, expected uses, the numbers."""
    shares = rates.shares
    parts = [shares, log_odds(shares), np.log1p(rates.evidence), rates.before[:, None], rates.after[:, None]]
    return np.hstack([*parts, asked.numbers])


def _fit(seen: Observations, weights: Floats) -> list[Model]:
    """Fit what is learned on top of counts; nothing where there is one day only, or one label."""
    if len(np.unique(seen.day)) < 2 or seen.label.all() or not seen.label.any():
        return []
    given = features(Counts(seen, weights).rates(seen, own_day=False), seen)
    return [_logistic(given, seen.label, weights), _boosted(given, seen.label, weights)]


def _one_thread() -> Any:
    """Compute on one thread: sums then have one order, and small trees are not held up by other cores."""
    return threadpool_limits(limits=1)


def _logistic(given: Floats, label: Bools, weights: Floats) -> Model:
    from sklearn.linear_model import LogisticRegression  # noqa: PLC0415 - heavy

    centre, spread = given.mean(0), np.maximum(given.std(0), 0.1)

    def scaled(rows: Floats) -> Floats:
        found: Floats = np.clip((rows - centre) / spread, -5.0, 5.0)
        return found

    with _one_thread():
        model = LogisticRegression(C=0.1, max_iter=300).fit(scaled(given), label, weights)
    return lambda asked: np.asarray(model.predict_proba(scaled(asked))[:, 1])


def _boosted(given: Floats, label: Bools, weights: Floats) -> Model:
    from sklearn.ensemble import HistGradientBoostingClassifier  # noqa: PLC0415 - heavy

    model = HistGradientBoostingClassifier(
        max_iter=150,
        learning_rate=0.05,
        max_leaf_nodes=8,
        min_samples_leaf=20,
        l2_regularization=5.0,
        early_stopping=False,
        random_state=_SEED,
    )
    with _one_thread():
        model.fit(given, label, weights)

    def chance(asked: Floats) -> Floats:
        with _one_thread():
            return np.asarray(model.predict_proba(asked)[:, 1])

    return chance


def _loss(chance: Floats, label: Bools, weights: Floats) -> float:
    nats = -np.where(label, np.log(chance), np.log1p(-chance))
    return float((weights * nats).sum() / weights.sum())


def _threshold(chance: Floats, label: Bools, weights: Floats) -> float:
    """Return the threshold of the best F1; of equals the one nearest to half of it."""
    scores = []
    for threshold in _THRESHOLDS:
        yes = chance >= threshold
        both = (weights * (yes & label)).sum()
        scores.append(float(2 * both / max((weights * yes).sum() + (weights * label).sum(), 1e-9)))
    best = max(scores)
    return float(min(zip(_THRESHOLDS, scores, strict=True), key=lambda one: (-one[1], abs(one[0] - best / 2)))[0])
