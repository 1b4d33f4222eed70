"""The rhythm of a population: a valid file, shares that sum up, and chances by the hour that give the wanted days."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coopera.core.time_use import CATEGORIES, DAY_TYPES
from coopera.models.offline.household.knowledge import FIRST, LAST, shipped
from coopera.models.offline.human.rhythm import Schedule, due_by_hour, of_day_type, shipped_rhythm

COVERED = slice(FIRST, LAST + 1)


def test_the_shipped_rhythm_says_where_it_is_from_and_covers_both_kinds_of_day() -> None:
    rhythm = shipped_rhythm()
    assert "American Time Use Survey" in rhythm.source
    assert "benchmarks.fit_time_use" in rhythm.command
    assert set(rhythm.asleep) == set(rhythm.logits) == set(DAY_TYPES)
    for logits in rhythm.logits.values():
        assert set(logits) == set(CATEGORIES) - {"other"}
    assert rhythm.category_logits.shape == (len(DAY_TYPES), len(CATEGORIES), 24)
    assert np.isfinite(rhythm.category_logits).all()


def test_schedules_are_those_of_at_most_everybody_and_of_hours_that_exist() -> None:
    schedules = shipped_rhythm().schedules
    assert 0.5 < sum(one.share for one in schedules) <= 1.0
    for one in schedules:
        assert one.days
        assert one.start < one.end
        assert one.end > FIRST
    assert len({(one.days, one.start, one.end) for one in schedules}) == len(schedules)


def test_a_schedule_covers_its_days_from_its_first_hour_until_before_its_last() -> None:
    late = Schedule(days=(4, 5), start=14, end=22)
    assert [late.covers(4, hour) for hour in (13, 14, 21, 22)] == [False, True, True, False]
    assert not late.covers(3, 15)
    assert [of_day_type(day) for day in range(7)] == [0, 0, 0, 0, 0, 1, 1]


def test_more_sleep_at_weekends_and_fewer_in_each_hour_of_the_morning() -> None:
    weekday, weekend = shipped_rhythm().morning_sleep
    assert weekend[FIRST] > weekday[FIRST] > 0
    assert all(np.diff(weekend[FIRST:13]) < 0)
    assert not weekday[:FIRST].any()


def test_a_categorys_logits_say_how_much_it_takes_and_its_activities_share_that_by_their_own_hours() -> None:
    household, rhythm = shipped(), shipped_rhythm()
    logits = rhythm.hours_of(household)
    assert logits.shape == (len(DAY_TYPES), len(household.activities), 24)
    for category in {activity.category for activity in household.activities}:
        rows = [i for i, one in enumerate(household.activities) if one.category == category and not one.daily]
        if rows:
            taken = np.exp(logits[:, rows]).sum(axis=1)
            wanted = np.exp(rhythm.category_logits[:, CATEGORIES.index(category)])
            assert np.allclose(taken[:, COVERED], wanted[:, COVERED])
    tv, sports = household.index["watch_series"], household.index["sports_tv"]
    own = household.log_hours[tv] - household.log_hours[sports]
    assert np.allclose(logits[:, tv] - logits[:, sports], own)


def _followed(due: np.ndarray) -> np.ndarray:
    """Share of days on which something is done for the first time, by hour, if each hour has its chance from 9 on."""
    left, done = 1.0, np.zeros(24)
    for hour in range(FIRST, 24):
        done[hour] = left * due[hour]
        left -= done[hour]
    return done


@given(arrays(np.float64, 24, elements=st.floats(0, 50)), st.floats(0, 1))
def test_followed_by_the_hour_a_need_is_met_on_the_wanted_share_of_days_at_the_wanted_hours(
    weights: np.ndarray, daily: float
) -> None:
    due = due_by_hour(weights, daily)
    assert ((due >= 0) & (due <= 1)).all()
    total = weights[COVERED].sum()
    if total > 1e-6:
        done = _followed(due)
        assert done.sum() == pytest.approx(daily, abs=1e-6)
        assert np.allclose(done[COVERED], daily * weights[COVERED] / total, atol=1e-6)


def test_what_would_be_due_before_the_day_begins_or_after_it_ends_takes_nothing_from_the_day() -> None:
    weights = np.ones(24)
    assert not due_by_hour(weights, 0.9)[[*range(FIRST), 22, 23]].any()
    assert not due_by_hour(np.zeros(24), 0.9).any()
