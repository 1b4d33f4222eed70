from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run
from tests.evaluation.people.tables import rows, write

Coopera = Callable[..., Said]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three people with six days each, of which the last is a Saturday, hours 9 to 13."""
    folder = tmp_path_factory.mktemp("lives") / "run"
    fake_run(folder, people=("amara", "bruno", "chen"), days=6, hours=5, frames=1)
    return folder


def test_a_table_of_time_use_adds_figures_a_file_of_hours_and_a_picture(coopera: Coopera, run: Path) -> None:
    said = coopera("analyse", "humans", run, "--time-use", "shipped", "--out", "found", "--json")
    assert said.code == 0, said.err
    figures = {(one["check"], one["measure"], one["variant"]): one for one in said.json["figures"]}
    for kind, days in (("weekday", 15), ("weekend", 3)):
        for stratum in ("O1", "O2"):
            distance = figures["time use", f"distance, {kind}, {stratum}", "full"]
            assert 0 < distance["value"] <= 1
            assert distance["n"] == 3
            assert f"{days} person-days" in distance["note"]
    assert figures["time use", "O1 from O2, weekday", "table"]["value"] > 0
    assert figures["time use by category", "tv, more hours a day, weekday, O1", "full"]["value"] is not None
    assert 0 <= figures["days with", "breakfast", "full"]["value"] <= 1
    assert "American Time Use Survey" in said.json["time_use"]["source"]
    assert said.json["command"].endswith("--time-use shipped --out found")
    assert json.loads(Path("found/people.json").read_text())["figures"] == said.json["figures"]
    hours = list(csv.DictReader(Path("found/time-use.csv").read_text().splitlines()))
    assert len(hours) == 2 * 2 * 5 * 9
    assert Path("found/time-use.png").read_bytes().startswith(b"\x89PNG")


def test_the_screen_shows_the_distances_and_leaves_the_categories_to_the_files(coopera: Coopera, run: Path) -> None:
    said = coopera("analyse", "humans", run, "--time-use", "atus", "--stratum", "O2", "--out", "found")
    assert said.code == 0, said.err
    assert "distance, weekday, O2" in said.out
    assert "O1" not in said.out
    assert "by category in found/people.md" in said.out
    assert "hours shifted" not in said.out
    assert "tv, hours shifted, weekday, O2" in Path("found/people.md").read_text()
    assert "Table: American Time Use Survey 2022-23" in said.out


def test_a_table_of_ones_own_is_taken_and_a_wrong_one_refused_before_any_work(coopera: Coopera, run: Path) -> None:
    week = rows("city", "weekday", lambda hour: {"other": 100.0})
    write(Path("own.csv"), week)
    said = coopera("analyse", "humans", run, "--time-use", "own.csv", "--json")
    assert said.code == 0, said.err
    assert said.json["time_use"] == {"table": "own.csv", "strata": ["city"], "source": "own.csv"}
    write(Path("short.csv"), week[:-9])
    said = coopera("analyse", "humans", run, "--time-use", "short.csv")
    assert said.code == 2
    assert said.err.startswith("coopera: short.csv, stratum city, weekday, hour 23: the hour is missing")
    assert said.err.count("\n") == 1


def test_a_stratum_needs_a_table_that_has_it(coopera: Coopera, run: Path) -> None:
    said = coopera("analyse", "humans", run, "--stratum", "O1")
    assert said.code == 2
    assert "--stratum: it names people in a table, so it needs --time-use" in said.err
    said = coopera("analyse", "humans", run, "--time-use", "shipped", "--stratum", "O9")
    assert said.code == 2
    assert "'O9' is not in the table, which has O1, O2" in said.err
