"""From scores and counts to P(yes): a logistic regression that starts from what the robot believed already.

The prior of each example (`Example.evidence`) is the offset: without any lesson, and after a single day, P(yes) is the
prior. What was learned from feedback (the score), and the counts of what was told, move it as far as feedback bears
them out. A ridge holds each weight near 0. P(yes) is calibrated: nothing shifts it to a threshold.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coopera.core.hour import Example

Floats = npt.NDArray[np.float64]

COUNTS = ("prior", "told", "sight", "hour")
"""Shares that enter as log-odds. How much they rest on grows from day to day, so no weight can be learned for it."""
HOLD = 3.0
"""Ridge on each weight, for features of unit spread."""
FIRST_WEIGHTS, FIRST_SCORE = 2, 3
"""Days from which weights are learned at all, and one for the score: a score from one day says little of another."""
BIASES = 2
_STEPS = 30


class Blend(NamedTuple):
    """P(yes) = sigmoid(logit(prior) + ((features - mean) / spread) @ weights + bias @ shifts).

    See `features_of` and `bias_of`.
    """

    shifts: tuple[float, ...]
    mean: tuple[float, ...]
    spread: tuple[float, ...]
    weights: tuple[float, ...]

    def probabilities(self, scores: Floats, examples: Sequence[Example]) -> Floats:
        """Return P(yes) per example, shape (n,); each has evidence."""
        features, offset = features_of(scores, examples)
        x = (features - np.array(self.mean)) / np.array(self.spread)
        chances: Floats = _sigmoid(offset + x @ np.array(self.weights) + bias_of(examples) @ np.array(self.shifts))
        return chances


def read_blend(given: Mapping[str, Any]) -> Blend:
    """Return a blend from its fields as JSON has them.

    Raises:
        KeyError, TypeError, ValueError: If they are none.
    """
    shifts, *of_features = (tuple(float(n) for n in given[name]) for name in Blend._fields)
    if {len(one) for one in of_features} != {1 + len(COUNTS)} or len(shifts) != BIASES:
        raise ValueError("the blend has not one number per feature")
    mean, spread, weights = of_features
    return Blend(shifts, mean, spread, weights)


def features_of(scores: Floats, examples: Sequence[Example]) -> tuple[Floats, Floats]:
    """Return what the blend reads, shape (n, 1 + counts), and the prior's log-odds, shape (n,).

    A share that an example lacks, as an intention has no `sight`, counts as even.
    """
    odds = [[_logit(e.evidence.get(name, 0.5)) for name in COUNTS] for e in examples]
    log_odds = np.array(odds, np.float64).reshape(len(examples), len(COUNTS))
    return np.column_stack([scores, log_odds]), log_odds[:, 0]


def bias_of(examples: Sequence[Example]) -> Floats:
    """Return how far each example rests on common sense alone, and how far on what was told; shape (n, 2), sums to 1.

    Each part has a shift of its own: that common sense was too hopeful on the first day says nothing of the next,
    when the robot has been told something.
    """
    alone = np.exp(-np.array([e.evidence.get("support", 0.0) for e in examples], np.float64))
    return np.column_stack([alone, 1.0 - alone])


def blend(scores: Floats, examples: Sequence[Example], labels: npt.NDArray[np.bool_]) -> Blend:
    """Fit by Newton's method; the penalised likelihood has one maximum.

    Args:
        scores: Of examples that the score had not learned from, shape (n,).
        examples: The same, each with evidence; at least one.
        labels: Shape (n,); one label alone will do.
    """
    days = len({e.day for e in examples})
    features, offset = features_of(scores if days >= FIRST_SCORE else np.zeros_like(scores), examples)
    mean, spread = features.mean(axis=0), features.std(axis=0)
    spread = np.where(spread > 1e-6, spread, 1.0)
    x = np.column_stack([bias_of(examples), (features - mean) / spread])
    counts = np.array([e.counts for e in examples], np.float64)
    hold = np.diag([*[2 * HOLD] * BIASES, *[HOLD] * (x.shape[1] - BIASES)])
    weights = np.zeros(x.shape[1])
    for _ in range(_STEPS if days >= FIRST_WEIGHTS else 0):
        chance = _sigmoid(offset + x @ weights)
        slope = x.T @ (counts * (labels - chance)) - hold @ weights
        bend = (x * (counts * chance * (1 - chance))[:, None]).T @ x + hold
        step = np.linalg.solve(bend, slope)
        weights = weights + step * min(1.0, 2.0 / max(float(np.abs(step).max()), 1e-12))
    shifts, learned = weights[:BIASES].tolist(), weights[BIASES:].tolist()
    return Blend(tuple(shifts), tuple(mean.tolist()), tuple(spread.tolist()), tuple(learned))


def _logit(p: float) -> float:
    return float(np.log(p) - np.log1p(-p))


def _sigmoid(x: Floats) -> Floats:
    chance: Floats = 1.0 / (1.0 + np.exp(-np.clip(x, -30.0, 30.0)))
    return chance
