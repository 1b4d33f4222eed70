"""From scores to P(yes): how sure, and where to say yes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

_SHARES = np.arange(1.0, 2.51, 0.125)
"""Shares of yes to try, in multiples of the share of yes among the labels."""
_USUAL_SHARE = 1.75
_FLATTEST, _STEEPEST = 0.05, 20.0
_NOISE = 1e-6
"""Scores that differ by less than this, or by this share of the largest, differ by rounding alone."""


class Scale(NamedTuple):
    """P(yes) = 1 / (1 + exp(-slope x (score - threshold)))."""

    slope: float
    threshold: float

    def probabilities(self, scores: Floats) -> Floats:
        """Return P(yes) per score, shape as given; 0.5 exactly at the threshold."""
        depth = np.clip(self.slope * (scores - self.threshold), -30.0, 30.0)
        probabilities: Floats = 1.0 / (1.0 + np.exp(-depth))
        return probabilities

    def within(self, scores: Floats) -> Scale:
        """Return the scale with its threshold where some of these scores, shape (n,), get a yes and others a no.

        A threshold from a few held-out examples may lie beyond all that the whole model says. Scores that do not
        differ are all undecided.
        """
        return self._replace(threshold=min(max(self.threshold, score_at(scores, 1.0)), float(scores.max())))


def scale(scores: Floats, labels: npt.NDArray[np.bool_], *, days: int) -> Scale:
    """Choose slope and threshold from scores of examples that the model had not learned from.

    The slope is Platt's. The threshold serves F1: yes is rare, and F1 then wants more yes than equal odds give. So 0.5
    is the place to decide, and P(yes) is calibrated up to this shift. In trials with simulated people the F1-best
    threshold on a few days of feedback was mostly chance. Yes to 1.5 to 2 times the share of true ones was hard to
    beat. So the search stays within 1 to 2.5 times that share. One day alone decides nothing: hardly anything happens
    twice on it, and held-out examples of the day do not predict tomorrow.

    Args:
        scores: Shape (n,); higher means yes.
        labels: Shape (n,); both labels occur.
        days: How many days the examples are from.
    """
    share = best_share(scores, labels, days=days)
    return Scale(_platt_slope(scores, labels), score_at(scores, share * float(labels.mean())))


def best_share(scores: Floats, labels: npt.NDArray[np.bool_], *, days: int) -> float:
    """Return how often to say yes, in multiples of the share of yes among the labels; see `scale`."""
    shares = _SHARES if days > 1 else np.array([_USUAL_SHARE])
    base = float(labels.mean())
    tried = [(_f1_at(scores, labels, share * base), -abs(share - _USUAL_SHARE), float(share)) for share in shares]
    return max(tried)[2]


def score_at(scores: Floats, share: float) -> float:
    """Return the score that this share of all scores reaches; where scores differ, the lowest never reaches it."""
    higher = scores[scores > scores.min() + _noise(scores)]
    least = float(higher.min()) if len(higher) else float(scores.min())
    return max(float(np.quantile(scores, max(0.0, 1.0 - share))), least)


def _noise(scores: Floats) -> float:
    """Return by how much scores may differ through rounding alone."""
    return _NOISE * max(1.0, float(np.abs(scores).max()))


def _f1_at(scores: Floats, labels: npt.NDArray[np.bool_], share: float) -> float:
    yes = scores >= score_at(scores, share)
    return float(2 * (yes & labels).sum() / (yes.sum() + labels.sum()))


def _platt_slope(scores: Floats, labels: npt.NDArray[np.bool_]) -> float:
    """Return the slope of a logistic regression of the label on the score, kept positive and within bounds.

    A score without any skill, or without any difference but rounding, gives the flattest slope: all probabilities
    close to 0.5, in the score's order. The steepest keeps a few examples from making probabilities of 0 and 1, since
    other examples may lie much further apart than those few.
    """
    spread = float(scores.std())
    if spread <= _noise(scores):
        return _FLATTEST
    return min(max(_logistic_slope(scores / spread, labels.astype(float)), _FLATTEST) / spread, _STEEPEST)


def _logistic_slope(x: Floats, y: Floats) -> float:
    """Return the slope of a logistic regression with a ridge of 0.1, shapes (n,), labels 0 and 1.

    The same steps as scikit-learn's `LogisticRegression(C=10)`, down to rounding, without the half second of its
    import: the solver is SciPy's there, too.
    """
    from scipy.optimize import minimize  # noqa: PLC0415 - heavy
    from scipy.special import expit  # noqa: PLC0415

    ridge = 1.0 / (10.0 * len(x))

    def loss(at: Floats) -> tuple[float, Floats]:
        raw = x * at[0] + at[1]
        off = (expit(raw) - y) / len(x)
        value = float((np.logaddexp(0.0, raw) - y * raw).sum()) / len(x) + 0.5 * ridge * float(at[0]) ** 2
        return value, np.array([x @ off + ridge * at[0], off.sum()])

    options = {"maxiter": 100, "maxls": 50, "gtol": 1e-4, "ftol": 64 * np.finfo(float).eps}
    found = minimize(loss, np.zeros(2), method="L-BFGS-B", jac=True, options=options)
    return float(found.x[0])
