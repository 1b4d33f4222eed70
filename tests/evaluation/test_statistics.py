from __future__ import annotations

import math
from collections.abc import Sequence

from coopera.evaluation.statistics import bootstrap, bootstrap_mean


def test_the_interval_holds_the_mean_and_is_the_same_each_time() -> None:
    values = [0.1, 0.4, 0.2, 0.5, 0.3]
    interval = bootstrap_mean(values)
    assert interval == bootstrap_mean(values)
    assert interval.low < interval.mean < interval.high
    assert abs(interval.mean - 0.3) < 1e-12


def test_equal_values_have_an_interval_of_no_width() -> None:
    assert bootstrap_mean([0.25] * 4) == (0.25, 0.25, 0.25)


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
