"""People who live as the table says are at no distance from it, beyond what a sample of the table shows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from coopera.core.time_use import CATEGORIES
from coopera.evaluation.people.divergence import earth_mover, jensen_shannon
from coopera.evaluation.people.figures import Figure
from coopera.evaluation.people.hours_spent import SpentDay, spent
from coopera.evaluation.people.time_use import TimeUse, read_time_use
from coopera.evaluation.people.time_use_distance import half_width, hour_rows, time_use_figures, within_table
from coopera.evaluation.people.time_use_plot import COLOURS, draw_time_use
from tests.evaluation.people.lived import day
from tests.evaluation.people.tables import Shares, rows, says, write

SATURDAY = 5


def _table(tmp_path: Path, *strata: str) -> TimeUse:
    """On weekdays half work and half watch; on weekends all watch; but in stratum B all work always."""

    def shares(stratum: str, kind: str) -> Shares:
        return {"work": 100.0} if stratum == "B" else {"work": 50.0, "tv": 50.0} if kind == "weekday" else {"tv": 100.0}

    groups = [
        rows(stratum, kind, lambda hour, stratum=stratum, kind=kind: shares(stratum, kind))  # type: ignore[misc]
        for stratum in strata
        for kind in ("weekday", "weekend")
    ]
    return read_time_use(write(tmp_path / "table.csv", *groups))


def _days(*does: list[str], number: int = 0) -> list[SpentDay]:
    """One day of each of several people, from 9 o'clock."""
    return [spent(day(f"p{at}", number=number, does=one), says) for at, one in enumerate(does)]


def _by_measure(figures: Sequence[Figure]) -> dict[str, Figure]:
    return {figure.measure: figure for figure in figures}


def test_the_divergence_is_0_for_equals_1_for_strangers_and_as_worked_out_by_hand_between() -> None:
    assert jensen_shannon(np.array([0.5, 0.5]), np.array([0.5, 0.5])) == 0
    assert jensen_shannon(np.array([1.0, 0.0]), np.array([0.0, 1.0])) == 1
    # middle (3/4, 1/4): (log2(4/3) + (log2(2/3) + log2(2)) / 2) / 2
    by_hand = (np.log2(4 / 3) + (np.log2(2 / 3) + 1) / 2) / 2
    assert jensen_shannon(np.array([1.0, 0.0]), np.array([0.5, 0.5])) == pytest.approx(by_hand)
    assert np.isnan(jensen_shannon(np.array([np.nan, np.nan]), np.array([0.5, 0.5])))


def test_the_earth_mover_walks_hours_of_the_clock() -> None:
    assert earth_mover(np.array([2.0, 0, 0]), np.array([0, 0, 5.0]), [9, 10, 14]) == 5
    assert earth_mover(np.array([1.0, 1, 0]), np.array([0, 1.0, 1]), [9, 10, 11]) == 1
    assert np.isnan(earth_mover(np.zeros(3), np.ones(3), [9, 10, 11]))


def test_who_lives_as_the_table_says_is_at_no_distance_and_below_a_samples(tmp_path: Path) -> None:
    days = _days(["work"] * 4, ["tv"] * 4, ["work"] * 4, ["tv"] * 4)
    found = _by_measure(time_use_figures(days, _table(tmp_path, "A")))
    distance = found["distance, weekday, A"]
    assert distance.value == pytest.approx(0)
    assert distance.control is not None
    assert 0 < distance.control < 0.3  # four days drawn from the table are seldom two and two
    assert (distance.n, distance.unit, distance.control_is) == (4, "people", "drawn from the table")
    assert "4 hours from 9 to 12, 4 person-days" in distance.note
    assert distance.low is not None
    assert distance.high is not None
    assert distance.low == 0 < distance.high <= 1
    assert found["worst hour, weekday, A"].value == pytest.approx(0)
    assert found["tv, more hours a day, weekday, A"].value == pytest.approx(0)
    assert found["tv, hours shifted, weekday, A"].value == pytest.approx(0)


def test_the_worst_hour_is_named_and_television_at_eight_is_said_in_points(tmp_path: Path) -> None:
    does = ["exercise", *["tv"] * 11]
    found = _by_measure(time_use_figures(_days(does, does, does, number=SATURDAY), _table(tmp_path, "A")))
    worst = found["worst hour, weekend, A"]
    assert worst.value == 1
    assert worst.note.startswith("at 9")
    assert found["distance, weekend, A"].value == pytest.approx(1 / 12)
    assert found["tv at 20, weekend, A"].value == 0
    weekday = _by_measure(time_use_figures(_days(does, does, does), _table(tmp_path, "A")))["tv at 20, weekday, A"]
    assert weekday.value == pytest.approx(0.5)
    assert weekday.note == "100.0 % simulated, 50.0 % real: +50.0 points"


def test_hours_a_day_are_compared_over_the_lived_hours_and_what_nobody_does_has_no_shift(tmp_path: Path) -> None:
    found = _by_measure(time_use_figures(_days(["tv", "work"], ["tv", "work"], ["tv", "tv"]), _table(tmp_path, "A")))
    tv = found["tv, more hours a day, weekday, A"]
    assert tv.value == pytest.approx(4 / 3 - 1)
    assert tv.note == "1.33 h a day simulated, 1.00 h real"
    # television 3 : 1 over two hours against 1 : 1, so a quarter of it is an hour early
    assert found["tv, hours shifted, weekday, A"].value == pytest.approx(0.25)
    assert found["laundry, hours shifted, weekday, A"].value is None
    assert found["laundry, hours shifted, weekday, A"].note == "nobody simulated does it"


