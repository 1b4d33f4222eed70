"""After one, two or three hours of feedback, of one kind or of both, the kernel never says the same to everything."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coopera.core.hour import Example
from coopera.evaluation.methods import find_method
from coopera.graphs.robots.learning import KINDS, Learner
from coopera.graphs.robots.verdicts import judge
from coopera.models.classifiers.calibration import Scale, scale, score_at
from tests.fakes import FolderRecorder
from tests.models.classifiers.feedback import THINGS, kernel
from tests.models.classifiers.few import BOTH, chances, lived, never_constant, tea
from tests.models.classifiers.few import undecided_without_a_difference as undecided

PRIORS = [0.5, 0.3, 0.2, 0.1, 0.05]


@pytest.mark.parametrize("case", BOTH)
def test_it_says_yes_to_some_and_no_to_others(case: str) -> None:
    never_constant(kernel, case)


def test_one_kind_of_answer_and_answers_that_contradict_each_other_decide_nothing() -> None:
    undecided(kernel)


@pytest.mark.parametrize("hours", [1, 2, 3])
def test_what_was_liked_comes_first_in_each_hour(hours: int) -> None:
    said = chances(kernel, lived(hours, tea))
    for first in range(0, len(said), len(THINGS)):
        assert said[first] == max(said[first : first + len(THINGS)])
    assert len(set(said)) > 2, "the order is kept"


def test_a_slope_is_not_made_of_rounding() -> None:
    """Held-out scores that differ in the sixteenth place made 0 and 1 of all later ones."""
    noise = np.array([1e-16, -2e-16, 0.0, 3e-16, -1e-16])
    chosen = scale(noise, np.array([True, False, False, False, False]), days=1)
    assert chosen.slope < 0.1
    wide = scale(np.array([1e-4, 0.0, 0.0, 0.0, -1e-4]), np.array([True, False, False, False, False]), days=1)
    assert wide.slope <= 20.0


def test_a_threshold_lies_where_somebody_gets_a_no_and_somebody_a_yes() -> None:
    scores = np.array([-0.4, -0.3, 0.1, 0.6])
    for threshold in (-9.0, 0.0, 9.0):
        yes = Scale(1.0, threshold).within(scores).probabilities(scores) >= 0.5
        assert 0 < yes.sum() < 4
    assert Scale(1.0, 0.0).within(scores) == Scale(1.0, 0.0)
    assert (scores >= score_at(scores, 1.0)).sum() == 3
    assert (Scale(1.0, 9.0).within(np.zeros(3)).probabilities(np.zeros(3)) == 0.5).all()


def with_priors(hours: int, likes: object = tea) -> list[Example]:
    """As `ours` has them: with what it believed before."""
    return lived(hours, likes, rank=[0, 1, 2, 3, 4], evidence=[{"prior": p} for p in PRIORS])  # type: ignore[arg-type]


@pytest.mark.parametrize("hours", [1, 2, 3])
def test_with_priors_a_few_answers_move_the_chances_and_keep_their_order(hours: int) -> None:
    said = chances(kernel, with_priors(hours))[:5]
    assert said == sorted(said, reverse=True)
    assert len(set(said)) == 5
    assert all(0.01 < p < 0.99 for p in said)
    assert said[0] >= 0.15 > said[-1], "the likeliest goes on by the bar of intentions, the least likely does not"


@pytest.mark.parametrize("likes", [True, False])
def test_after_answers_of_one_kind_ours_goes_by_its_first_guess(tmp_path: Path, likes: bool) -> None:
    trained = kernel()
    trained.train(with_priors(2, lambda *_: likes), seed=0)
    pupil = Learner(dict.fromkeys(KINDS, kernel), FolderRecorder(tmp_path))  # type: ignore[arg-type]
    pupil.classifiers["intention"] = trained
    said = judge(find_method("ours"), pupil, "intention", with_priors(1))
    assert said.probabilities == PRIORS
    assert said.accepted == [True, False, False, False, False]
