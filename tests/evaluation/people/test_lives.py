from __future__ import annotations

from coopera.evaluation.people.lives import hold_out
from tests.evaluation.people.lived import day


def test_each_home_is_held_out_in_turn() -> None:
    days = [day("ann", scene, number, does=["rest"]) for number, scene in enumerate("xyx")]
    held_out = hold_out(days)
    assert held_out.unseen == "home"
    assert held_out.folds == [([0, 2], [1]), ([1], [0, 2])]


def test_a_day_with_the_same_draws_in_another_home_is_never_learned_from() -> None:
    days = [day("ann", scene, number, does=["rest"]) for scene in "xy" for number in (0, 1)]
    assert hold_out(days).folds == [([0], [3]), ([1], [2]), ([2], [1]), ([3], [0])]


def test_homes_with_seeds_of_their_own_are_held_out_whole() -> None:
    days = [day("ann", scene, number, seed=ord(scene), does=["rest"]) for scene in "xy" for number in (0, 1)]
    assert hold_out(days).folds == [([0, 1], [2, 3]), ([2, 3], [0, 1])]


def test_in_one_home_days_are_held_out_by_number() -> None:
    days = [day(person, "x", number, does=["rest"]) for person in ("ann", "bob") for number in (0, 1)]
    held_out = hold_out(days)
    assert held_out.unseen == "day"
    assert held_out.folds == [([0, 2], [1, 3]), ([1, 3], [0, 2])]


def test_a_single_day_cannot_be_held_out() -> None:
    assert hold_out([day("ann", does=["rest"])]).folds == []
