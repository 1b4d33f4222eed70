from __future__ import annotations

import re
from typing import Any

import pytest

from coopera.core.errors import ConfigError
from coopera.core.naming import sha256
from coopera.core.people import Frozen
from coopera.evaluation import measuring
from coopera.evaluation.analysis import (
    STATED,
    Endpoint,
    agreement,
    comparisons,
    curve,
    effort,
    generalisation,
    growth,
    last_day,
    late_days,
    score,
)
from coopera.evaluation.figures import all_figures
from coopera.evaluation.measuring import MeasureSpec, sums
from coopera.evaluation.results import FORMAT, Card, Row, check_card, from_csv, to_csv, unpaired
from coopera.evaluation.tables import all_tables


def row(method: str = "ours", person: str = "amara", day: int = 0, hour: int = 9, **over: Any) -> Row:
    counts = {
        f"{m}_{c}": n for m in ("predicate", "judge", "people") for c, n in zip(COUNTS, (1, 1, 0, 2, 0), strict=True)
    }
    given = {"remaining": 4, "helped": 1, "done": 2, "useless": 1, "metres": 5.0, "saved_metres": 2.5, "accepted": 2}
    data: dict[str, Any] = {
        **{"method": method, "setting": "1", "collab": 2, "seed": 0, "episode": 0, "day": day, "round": day},
        **{"last": day == 1, "hour": hour, "person": person, "scene": "maple", "status": "ok", "activity": "rest"},
        "human": f"{person}{day}{hour}",
        **counts,
        **given,
    }
    return Row(**{**data, **over})


COUNTS = ("tp", "fp", "fn", "tn", "unscored")


def failed(**over: Any) -> Row:
    nothing = {name: None for name in Row.model_fields if name.startswith(("predicate", "judge", "people"))}
    return row(status="failed", **nothing, remaining=None, helped=None, done=None, useless=None, metres=None,
               saved_metres=None, accepted=None, **over)  # fmt: skip


def card(rows: list[Row], **over: Any) -> dict[str, Any]:
    table = to_csv(rows)
    made = Card(
        format=FORMAT, coopera="0", name="x", offline=True, models={}, methods=["ours"], settings=["1"], seeds=[0],
        rows=len(rows), failed_hours=0, sha256=sha256(table), grid={},
    )  # fmt: skip
    return {**made.model_dump(), **over}


def test_a_table_is_read_as_it_was_written_failed_hours_too() -> None:
    rows = [failed(hour=11), row(hour=10), row("random", hour=10), row(hour=9)]
    assert from_csv(to_csv(rows), "hours.csv") == sorted(rows, key=lambda one: one.key)


def test_results_of_another_version_are_refused_by_name() -> None:
    with pytest.raises(
        ConfigError, match=r"results.json: the results are of format 2, and this coopera reads format 1"
    ):
        check_card(card([row()], format=2), to_csv([row()]), "results.json")
    with pytest.raises(ConfigError, match="format None"):
        check_card([], "", "results.json")


