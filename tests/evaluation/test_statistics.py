from __future__ import annotations

from evaluation.statistics import bootstrap_mean


def test_the_interval_holds_the_mean_and_is_the_same_each_time() -> None:
    values = [0.1, 0.4, 0.2, 0.5, 0.3]
    interval = bootstrap_mean(values)
    assert interval == bootstrap_mean(values)
    assert interval.low < interval.mean < interval.high
    assert abs(interval.mean - 0.3) < 1e-12


def test_equal_values_have_an_interval_of_no_width() -> None:
    assert bootstrap_mean([0.25] * 4) == (0.25, 0.25, 0.25)
