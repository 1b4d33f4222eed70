from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from coopera.models.learners.counts import PRIOR, Counts, Observations, log_odds
from coopera.models.learners.habits import Habits, faded

HOURS, THINGS = 4, 6
Uses = Callable[[int, int, int], bool]  # day, hour, thing


def days(numbers: range, uses: Uses) -> Observations:
    """Days of four hours and six things; the activity before alternates by day."""
    rows = [(day, hour, thing) for day in numbers for hour in range(HOURS) for thing in range(THINGS)]
    contexts = np.array([[hour, day % 2] for day, hour, _ in rows])
    return Observations(
        day=np.array([day for day, _, _ in rows]),
        thing=np.array([thing for _, _, thing in rows]),
        contexts=contexts,
        numbers=np.zeros((len(rows), 1)),
        label=np.array([uses(*row) for row in rows]),
    )


def at_its_hour(day: int, hour: int, thing: int) -> bool:
    return thing == hour


def an_hour_later(day: int, hour: int, thing: int) -> bool:
    return thing == (hour + 1) % HOURS


def test_a_rate_is_its_count_and_one_observation_of_the_coarser_rate() -> None:
    seen = days(range(3), at_its_hour)
    asked = days(range(3, 4), at_its_hour)
    rates = Counts(seen).rates(asked)
    row = 0  # hour 0, thing 0: used at 3 of 3, and at 3 of 12 hours in all
    base = (3 + PRIOR * 0.02) / (12 + PRIOR)
    assert rates.shares[row, 0] == pytest.approx((3 + PRIOR * base) / (3 + PRIOR))
    assert rates.evidence[row].tolist() == [3.0, 4.0, 1.0]  # three such hours, four hours of an odd day, one of both


def test_the_rate_of_a_pair_is_the_mean_of_both_rates_where_the_two_never_met() -> None:
    rates = Counts(days(range(1), at_its_hour)).rates(days(range(1, 2), at_its_hour))
    assert rates.evidence[:, 2].max() == 0
    assert rates.shares[:, 2] == pytest.approx(rates.shares[:, :2].mean(1))


def test_each_two_contexts_speak_with_equal_log_odds() -> None:
    seen, asked = days(range(6), at_its_hour), days(range(6, 7), at_its_hour)
    three = [replace(one, contexts=np.hstack([one.contexts, one.thing[:, None] % 2])) for one in (seen, asked)]
    rates = Counts(three[0]).rates(three[1])
    assert log_odds(rates.probabilities) == pytest.approx(log_odds(rates.shares[:, 3:6]).mean(1))
    with_fourth = [replace(one, contexts=np.hstack([one.contexts, one.contexts[:, :1]])) for one in three]
    assert Counts(with_fourth[0]).rates(with_fourth[1]).probabilities == pytest.approx(rates.probabilities)


def test_a_single_context_speaks_alone() -> None:
    seen, asked = (replace(one, contexts=one.contexts[:, :1]) for one in (days(range(3), at_its_hour),) * 2)
    rates = Counts(seen).rates(asked)
    assert rates.probabilities == pytest.approx(rates.shares[:, 0])


def test_a_day_learned_from_is_foretold_as_if_it_were_still_to_come() -> None:
    both = days(range(2), at_its_hour)
    left_out = Counts(both).rates(both, own_day=False)
    first, second = both.take(both.day == 0), both.take(both.day == 1)
    as_new = Counts(first).rates(second)
    for ours, theirs in zip(left_out, as_new, strict=True):
        assert ours[both.day == 1] == pytest.approx(theirs)


def test_what_counts_nothing_is_as_if_it_had_not_been() -> None:
    both, asked = days(range(2), at_its_hour), days(range(2, 3), at_its_hour)
    weighed = Counts(both, (both.day == 1).astype(float)).rates(asked)
    alone = Counts(both.take(both.day == 1)).rates(asked)
    assert weighed.shares == pytest.approx(alone.shares)


def test_before_anything_was_seen_nothing_is_expected() -> None:
    habits = Habits()
    habits.train(days(range(0, 1), at_its_hour).take(np.zeros(HOURS * THINGS, bool)))
    assert not habits.says_yes(days(range(1), at_its_hour)).any()


def test_after_one_day_counts_speak_and_foretell_the_same_again() -> None:
    habits = Habits()
    habits.train(days(range(1), at_its_hour))
    asked = days(range(2, 3), at_its_hour)
    assert habits.chosen.name == "counts"
    assert (habits.says_yes(asked) == asked.label).all()


def test_two_days_are_too_few_to_learn_on_top_of_counts() -> None:
    """Without the one held out there is a single day, which cannot be treated as one still to come."""
    habits = Habits()
    habits.train(days(range(2), at_its_hour))
    assert habits.chosen.name == "counts"
    assert list(habits.chosen.losses) == ["counts"]


def test_counts_go_on_speaking_where_what_is_learned_errs_on_held_out_days(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("_logistic", "_boosted"):
        monkeypatch.setattr(f"coopera.models.learners.habits.{name}", lambda *_: lambda rows: np.full(len(rows), 0.9))
    habits = Habits()
    habits.train(days(range(10), at_its_hour))
    assert habits.chosen.name == "counts"
    asked = days(range(10, 12), at_its_hour)
    assert (habits.says_yes(asked) == asked.label).all()


def test_what_is_learned_takes_over_where_counts_cannot_know() -> None:
    """Things are used where a number known beforehand says so, of which counts know nothing."""
    rng = np.random.default_rng(0)
    told = rng.random((40, HOURS, THINGS))
    seen, asked = (days(part, lambda *at: bool(told[at] > 0.7)) for part in (range(30), range(30, 40)))
    seen, asked = (
        Observations(one.day, one.thing, one.contexts, told[one.day].reshape(-1, HOURS * THINGS)[:: HOURS * THINGS]
                     .reshape(-1, 1), one.label)
        for one in (seen, asked)
    )  # fmt: skip
    habits = Habits()
    habits.train(seen)
    assert habits.chosen.name == "learned"
    assert (habits.says_yes(asked) == asked.label).mean() > 0.95


def test_a_person_who_lives_otherwise_from_now_on_is_noticed_and_followed() -> None:
    seen = days(range(16), lambda *at: at_its_hour(*at) if at[0] < 8 else an_hour_later(*at))
    habits = Habits()
    habits.train(seen)
    kept = habits.fading.of(np.array([0, 7, 10, 15]))
    assert kept[:2].max() < 0.2
    assert kept[2:].min() > 0.8
    asked = days(range(16, 17), an_hour_later)
    assert (habits.says_yes(asked) == asked.label).all()


def test_a_person_who_stays_the_same_is_not_forgotten() -> None:
    rng = np.random.default_rng(2)
    drawn = rng.random((60, HOURS, THINGS)) < 0.2 + 0.6 * np.eye(HOURS, THINGS)
    assert faded(days(range(60), lambda *at: bool(drawn[at]))).of(np.arange(60)).min() > 0.9
