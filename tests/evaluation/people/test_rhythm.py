"""Meals, washing and dishes as shares of days; and how far sets of days are from each other."""

from __future__ import annotations

import math

import pytest

from coopera.evaluation.people.divergence import between_groups, by_chance, by_lag, divergence
from coopera.evaluation.people.figures import Figure
from coopera.evaluation.people.rhythm import dishes_done, rhythm
from tests.evaluation.people.lived import day, lives


def _named(text: str) -> str:
    return text


def _rhythm(*days: list[str]) -> dict[str, Figure]:
    lived = lives([day(f"p{at}", does=does) for at, does in enumerate(days)])
    return {figure.measure: figure for figure in rhythm(lived, _named)}


def test_days_with_a_meal_are_counted_and_all_three_take_all_three() -> None:
    found = _rhythm(["breakfast", "lunch", "dinner"], ["breakfast", "lunch"], ["wash_up", "lunch"], ["bath", "read"])
    values = {measure: figure.value for measure, figure in found.items()}
    assert values["breakfast"] == 0.5
    assert values["lunch"] == 0.75
    assert values["dinner"] == 0.25
    assert values["all three meals"] == 0.25
    assert values["washing oneself"] == 0.5
    assert (found["lunch"].n, found["lunch"].unit, found["lunch"].note) == (4, "people", "of 4 days at home")
    assert found["lunch"].low is not None


def test_dishes_count_within_two_hours_of_the_last_dinner() -> None:
    assert dishes_done([18, 19, 20], ["dinner", "read", "dishes"]) is True
    assert dishes_done([17, 18, 19, 20], ["dinner", "read", "read", "dishes"]) is False
    assert dishes_done([17, 18, 19, 20], ["dishes", "dinner", "read", "read"]) is False
    assert dishes_done([17, 18, 19], ["dinner", "dishes", "dinner"]) is None  # none can follow the last dinner
    assert dishes_done([17, 18], ["read", "dishes"]) is None


def test_days_without_a_dinner_are_in_no_share_of_dishes_and_two_people_have_no_interval() -> None:
    measure = "dishes within 2 h of dinner"
    found = _rhythm(["dinner", "dishes"], ["dinner", "read"])[measure]
    assert (found.value, found.low) == (0.5, None)
    assert "an interval takes 3 people" in found.note
    assert _rhythm(["read"], ["read", "dinner"])[measure].value is None


def test_days_of_the_same_doings_are_at_no_distance_and_of_other_doings_at_one() -> None:
    ann, bob = day("ann", does=["read", "tv"]), day("bob", does=["tv", "read"])
    assert divergence([ann], [bob], _named) == 0
    assert divergence([ann], [day("cyd", does=["work"])], _named) == 1
    assert math.isnan(divergence([ann], [], _named))


def test_each_group_has_its_mean_divergence_from_the_others() -> None:
    days = [day("ann", does=["read"]), day("bob", does=["read"]), day("cyd", does=["work"])]
    assert between_groups(days, lambda one: one.person, _named) == {"ann": 0.5, "bob": 0.5, "cyd": 1}
    assert math.isnan(between_groups(days[:1], lambda one: one.person, _named)["ann"])


def test_halves_of_equal_days_are_at_no_distance_and_a_single_day_has_no_halves() -> None:
    assert by_chance([day("ann", number=n, does=["read", "tv"]) for n in range(5)], _named) == 0
    mixed = [day("ann", number=n, does=["read" if n % 2 else "tv"]) for n in range(4)]
    assert 0 < by_chance(mixed, _named) < 1
    with pytest.raises(ValueError, match="at least two days"):
        by_chance(mixed[:1], _named)


def test_a_rhythm_of_the_week_shows_at_a_lag_of_seven_days_within_a_life_alone() -> None:
    days = [day("ann", number=n, does=["rest" if n % 7 == 6 else f"work {n % 7}"]) for n in range(14)]
    days += [day("bob", number=7, does=["nothing"])]
    lags = by_lag(days, [1, 7, 30], _named)
    assert lags[1] == 1
    assert lags[7] == 0
    assert math.isnan(lags[30])