def test_a_table_that_was_changed_afterwards_is_refused() -> None:
    better = [row(predicate_tp=9)]
    with pytest.raises(ConfigError, match="SHA-256"):
        check_card(card([row()]), to_csv(better), "results.json")


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ("predicate_tp", "predicate_top", "columns"),
        (",9,amara", ",99,amara", "line 2: hour cannot be '99'"),
        (",ok,", ",fine,", "line 2: status cannot be 'fine'"),
    ],
)
def test_a_damaged_table_is_refused_with_line_and_column(before: str, after: str, sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        from_csv(to_csv([row()]).replace(before, after, 1), "hours.csv")


def test_an_hour_that_stands_twice_is_refused() -> None:
    with pytest.raises(ConfigError, match="1 hours stand there twice"):
        from_csv(to_csv([row(), row()]), "hours.csv")


def test_methods_that_met_different_days_are_found() -> None:
    assert unpaired([row(), row("random")]) == []
    assert unpaired([row(), row("random", human="another")]) == ["setting 1 type 2 seed 0 episode 0 day 0 hour 9"]


def test_scores_pool_hours_and_leave_failed_ones_out() -> None:
    """tp 1 fp 1 twice: 4 / (4 + 2); helped 2 of 8, by 2 of 4 accepted acts: F1 = 1/4 / (3/4)."""
    rows = [row(hour=9), row(hour=10), failed(hour=11)]
    assert score(rows, "predicate") == pytest.approx(2 / 3)
    assert score(rows, "help") == pytest.approx(1 / 3)
    assert score(rows, "help", "recall") == 0.25
    assert score([failed()], "predicate") is None
    assert score([failed()], "help") is None


def test_only_a_persons_last_day_counts_in_the_main_table() -> None:
    rows = [row(day=0, predicate_tp=0), row(day=1)]
    assert last_day(rows)["ours"].interval.mean == pytest.approx(2 / 3)
    assert curve(rows, lambda one: one.day)["ours"] == {0: 0.0, 1: pytest.approx(2 / 3)}


def test_methods_are_compared_with_the_reference_on_the_same_days() -> None:
    rows = [row(day=1), row("random", day=1, predicate_fp=3), row("random", person="bruno", day=1)]
    [found] = comparisons(rows, "ours")
    assert (found.method, found.people) == ("random", 1)
    assert found.difference.mean == pytest.approx(2 / 5 - 2 / 3)


def life(method: str, person: str, *helped: int) -> list[Row]:
    """A day of one hour for each: of four tasks so many were helped, by as many of four accepted acts (need F1 / 4)."""
    days = enumerate(helped)
    return [row(method, person, day=d, helped=n, done=4, useless=4 - n, accepted=4) for d, n in days]


def test_the_primary_endpoint_is_the_mean_of_the_late_days() -> None:
    """Of five days the last third, rounded up, is two: (3/4 + 4/4) / 2. Days 2 and 3 of the five are the early ones."""
    rows = [*life("ours", "amara", 0, 1, 2, 3, 4), *life("random", "amara", 0, 1, 1, 1, 1)]
    assert late_days(rows)["ours"].interval.mean == pytest.approx(0.875)
    assert growth(rows, "help")["ours"].interval.mean == pytest.approx(0.875 - 0.375)
    [found] = comparisons(rows, "ours", "help", STATED)
    assert found.difference.mean == pytest.approx(0.25 - 0.875)


def test_of_fifteen_days_the_late_ones_are_11_to_15_and_the_early_ones_2_to_5() -> None:
    assert (STATED.late_days(15), STATED.early_days(15)) == (range(10, 15), range(1, 5))
    assert Endpoint(late=2).late_days(15) == range(13, 15)


def test_whoever_has_no_early_days_has_no_growth() -> None:
    rows = [*life("ours", "amara", 1, 2), *life("ours", "bruno", 0, 1, 2)]
    assert growth(rows, "help")["ours"].n == 1
    assert growth(life("ours", "amara", 1), "help") == {}


def test_tables_name_the_endpoint_that_the_grid_states() -> None:
    rows = [one for person in ("amara", "bruno", "chen") for one in life("ours", person, 0, 1, 2, 3)]
    endpoint = Endpoint.of({"late_days": 1}, "Stated before the first run and kept")
    [table] = [table for table in all_tables(rows, ["ours"], endpoint) if table.name == "late_days"]
    assert table.rows == [["ours", "0.750 [0.750, 0.750] (3)"]]
    assert "and kept; late days: each person's last day of an episode; early days: 2 to 5." in table.note
    old = Endpoint.of({})
    assert (old.late, old.early, old.measure) == (STATED.late, STATED.early, "help")
    assert str(old).startswith("Not stated by this grid; late days: each person's last third")


def test_another_measure_another_test_and_a_narrower_family_can_be_the_endpoint() -> None:
    rows = [one for who in "abcdef" for m in ("ours", "random", "oracle") for one in life(m, who, 0, 1, 2)]
    stated = {"measure": "predicate", "reference": "oracle", "against": ["ours"], "test": "t", "correction": "none"}
    tables = {
        table.name: table for table in all_tables(rows, ["ours", "random", "oracle"], Endpoint.of({"endpoint": stated}))
    }
    assert tables["late_days"].title == "Primary endpoint: predicate F1, mean of the late days"
    found = tables["comparisons_late"]
    assert found.title == "Difference to oracle in predicate F1, mean of the late days"
    assert [(line[0], line[3]) for line in found.rows] == [("ours", "1.0000"), ("random", "–")]
    assert "t test over people" in found.note
    assert "Rows without a corrected p were not among the stated comparisons." in found.note


def test_variants_are_a_control_and_a_noise_floor_and_no_methods_to_compare() -> None:
    """ours 2/4, shared 3/4 of four tasks; sampled again 1/4 once: variance (1/4)^2 / 2 / 3, SD 0.102."""
    kinds = {"ours": 2, "random": 1, "ours+shared": 3, "ours+again1": 2}
    rows = [one for who in ("amara", "bruno", "chen") for m, n in kinds.items() for one in life(m, who, 0, n)]
    odd = {"helped": 1, "useless": 3}
    rows = [row.model_copy(update=odd) if (row.method, row.person, row.day) == ("ours+again1", "chen", 1) else row
            for row in rows]  # fmt: skip
    tables = {table.name: table for table in all_tables(rows, ["ours", "random"])}
    assert [line[0] for line in tables["comparisons_late"].rows] == ["random"]
    assert tables["control_shared"].rows[0][3] == "+0.250 [+0.250, +0.250]"
    [sampled] = tables["noise"].rows
    assert sampled[:2] == ["ours", "same days, replies sampled anew"]
    assert (sampled[2][:5], sampled[3]) == ("0.102", "3")
    assert tables["comparisons_late"].columns[-1] == "noise floor"
    assert "+" not in "".join(line[0] for line in tables["late_days"].rows)


def test_two_people_get_no_interval_and_no_detectable_difference() -> None:
    rows = [one for who in ("amara", "bruno") for m in ("ours", "random") for one in life(m, who, 0, 1, 2)]
    tables = {table.name: table for table in all_tables(rows, ["ours", "random"])}
    assert tables["late_days"].rows[0] == ["ours", "0.500 (2)"]
    assert "detectable" not in tables["comparisons_late"].columns
    assert tables["comparisons_late"].rows == [["random", "+0.000 (n too small)", "1.0000", "1.0000", "2"]]


def test_a_table_of_before_the_accepted_acts_were_counted_is_read_and_they_are_computed() -> None:
    """tp 1 and fp 1: two were accepted."""
    lines = [line.rsplit(",", 1)[0] for line in to_csv([row(), failed(hour=10)]).splitlines()]
    first, second = from_csv("\n".join(lines), "hours.csv")
    assert first == row()
    assert second.accepted is None


def test_generalisation_takes_the_last_day_of_the_episode_alone() -> None:
    rows = [row(m, day=d, setting="2", predicate_fp=f) for m, d, f in
            (("ours", 0, 9), ("ours", 1, 0), ("untrained", 0, 9), ("untrained", 1, 2))]  # fmt: skip
    found = generalisation(rows, "2", "ours", "untrained")
    assert found is not None
    assert [cell.interval.mean for cell in found] == pytest.approx([0.5, 1.0])
    assert generalisation(rows, "3+1", "ours", "untrained") is None


def test_effort_is_per_scored_hour() -> None:
    assert effort([row(hour=9), row(hour=10), failed(hour=11)])["ours"] == (1.0, 2.5, 1.0)


def test_agreement_is_the_l1_of_hourly_f1() -> None:
    """Predicate 2/3 in both hours; the person 1 in one of them: (1/3 + 0) / 2."""
    rows = [row(hour=9, people_fp=0), row(hour=10)]
    assert agreement(rows, "predicate") == pytest.approx(1 / 6)


def test_tables_and_figures_are_drawn_of_whatever_there_is() -> None:
    rows = [row(m, person=p, day=d) for m in ("ours", "random") for p in ("amara", "bruno") for d in (0, 1)]
    tables = {table.name: table for table in all_tables(rows, ["ours", "random"])}
    assert "| ours | 0.667 | 0.505 |" in tables["paper"].markdown()
    assert r"\label{tab:comparisons}" in tables["comparisons"].latex()
    assert r"95 \%" in tables["last_day_predicate"].latex()
    drawn = all_figures(rows, ["ours", "random"])
    assert drawn == all_figures(rows, ["ours", "random"])
    assert "generalisation" not in tables
    days = re.findall(r">(\d)</text>", drawn["breakdown_predicate"])
    assert set(days) == {"0", "1"}, "days are counted from 0"


class Walked(Frozen):
    steps: int
    metres: float | None = None


def test_a_further_measure_has_columns_and_a_table_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring._MEASURES, "_registered", {})
    measuring.register_measure(
        MeasureSpec("walked", "", "metres walked", Walked, lambda _: Walked(steps=0), sums(Walked), "metres")
    )
    rows = [row(hour=9, walked_steps=4, walked_metres=1.5), row(hour=10, walked_steps=2, walked_metres=2.0)]
    rows.append(failed(hour=11))
    text = to_csv(rows)
    assert text.splitlines()[0].endswith(",saved_metres,accepted,walked_steps,walked_metres")
    assert from_csv(text, "hours.csv") == rows
    assert score(rows, "walked") == 3.5
    titles = [table.title for table in all_tables([row(day=1, walked_steps=1, walked_metres=0.5)], ["ours"])]
    heads = ["Primary endpoint: need F1, mean of the late days", "Need precision, recall and F1, all days"]
    assert titles[:7] == [
        *heads,
        *(f"F1 by {name} on each person's last day" for name in ("predicate", "judge", "people")),
        "Need F1 on each person's last day",
        "Metres walked on each person's last day",
    ]
    with pytest.raises(ConfigError, match="walked_steps: this column is missing"):
        score([row(walked_metres=1.5)], "walked")


def test_a_column_that_is_no_measures_is_refused() -> None:
    with pytest.raises(ConfigError, match="the columns must be those of format 1; check Note"):
        from_csv(to_csv([row()]).replace("accepted", "accepted,Note", 1), "hours.csv")
