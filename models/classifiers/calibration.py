"""From scores to P(yes): how sure, and where to say yes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

_SHARES = np.arange(1.0, 2.51, 0.125)
"""Shares of yes to try, in multiples of the share of yes among the labels."""
_USUAL_SHARE = 1.75
_STEEPEST = 20.0


class Scale(NamedTuple):
    """P(yes) = 1 / (1 + exp(-slope x (score - threshold)))."""

    slope: float
    threshold: float

    def probabilities(self, scores: Floats) -> Floats:
        """Return P(yes) per score, shape as given; 0.5 exactly at the threshold."""
        depth = np.clip(self.slope * (scores - self.threshold), -30.0, 30.0)
        probabilities: Floats = 1.0 / (1.0 + np.exp(-depth))
        return probabilities


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
    """Return the score that this share of all scores reaches."""
    return float(np.quantile(scores, max(0.0, 1.0 - share)))


def _f1_at(scores: Floats, labels: npt.NDArray[np.bool_], share: float) -> float:
    yes = scores >= score_at(scores, share)
    return float(2 * (yes & labels).sum() / (yes.sum() + labels.sum()))


def _platt_slope(scores: Floats, labels: npt.NDArray[np.bool_]) -> float:
    """Return the slope of a logistic regression of the label on the score, kept positive and finite.

    A score without any skill gives the smallest slope: all probabilities close to 0.5, in the score's order.
    """
    from sklearn.linear_model import LogisticRegression  # noqa: PLC0415 - heavy

    spread = float(scores.std()) or 1.0
    fitted = LogisticRegression(C=10.0).fit(scores[:, None] / spread, labels)
    return float(np.clip(fitted.coef_[0, 0], 0.05, _STEEPEST)) / spread
