"""Power is what a study finds: checked on days that are drawn one by one and compared as the analysis compares them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from coopera.evaluation.comparing import Of, Unit, compare
from coopera.evaluation.power.power import Sample, by_people, foresee
from coopera.evaluation.power.scatter import Scatter, estimate

SCATTER = Scatter(people=0.04, lives=0.03, days=0.08, n=9)
NINE = Sample(((3, 3),) * 9)
"""Nine people with two lives of three late days each."""


def study(rng: np.random.Generator, gains: dict[str, float], scatter: Scatter = SCATTER) -> Iterator[dict[Of, Unit]]:
    """The units of each method, which scatters by half of a difference's variance, so that differences have it all."""
    for gain in gains.values():
        found: dict[Of, Unit] = {}
        for person, lives in enumerate(NINE.lives):
            own = rng.normal(gain, scatter.people / 2**0.5)
            for life, days in enumerate(lives):
                here = rng.normal(own, scatter.lives / 2**0.5)
                value = float(rng.normal(here, scatter.days / 2**0.5, days).mean())
                found[life, person] = Unit(str(person), "maple", life, value)
        yield found


@pytest.mark.parametrize("test", ["sign_flip", "t"])
def test_a_detectable_difference_is_found_in_80_percent_of_studies_and_a_smaller_one_in_less(test: str) -> None:
    """500 studies: the error of a share is 0.018, and that of 0.8 itself is in the forecast."""
    forecast = foresee(NINE, {"better": SCATTER, "same": SCATTER}, test=test)
    detectable = forecast.comparisons[0].detectable
    assert detectable is not None
    for gain, wanted in ((detectable.value, 0.8), (0.05, forecast.comparisons[0].power[0.05].value)):
        rng, found = np.random.default_rng(5), 0
        for _ in range(500):
            ours, better, same = study(rng, {"ours": 0.3, "better": 0.3 + gain, "same": 0.3})
            [first, _] = compare(ours, {"better": better, "same": same}, test=test)
            found += first.p_corrected is not None and first.p_corrected < 0.05
        assert found / 500 == pytest.approx(wanted, abs=0.05)


def test_intervals_hold_the_truth_in_95_percent_and_nothing_is_found_where_nothing_is() -> None:
    forecast = foresee(NINE, {"a": SCATTER, "b": SCATTER, "c": SCATTER})
    assert forecast.coverage["normal"].value == pytest.approx(0.95, abs=0.015)
    assert forecast.false_alarms.value <= 0.05 + 3 * forecast.false_alarms.error


def test_too_few_people_for_the_comparisons_can_find_nothing() -> None:
    """Six people: 2 / 2^6 = 0.031, times two comparisons 0.0625."""
    six = NINE.of_size(6)
    assert foresee(six, {"a": SCATTER}).comparisons[0].detectable is not None
    both = foresee(six, {"a": SCATTER, "b": SCATTER})
    assert [one.detectable for one in both.comparisons] == [None, None]
    assert both.comparisons[0].power[0.1].value == 0


def test_more_people_lives_or_days_find_smaller_differences() -> None:
    def smallest(sample: Sample) -> float:
        found = foresee(sample, {"a": SCATTER}, test="t").comparisons[0].detectable
        assert found is not None
        return found.value

    base = smallest(NINE)
    assert smallest(NINE.of_size(16)) < base
    assert smallest(Sample(((3, 3, 3, 3),) * 9)) < base
    assert smallest(Sample(((9, 9),) * 9)) < base
    sizes = [one.value if one else None for one in by_people(NINE, [SCATTER], test="t", sizes=(9, 16)).values()]
    assert sizes == pytest.approx([base, smallest(NINE.of_size(16))], rel=0.1), "of a quarter as many studies"


def test_scatter_of_few_people_is_taken_with_caution() -> None:
    """The upper 80 % limit of a standard deviation of three people: sqrt(2 / 0.4463) = 2.117."""
    assert Scatter(0.1, 0, 0, n=3).caution == pytest.approx(2.117, abs=1e-3)
    assert Scatter(0.1, 0, 0, n=100).caution == pytest.approx(1.06, abs=0.01)
    [one] = foresee(NINE, {"a": SCATTER._replace(n=3)}).comparisons
    assert one.detectable is not None
    assert one.cautious == pytest.approx(2.117 * one.detectable.value, rel=1e-3)


def test_variance_components_are_found_again() -> None:
    rng = np.random.default_rng(2)
    people = {
        str(person): [
            list(rng.normal(here, 0.08, 5)) for here in rng.normal(rng.normal(0.1, 0.05), 0.04, 3)
        ]
        for person in range(600)
    }  # fmt: skip
    found = estimate(people)
    assert found[:3] == pytest.approx((0.05, 0.04, 0.08), abs=0.005)
    assert found.n == 600


def test_with_one_life_of_one_day_all_scatter_is_between_people() -> None:
    assert estimate({"a": [[0.1]], "b": [[0.3]]}) == pytest.approx((0.02**0.5, 0, 0, 2))