def test_fewer_than_three_people_have_no_interval_and_it_says_so(tmp_path: Path) -> None:
    found = _by_measure(time_use_figures(_days(["tv"], ["work"]), _table(tmp_path, "A")))
    assert found["distance, weekday, A"].low is None
    assert "an interval takes 3 people" in found["distance, weekday, A"].note


def test_the_interval_of_a_mean_is_students_and_people_who_are_all_alike_have_none(tmp_path: Path) -> None:
    # three people at 0, 0 and 1: standard error sqrt(1/3) / sqrt(3), t(2) = 4.3027
    people = np.array([0.0, 0.0, 1.0])
    every = np.array([people[[a, b, c]].mean() for a in range(3) for b in range(3) for c in range(3)])
    assert half_width(every, 3) == pytest.approx(4.302652729911275 / 3)
    found = _by_measure(time_use_figures(_days(["tv"], ["tv"], ["tv"]), _table(tmp_path, "A")))
    assert found["tv, more hours a day, weekday, A"].low is None


def test_a_day_type_that_nobody_lived_is_unmeasured(tmp_path: Path) -> None:
    found = _by_measure(time_use_figures(_days(["tv"], ["work"]), _table(tmp_path, "A")))
    assert found["distance, weekend, A"].value is None
    assert "no weekend was lived" in found["distance, weekend, A"].note
    assert found["weekday from weekend"].value is None


def _week(person: str, weekday: str, weekend: str, scene: str = "home") -> list[SpentDay]:
    return [spent(day(person, scene, number=n, does=[weekend if n % 7 >= 5 else weekday] * 3), says) for n in range(14)]


def test_a_week_with_a_weekend_is_told_from_one_without(tmp_path: Path) -> None:
    table = _table(tmp_path, "A")
    rhythmic = _by_measure(time_use_figures(_week("ann", "work", "tv"), table))["weekday from weekend"]
    assert rhythmic.value == 1
    assert rhythmic.control is not None
    assert rhythmic.control < 0.5
    assert rhythmic.note.startswith("p 0.00")
    alike = _by_measure(time_use_figures(_week("ann", "work", "work"), table))["weekday from weekend"]
    assert (alike.value, alike.control) == (0, 0)
    assert alike.note.startswith("p 1.000")


def test_copies_of_a_day_in_other_homes_make_no_week_more_certain(tmp_path: Path) -> None:
    does = ["work", "tv", "work", "tv", "work", "tv", "work"]  # no rhythm of the week
    once = [spent(day("ann", number=n, does=[does[n]]), says) for n in range(7)]
    often = [spent(day("ann", f"home{at}", number=n, does=[does[n]]), says) for n in range(7) for at in range(8)]
    notes = [
        _by_measure(time_use_figures(days, _table(tmp_path, "A")))["weekday from weekend"] for days in (once, often)
    ]
    assert notes[0].note == notes[1].note


def test_the_tables_own_distances_stand_beside_for_one_stratum_and_for_two(tmp_path: Path) -> None:
    days = _days(["tv"], ["work"])
    one = _by_measure(list(within_table(days, _table(tmp_path, "A"))))
    half = float(jensen_shannon(np.array([1.0, 0.0]), np.array([0.5, 0.5])))
    assert {measure: figure.value for measure, figure in one.items()} == {
        "weekday from weekend, A": pytest.approx(half)
    }
    two = _by_measure(list(within_table(days, _table(tmp_path, "A", "B"))))
    assert two["weekday from weekend, B"].value == 0
    assert two["A from B, weekday"].value == pytest.approx(half)
    assert two["A from B, weekend"].value == 1
    assert {figure.variant for figure in two.values()} == {"table"}


def test_the_same_seed_gives_the_same_figures_whatever_the_order_of_days(tmp_path: Path) -> None:
    table, days = _table(tmp_path, "A"), [*_week("ann", "work", "tv"), *_week("bob", "tv", "work")]
    first = time_use_figures(days, table, seed=3)
    assert first == time_use_figures(days, table, seed=3)
    turned = _by_measure(time_use_figures(days[::-1], table, seed=3))
    for figure in first:
        assert turned[figure.measure].value == pytest.approx(figure.value), figure.measure


def test_each_lived_hour_has_nine_rows_that_add_up(tmp_path: Path) -> None:
    found = list(hour_rows(_days(["tv", "eating 30"], ["work", "work"]), _table(tmp_path, "A"), "full"))
    assert [(row.hour, row.category) for row in found] == [(hour, name) for hour in (9, 10) for name in CATEGORIES]
    assert sum(row.simulated_pct for row in found if row.hour == 10) == pytest.approx(100)
    work = next(row for row in found if (row.hour, row.category) == (9, "work"))
    assert (work.simulated_pct, work.table_pct, work.difference_points, work.person_days) == (50, 50, 0, 2)
    assert work.hour_distance == 0


def test_the_picture_is_drawn_also_where_a_day_type_is_missing(tmp_path: Path) -> None:
    days = {"full": _days(["tv"], ["work"]), "single_shot": _days(["tv"], number=SATURDAY)}
    draw_time_use(days, _table(tmp_path, "A", "B"), tmp_path / "found.png", "two days")
    assert (tmp_path / "found.png").read_bytes().startswith(b"\x89PNG")
    assert list(COLOURS) == list(CATEGORIES)
    assert len(set(COLOURS.values())) == len(CATEGORIES)
