from __future__ import annotations

import pytest

from coopera.evaluation.people.distinct import distinctness
from coopera.evaluation.people.learners import FrozenEncoder
from coopera.evaluation.people.lives import LivedDay
from tests.evaluation.people.lived import day, lives
from tests.fakes import LetterEmbeddings

LEARNER = FrozenEncoder(LetterEmbeddings(), "letters")


def week(person: str, words: str, days: int = 6) -> list[LivedDay]:
    """Days in two homes with draws of their own; each hour's letters are mostly of `words`."""
    return [
        day(person, "xy"[n % 2], n, does=[words * 3 + "mno"[(n + hour) % 3] for hour in range(4)]) for n in range(days)
    ]


def test_people_with_lives_of_their_own_are_told_apart_and_shuffled_ones_are_not() -> None:
    days = [*week("ann", "aab", 20), *week("bob", "ccd", 20), *week("cyd", "eef", 20), *week("dan", "ggh", 20)]
    for figure in distinctness(lives(days), LEARNER):
        assert (figure.value, figure.low, figure.high) == (1, 1, 1)
        assert figure.n == 80
        assert figure.control == pytest.approx(0.25, abs=0.15)  # 80 days: three standard errors
        assert "4-way, chance 0.250, unseen home" in figure.note


def test_people_who_live_alike_are_at_chance() -> None:
    days = [day(p, "xy"[n % 2], n, does=["tea", "rest", "read"]) for p in ("ann", "bob") for n in range(8)]
    for figure in distinctness(lives(days), LEARNER):
        assert figure.value == pytest.approx(0.5, abs=1e-12)  # one answer for all: right for one of the two


def test_intentions_and_tasks_are_told_apart_each_by_its_own_texts() -> None:
    """Intentions are the same for both, tasks differ."""
    days = [
        day(p, "xy"[n % 2], n, does=["tea", "rest"], tasks=[word, word])
        for p, word in (("ann", "aaa"), ("bob", "zzz"))
        for n in range(6)
    ]
    intentions, tasks = distinctness(lives(days), LEARNER)
    assert intentions.value == pytest.approx(0.5, abs=1e-12)
    assert tasks.value == 1


def test_accuracy_is_counted_over_days_by_hand() -> None:
    """In the third home Bob's day reads like Ann's: 5 of 6 days are put down right, and Bob's 2 of 3."""
    days = [day(person, scene, n, does=[word])
            for person, words in (("ann", ["aaa", "aaa", "aaa"]), ("bob", ["zzz", "zzz", "aaa"]))
            for n, (scene, word) in enumerate(zip("xyv", words, strict=True))]  # fmt: skip
    figure = distinctness(lives(days), LEARNER)[0]
    assert figure.value == pytest.approx(5 / 6, abs=1e-12)
    assert (figure.low, figure.high) == (pytest.approx(2 / 3), 1)  # twice Bob, twice Ann


def test_one_person_or_one_day_is_unmeasured_with_the_reason() -> None:
    alone = distinctness(lives(week("ann", "aab")), LEARNER)
    assert [(f.value, f.note) for f in alone] == [(None, "it takes at least two people to tell apart")] * 2
    once = distinctness(lives([day("ann", does=["a"]), day("bob", does=["b"])]), LEARNER)
    assert {f.note for f in once} == {"it takes a second home, or a second day, to test on"}


def test_somebody_of_whom_only_one_day_is_known_is_left_out() -> None:
    days = [*week("ann", "aab"), *week("bob", "ccd"), day("eve", "x", 9, does=["zzz"])]
    assert distinctness(lives(days), LEARNER)[0].n == 12
