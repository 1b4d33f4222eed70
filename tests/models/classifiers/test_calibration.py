from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from sklearn.linear_model import LogisticRegression

from coopera.models.classifiers.calibration import Scale, best_share, scale, score_at


def test_the_slope_is_that_of_scikit_learns_logistic_regression() -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        scores = rng.normal(size=60)
        labels = scores * rng.uniform(0.5, 2) + rng.normal(size=60) > 0.3
        known = LogisticRegression(C=10.0).fit(scores[:, None] / scores.std(), labels).coef_[0, 0]
        assert np.isclose(scale(scores, labels, days=2).slope, known / scores.std(), rtol=1e-9)


def test_a_score_at_the_threshold_is_exactly_undecided() -> None:
    assert Scale(slope=3.0, threshold=0.7).probabilities(np.array([0.7]))[0] == 0.5


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=20))
def test_probabilities_keep_the_order_of_scores_and_their_range(scores: list[float]) -> None:
    p = Scale(slope=2.0, threshold=0.0).probabilities(np.sort(np.array(scores)))
    assert (np.diff(p) >= 0).all()
    assert p.min() >= 0
    assert p.max() <= 1


def test_the_share_of_yes_with_the_best_f1_is_chosen() -> None:
    # 2 of 8 true, ranked 1st and 4th. Yes to 2: tp 1, F1 = 2/4. Yes to 4 (share 2.0): tp 2, F1 = 4/6, the best.
    labels = np.array([True, False, False, True, False, False, False, False])
    scores = np.arange(8, 0, -1.0)
    assert best_share(scores, labels, days=3) * labels.mean() * 8 >= 3.4
    assert (scores >= score_at(scores, best_share(scores, labels, days=3) * 0.25)).sum() == 4


def test_a_single_day_is_not_searched() -> None:
    labels = np.array([True, False, False, False, False, False, False, False])
    assert best_share(np.arange(8, 0, -1.0), labels, days=1) == 1.75
    assert best_share(np.arange(8, 0, -1.0), labels, days=2) < 1.75


def test_scores_without_skill_give_answers_near_undecided() -> None:
    labels = np.arange(40) % 2 == 0
    scores = np.where(labels, -1.0, 1.0)  # wrong every time
    p = scale(scores, labels, days=2).probabilities(scores)
    assert abs(p - 0.5).max() < 0.1


def test_constant_scores_are_no_error() -> None:
    chosen = scale(np.zeros(10), np.arange(10) < 2, days=2)
    assert (chosen.probabilities(np.zeros(10)) == 0.5).all()
