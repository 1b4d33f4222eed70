from __future__ import annotations

import pytest

from coopera.evaluation.robot.differences import Offer, Pair, pairs_of, patterns_of
from coopera.report.differing import as_data, as_page, pair_rows


def offer(text: str, *said: bool | None) -> Offer:
    names = ("predicate", "judge", "people", "similar")
    return Offer(0, 9, text, "They need it", True, "Rest", ["lie down"], dict(zip(names, said, strict=False)))


OFFERS = [
    offer("bring the pillow", True, True, True),
    offer("bring the pillow", False, True, True),
    offer("bring the blanket", False, True, True),
    offer("bring the wine bottle", True, False, False),
    offer("bring the hammer", False, False, None),
    offer("bring the saw", False, False, False),
]


def test_two_measures_are_compared_over_the_offers_of_which_both_say_something() -> None:
    """Predicate and judge: 1 both, 1 and 2 alone, 2 neither: agreement 3/6, chance 1/3·1/2 + 2/3·1/2 = 1/2."""
    judge, people, _ = pairs_of(OFFERS)
    assert judge == Pair("predicate", "judge", both=1, only_one=1, only_other=2, neither=2)
    assert judge.agreeing == pytest.approx(0.5, abs=1e-12)
    assert judge.kappa == pytest.approx(0.0, abs=1e-12)
    assert people.offers == 5


def test_without_offers_or_with_one_answer_alone_nothing_is_claimed() -> None:
    assert pairs_of([]) == []
    assert Pair("a", "b", 0, 0, 0, 0).agreeing is None
    assert Pair("a", "b", 3, 0, 0, 0).kappa is None
    assert as_page([]) is None
    assert as_data([]) == {"offers": 0, "pairs": [], "patterns": []}


def test_offers_about_which_measures_differ_are_grouped_by_who_says_what_most_frequent_first() -> None:
    first, second = patterns_of(OFFERS)
    assert [one.offer for one in first.offers] == ["bring the pillow", "bring the blanket"]
    assert first.said == {"predicate": False, "judge": True, "people": True}
    assert [one.offer for one in second.offers] == ["bring the wine bottle"]


def test_the_page_names_examples_once_each() -> None:
    shown = as_page([*OFFERS, OFFERS[1]])
    assert shown is not None
    assert [one["count"] for one in shown["patterns"]] == [3, 1]
    assert [one.offer for one in shown["patterns"][0]["examples"]] == ["bring the pillow", "bring the blanket"]
    assert pair_rows(OFFERS)[1][0] == ["predicate, judge", "1", "1", "2", "2", "50 %", "0.000"]
