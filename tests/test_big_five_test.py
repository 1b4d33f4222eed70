"""The 50-item test against hand arithmetic, and the vote."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.big_five_test import ITEMS, score, vote
from coopera.core.people import TRAITS, BigFive

ANSWERS = st.lists(st.integers(1, 5), min_size=50, max_size=50)


def test_the_formula_is_the_published_one() -> None:
    answers = list(range(1, 51))  # item n is answered n, for the arithmetic only
    constants = {"extroversion": 20, "agreeableness": 14, "conscientiousness": 14, "neuroticism": 2, "openness": 8}
    published = {
        "extroversion": 1 - 6 + 11 - 16 + 21 - 26 + 31 - 36 + 41 - 46,
        "agreeableness": -2 + 7 - 12 + 17 - 22 + 27 - 32 + 37 + 42 + 47,
        "conscientiousness": 3 - 8 + 13 - 18 + 23 - 28 + 33 - 38 + 43 + 48,
        # emotional stability is 38 less these items, and neuroticism 40 less that
        "neuroticism": 4 - 9 + 14 - 19 + 24 + 29 + 34 + 39 + 44 + 49,
        "openness": 5 - 10 + 15 - 20 + 25 - 30 + 35 + 40 + 45 + 50,
    }
    for trait in TRAITS:
        ours = sum(item.sign * answer for item, answer in zip(ITEMS, answers, strict=True) if item.trait == trait)
        assert ours == published[trait]
        zero = [1 if item.sign > 0 else 5 for item in ITEMS]  # the least of every trait is 1.0
        assert getattr(score(zero), trait) == 1.0
        least = sum(item.sign * a for item, a in zip(ITEMS, zero, strict=True) if item.trait == trait)
        assert least == -constants[trait]


def test_all_threes_are_the_middle_of_every_scale() -> None:
    assert score([3] * 50) == BigFive()


@given(ANSWERS)
def test_any_answers_are_on_the_scale_in_tenths(answers: list[int]) -> None:
    for value in score(answers).model_dump().values():
        assert 1 <= value <= 5
        assert round(value * 10) == pytest.approx(value * 10)


@pytest.mark.parametrize("answers", [[], [3] * 49, [3] * 49 + [6], [0] * 50])
def test_other_answers_are_refused(answers: list[int]) -> None:
    with pytest.raises(ValueError, match="50 answers"):
        score(answers)


@pytest.mark.parametrize(
    ("readings", "elected"),
    [
        ([3.1, 2.9, 3.2, 4.6, 4.9], 3.0),  # bins 3.0, 3.0, 3.0, 4.5, 5.0
        ([1.0, 1.0, 5.0, 5.0, 4.0], 5.0),  # two against two: the mean is 3.2, nearer to 5.0 than to 1.0
        ([2.0, 3.0], 2.0),  # as near to either: the lower
        ([2.25], 2.5),  # the edge of a bin belongs to the higher
        ([4.74, 4.76], 4.5),  # bins 4.5 and 5.0, the mean 4.75 as near to either
    ],
)
def test_the_bin_with_most_votes_is_elected(readings: list[float], elected: float) -> None:
    assert vote([BigFive(openness=reading) for reading in readings]).openness == elected


def test_a_vote_of_nobody_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one"):
        vote([])


@given(st.lists(st.floats(1, 5), min_size=1, max_size=10), st.randoms())
def test_the_order_of_votes_does_not_matter(readings: list[float], random: object) -> None:
    people = [BigFive(openness=reading) for reading in readings]
    shuffled = list(people)
    random.shuffle(shuffled)  # type: ignore[attr-defined]
    assert vote(people) == vote(shuffled)
