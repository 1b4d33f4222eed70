from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.evaluation.people.learners import FrozenEncoder
from coopera.evaluation.people.lives import LivedDay
from coopera.evaluation.people.temporal import BEFORE, Tally, accuracy, f1, questions, temporal_dependence
from tests.evaluation.people.lived import day, lives
from tests.fakes import LetterEmbeddings

LEARNER = FrozenEncoder(LetterEmbeddings(), "letters")
WORDS = ["aaab", "bbbc", "cccd", "ddde", "eeef", "fffg", "gggh", "hhhi", "iiij", "jjjk"]


def test_accuracy_and_f1_are_as_by_hand() -> None:
    """hits 3 + 1, alarms 1 + 0, misses 0 + 2, rejections 2 + 1: accuracy 7/10, F1 = 8 / (8 + 3)."""
    units = [Tally(3, 1, 0, 2), Tally(1, 0, 2, 1)]
    assert accuracy(units) == pytest.approx(0.7, abs=1e-12)
    assert f1(units) == pytest.approx(8 / 11, abs=1e-12)
    assert np.isnan(f1([Tally(0, 0, 0, 4)]))


@given(length=st.integers(0, 16), number=st.integers(0, 50))
def test_every_candidate_is_asked_about_as_often_in_its_place_as_in_another(length: int, number: int) -> None:
    texts = [f"text {n}" for n in range(length)]
    asked = questions(day("ann", number=number, does=texts), seed=0)
    real = Counter(one.step.then for one in asked if one.real)
    other = Counter(one.step.then for one in asked if not one.real)
    assert real == other == Counter(texts[BEFORE:] if length >= BEFORE + 5 else [])
    for one in asked:
        at = texts.index(one.step.before[-1])
        assert list(one.step.before) == texts[at - 2 : at + 1]
        assert one.real == (one.step.then == texts[at + 1])
        assert one.step.then not in one.step.before


def test_days_in_which_one_thing_leads_to_the_next_are_predicted_and_shuffled_ones_are_not() -> None:
    days = [ring(person, "xy"[n % 2], n) for person in ("ann", "bob") for n in range(16)]
    share, score = temporal_dependence(lives(days), LEARNER)
    assert share.measure == "accuracy"
    assert share.value is not None
    assert share.value > 0.9
    assert score.value is not None
    assert score.value > 0.9
    assert share.n == 32 * 2 * (len(WORDS) - BEFORE)
    assert share.control == pytest.approx(0.5, abs=0.08)  # 448 answers: three standard errors


def test_short_days_and_a_single_day_are_unmeasured_with_the_reason() -> None:
    short = temporal_dependence(lives([day("ann", s, does=["a"] * 7, number=n) for n, s in enumerate("xy")]), LEARNER)
    assert [(f.value, f.note) for f in short] == [(None, "it takes days of at least 8 hours")] * 2
    assert temporal_dependence(lives([ring("ann", "x", 0)]), LEARNER)[0].value is None


def ring(person: str, scene: str, number: int) -> LivedDay:
    """Ten things that always follow each other, begun at another one each day."""
    start = number * 3 % len(WORDS)
    return day(person, scene, number, does=[*WORDS[start:], *WORDS[:start]])
