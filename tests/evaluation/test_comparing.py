from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from coopera.evaluation.comparing import (
    Of,
    Unit,
    clustered_mean,
    compare,
    detectable,
    holm,
    holm_all,
    noise,
    people_needed,
    sign_flip,
    sign_flips,
    t_tests,
)


def unit(person: str, value: float, scene: str = "maple", seed: int = 0) -> Unit:
    return Unit(person, scene, seed, value)


def test_three_people_who_all_gain_give_the_smallest_p_there_is() -> None:
    """Of the 2^3 assignments of signs only + + + and - - - are as extreme: p = 2 / 8."""
    assert sign_flip([0.1, 0.2, 0.3]) == pytest.approx(0.25, abs=1e-12)


def test_what_cannot_be_tested_has_p_one() -> None:
    assert sign_flip([0.4]) == 1
    assert sign_flip([]) == 1
    assert sign_flip([0.0, 0.0, 0.0]) == 1


def test_many_people_are_tested_by_random_signs_and_the_same_each_time() -> None:
    assert sign_flip([0.1] * 20) == sign_flip([0.1] * 20) < 0.001


def test_holm_multiplies_the_smallest_most_and_never_reorders() -> None:
    """0.01 x 3 = 0.03; 0.03 x 2 = 0.06; 0.04 x 1 = 0.04, but not less than the one before: 0.06."""
    assert holm([0.04, 0.01, 0.03]) == pytest.approx([0.06, 0.03, 0.06], abs=1e-12)
    assert holm([0.9, 0.8]) == [1, 1]
    assert holm([]) == []


def test_one_person_in_one_home_has_no_interval() -> None:
    assert clustered_mean([unit("amara", 0.4), unit("amara", 0.6)]) == (pytest.approx(0.5), None, None, 1)


def test_days_homes_and_seeds_of_one_person_do_not_narrow_the_interval() -> None:
    few = [unit("amara", 0.2), unit("bruno", 0.8), unit("chen", 0.5)]
    many = [one._replace(scene=home, seed=seed) for one in few for home in ("maple", "oak") for seed in range(25)]
    assert clustered_mean(many) == pytest.approx(clustered_mean(few))


def test_a_person_weighs_the_same_however_often_they_were_met() -> None:
    assert clustered_mean([unit("amara", 0.2), *[unit("bruno", 0.8, seed=n) for n in range(9)]]).mean == 0.5


def test_methods_are_compared_on_the_days_that_both_lived() -> None:
    """amara: 0.5 - 0.2, bruno: 0.4 - 0.3; chen lived with the other robot only. Mean (0.3 + 0.1) / 2, p = 2 / 2^2."""
    ours = {("a",): unit("amara", 0.2), ("b",): unit("bruno", 0.3)}
    other = {("a",): unit("amara", 0.5), ("b",): unit("bruno", 0.4), ("c",): unit("chen", 1.0)}
    [found] = compare(ours, {"other": other})
    assert (found.difference.mean, found.people) == (pytest.approx(0.2, abs=1e-12), 2)
    assert (found.p, found.p_corrected) == (pytest.approx(0.5), pytest.approx(0.5))
    assert compare(ours, {"stranger": {("z",): unit("zoe", 1.0)}}) == []


def test_the_detectable_difference_is_that_of_a_t_test() -> None:
    """(2.5706 + 0.9195) x SD 0.10954 / sqrt 6 = 0.1561."""
    assert detectable([0.0, 0.2] * 3) == pytest.approx(0.1561, abs=1e-4)


@pytest.mark.parametrize("people", [0, 1, 2, 3, 5])
def test_nothing_is_said_to_be_detectable_where_no_test_can_find_it(people: int) -> None:
    """Five people: 2 / 2^5 = 0.0625 is the smallest p there is."""
    assert detectable([0.1, 0.2, 0.3, 0.4, 0.5][:people]) is None


def test_holm_asks_for_more_people_the_more_is_compared() -> None:
    """One comparison: 2 / 2^6 < 0.05. Twelve: 12 x 2 / 2^9 = 0.047."""
    assert (people_needed(1), people_needed(12)) == (6, 9)


