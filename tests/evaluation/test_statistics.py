from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from statistics import fmean

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from coopera.evaluation.statistics import bootstrap, mean_over_people

Floats = NDArray[np.float64]


def test_the_interval_of_a_mean_of_symmetric_people_is_students() -> None:
    """Mean 0.3, SD 0.1581, five people: 0.3 +- 2.7764 x 0.1581 / sqrt 5 = 0.3 +- 0.1963."""
    found = mean_over_people([0.1, 0.4, 0.2, 0.5, 0.3])
    assert found == (pytest.approx(0.3), pytest.approx(0.1037, abs=1e-4), pytest.approx(0.4963, abs=1e-4), 5)
    assert str(found) == "0.300 [0.104, 0.496]"


def test_equal_values_have_an_interval_of_no_width() -> None:
    assert mean_over_people([0.25] * 4) == (0.25, 0.25, 0.25, 4)


@pytest.mark.parametrize("values", [[0.4], [0.4, 0.6]])
def test_one_or_two_people_have_no_interval_and_that_is_said(values: list[float]) -> None:
    found = mean_over_people(values)
    assert (found.low, found.high, found.people) == (None, None, len(values))
    assert found.interval == "(n too small)"


def test_the_interval_of_skewed_people_reaches_farther_to_where_few_have_much() -> None:
    """Five people of 0 and one of 6: mean 1, SD 2.4495, skewness 20 / 5^1.5 = 1.7889, shrunk to 1.5759.

    t reaches 2.5706 x 1 to either side. Hall's upper end: 1 - 1.5759 (1.0494 + 0.0438) has the cube root -0.8974, so
    1 + 2.4495 x 3 / 1.5759 x 1.8974 = 9.847; its lower one, -0.736, lies within t's.
    """
    found = mean_over_people([0, 0, 0, 0, 0, 6])
    assert found == (pytest.approx(1), pytest.approx(-1.5706, abs=1e-4), pytest.approx(9.847, abs=1e-2), 6)
    turned = mean_over_people([0, 0, 0, 0, 0, -6])
    assert found.high is not None
    assert turned.low == pytest.approx(-found.high)


def realistic(rng: np.random.Generator, lives: int, people: int) -> Floats:
    """People differ by SD 0.021 and days by 0.076, as measured, each in [0, 1]; a person's mean of five days."""
    return over_days(rng, rng.normal(0.31, 0.021, (lives, people)))


def skewed(rng: np.random.Generator, lives: int, people: int) -> Floats:
    """Most people get little and some much (an exponential tail above 0.15)."""
    return over_days(rng, 0.15 + rng.exponential(0.04, (lives, people)))


def near_zero(rng: np.random.Generator, lives: int, people: int) -> Floats:
    """So little help that the bound of 0 cuts off a third of all days."""
    return over_days(rng, rng.normal(0.04, 0.021, (lives, people)))


def exponential(rng: np.random.Generator, lives: int, people: int) -> Floats:
    """Many have little and few have much; Student's t holds 0.92 of them with sixteen people."""
    return rng.exponential(size=(lives, people))


def lopsided(rng: np.random.Generator, lives: int, people: int) -> Floats:
    """Most are hardly helped at all; Student's t holds 0.925 with twelve people."""
    return rng.beta(0.5, 2, (lives, people))


def over_days(rng: np.random.Generator, people: Floats) -> Floats:
    means = np.clip(people, 0, 1)[..., None]
    return np.clip(rng.normal(means, 0.076, (*people.shape, 5)), 0, 1).mean(axis=-1)


@pytest.mark.parametrize("people", [6, 12, 20])
@pytest.mark.parametrize("population", [realistic, skewed, near_zero])
def test_an_interval_that_says_95_percent_covers_at_least_93(
    population: Callable[[np.random.Generator, int, int], Floats], people: int
) -> None:
    """4,000 samples of so many people each; the truth is the mean of half a million others."""
    truth = float(population(np.random.default_rng(1), 1, 500_000).mean())
    found = [mean_over_people(sample) for sample in population(np.random.default_rng(0), 4000, people).tolist()]
    covered = fmean(one.low is not None and one.high is not None and one.low <= truth <= one.high for one in found)
    assert 0.93 <= covered <= 0.97


@pytest.mark.parametrize(("population", "people"), [(exponential, 16), (lopsided, 12)])
def test_an_interval_of_skewed_people_holds_more_often_than_students(
    population: Callable[[np.random.Generator, int, int], Floats], people: int
) -> None:
    drawn = population(np.random.default_rng(0), 4000, people)
    truth = float(population(np.random.default_rng(1), 1, 500_000).mean())
    found = [mean_over_people(sample) for sample in drawn.tolist()]
    assert fmean(one.low is not None and one.high is not None and one.low <= truth <= one.high for one in found) > 0.935


@pytest.mark.parametrize("people", [6, 16])
def test_an_interval_of_normal_people_is_hardly_wider_than_students(people: int) -> None:
    drawn = np.random.default_rng(0).normal(size=(2000, people))
    half = stats.t.ppf(0.975, people - 1) * drawn.std(axis=1, ddof=1) / math.sqrt(people)
    found = [mean_over_people(sample) for sample in drawn.tolist()]
    width = np.array([one.high - one.low for one in found if one.low is not None and one.high is not None])
    assert width.min() > 0
    assert np.median(width / (2 * half)) < 1.001
    assert np.mean(width / (2 * half)) < 1.12


def test_any_statistic_is_resampled_by_units_and_not_by_what_is_in_them() -> None:
    """Two units of 50 equal values: a resample is all 0, all 1 or half and half, so the interval is [0, 1]."""

    def mean(units: Sequence[list[float]]) -> float:
        values = [value for unit in units for value in unit]
        return sum(values) / len(values)

    interval = bootstrap([[0.0] * 50, [1.0] * 50], mean)
    assert interval == (0.5, 0, 1)
    assert interval == bootstrap([[0.0] * 50, [1.0] * 50], mean)


def test_resamples_without_meaning_are_left_out() -> None:
    def spread(units: Sequence[float]) -> float:
        return max(units) - min(units) or float("nan")

    assert bootstrap([1.0, 3.0], spread) == (2, 2, 2)
    assert all(math.isnan(number) for number in bootstrap([1.0, 1.0], spread))