def test_many_studies_are_tested_as_each_alone() -> None:
    studies = np.random.default_rng(3).normal(0.5, 1, (40, 7))
    assert sign_flips(studies).tolist() == [sign_flip(list(one)) for one in studies]
    p_values = np.random.default_rng(4).uniform(size=(40, 5))
    assert holm_all(p_values).tolist() == [holm(list(one)) for one in p_values]


def test_the_t_test_is_that_of_scipy_and_knows_no_scatter() -> None:
    """[0.1, 0.4, 0.2, 0.5, 0.3]: t = 0.3 / (0.1581 / sqrt 5) = 4.2426, two-sided with four degrees of freedom."""
    study = [0.1, 0.4, 0.2, 0.5, 0.3]
    assert t_tests(np.array([study]))[0] == pytest.approx(stats.ttest_1samp(study, 0).pvalue, abs=1e-12)
    assert t_tests(np.array([[0.0] * 4, [0.2] * 4])).tolist() == [1, 0]
    assert t_tests(np.array([[0.1, 0.2]])).tolist() == [1], "two people are too few"


def test_a_stated_test_and_correction_are_the_ones_applied() -> None:
    ours = {(who,): unit(who, 0.0) for who in "abcdef"}
    others = {
        name: {(who,): unit(who, value) for who, value in zip("abcdef", values, strict=True)}
        for name, values in (("one", (1, 2, 3, 4, 5, 6.0)), ("two", (1, 1, 2, 1, 1, 2.0)))
    }
    plain = compare(ours, others, test="t", correction="none")
    assert [one.p_corrected for one in plain] == [one.p for one in plain]
    assert plain[0].p == pytest.approx(stats.ttest_1samp([1, 2, 3, 4, 5, 6], 0).pvalue)
    assert [one.p_corrected for one in compare(ours, others)] == pytest.approx([2 * 2 / 2**6] * 2)


def seeded(*seeds: float, person: str = "amara") -> dict[Of, Unit]:
    return {("1", 2, seed, 0, person): unit(person, value, seed=seed) for seed, value in enumerate(seeds)}


def test_the_noise_floor_is_the_scatter_between_seeds_and_not_that_between_people() -> None:
    """Both people: SD 0.1 with one degree of freedom each. The mean of two people with two seeds each has an SD of
    0.1 sqrt(2 / 2 / 4) = 0.05, and t(2) = 4.3027."""
    step = 0.1 / 2**0.5
    found = noise({**seeded(0.2 - step, 0.2 + step), **seeded(0.8 - step, 0.8 + step, person="bruno")})
    assert found is not None
    assert (found.sd, found.freedom) == (pytest.approx(0.1), 2)
    assert found.floor == pytest.approx(4.3027 * 0.05, abs=1e-4)
    assert found.low < found.sd < found.high
    assert noise(seeded(0.5)) is None, "a single seed says nothing"


def test_a_difference_that_other_seeds_alone_could_make_is_below_the_noise() -> None:
    ours = {key: one for who in "abc" for key, one in seeded(0.3, 0.3, person=who).items()}
    noisy = {key: one for who in "abc" for key, one in seeded(0.1, 0.6, person=who).items()}
    clear = {key: one for who in "abc" for key, one in seeded(0.69, 0.71, person=who).items()}
    assert [one.below_noise for one in compare(ours, {"noisy": noisy, "clear": clear})] == [True, False]


def test_noise_floors_hold_95_percent_of_studies_that_differ_by_seed_alone() -> None:
    """1,000 studies of four people under three seeds each; the truth of each person stays."""
    rng, truth = np.random.default_rng(0), (0.1, 0.3, 0.5, 0.9)
    held = 0
    for _ in range(1000):
        study = {
            key: one
            for who, mean in zip("abcd", truth, strict=True)
            for key, one in seeded(*rng.normal(mean, 0.07, 3), person=who).items()
        }
        found = noise(study)
        assert found is not None
        held += abs(clustered_mean(list(study.values())).mean - 0.45) <= found.floor
    assert 0.93 <= held / 1000 <= 0.97
