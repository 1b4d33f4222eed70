"""An hour away from home: no tasks, no robot, no figure, and no failure, wherever a run is read."""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from coopera.core.hour import Found, HumanHour, Intention
from coopera.report.page import write_report
from coopera.report.tree import print_trees
from coopera.rundir.directory import RunDir
from coopera.rundir.export import export
from coopera.rundir.lives import read_lives
from coopera.rundir.summary import metrics_rows
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run

Cli = Callable[..., Said]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> RunDir:
    """Two people, a day each of four hours; at 10 am of day 0 the first is at work."""
    root = tmp_path_factory.mktemp("runs") / "away"
    fake_run(root, people=("amara", "bruno"), days=1, hours=4, frames=1, finished=False)
    nothing = Found(fixed={}, movable={}, motions=[])
    away = HumanHour(
        recalled=[], intention=Intention(text="Go to work", away=True), found=nothing, tasks=[], reflections=[]
    )
    with RunDir.resume(root) as half:
        record = next(hour for hour in half.read_day(0) if hour.hour == 10)
        half.write_hour(
            record.model_copy(update={"human": away, "robot": None, "success": None, "world": {}, "calls": []})
        )
        half.finish()
    return RunDir.open(root)


def test_no_figure_counts_it_and_it_is_no_failure(run: RunDir) -> None:
    summary = run.summary()
    assert (summary["hours"], summary["failed_hours"], summary["failures"]) == (8, 0, [])
    assert (summary["days"][0]["hours"], summary["days"][0]["failed_hours"]) == (4, 0)
    scored = [hour.success.predicate for hour in run.read_day(0) if hour.success]
    assert len(scored) == 3
    assert summary["days"][0]["predicate"]["tp"] == sum(counts.tp for counts in scored)
    [row, *_] = metrics_rows(next(hour for hour in run.read_day(0) if hour.hour == 10))
    assert (row["status"], row["f1"], row["tp"]) == ("ok", None, None)


def test_report_and_trace_say_that_the_person_was_away(run: RunDir) -> None:
    page = write_report(run).read_text(encoding="utf-8")
    assert page.count('title="day 0, 10 am: away from home">↗</a>') == 1
    assert page.count('<span class="cell none">↗</span>') == 2  # what the sign means, and the hour itself
    said = StringIO()
    print_trees(run, 0, 10, Console(file=said, width=200))
    assert "intention: Go to work (away from home)" in said.getvalue()
    assert "tasks" not in said.getvalue()


def test_the_checks_on_people_take_its_intention_and_no_task(run: RunDir) -> None:
    day = read_lives([run.root]).variants["full"].days[0]
    assert dict(zip(day.hours, day.intentions, strict=True))[10] == "Go to work"
    assert [len(tasks) for tasks in day.tasks][:2] == [len(day.tasks[0]), 0]


def test_a_data_set_marks_it(run: RunDir, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    assert export(run, tmp_path / "set")["hours"] == 8
    rows = parquet.read_table(tmp_path / "set/hours/data/train-00000-of-00001.parquet").to_pylist()
    assert [row["away"] for row in rows] == [False, True, False, False] + [False] * 4
    assert {row["continues"] for row in rows} == {False}
    assert (rows[1]["status"], rows[1]["tasks"], rows[1]["robot_tasks"]) == ("ok", [], [])
    frames = parquet.read_table(tmp_path / "set/episodes/data/chunk-000/file-000.parquet").to_pylist()
    assert 10 not in {row["observation.hour"] for row in frames if row["episode_index"] == 0}


def test_a_day_with_an_hour_away_and_changes_is_replayed_to_the_same_world(coopera: Cli, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("day,hour,intention,away\n0,9,Cook a meal,\n0,10,Go shopping,yes\n0,11,Read,\n")
    flags = ["--played-by", "log:log.csv", "--humans", "amara", "--days", "1", "--hours", "3", "--method", "none"]
    assert coopera("run", *flags, "--changes", "seeded", "--pictures", "none", "--out", "lived").code == 0
    hours = RunDir.open(tmp_path / "lived").read_day(0)
    assert [hour.status for hour in hours] == ["ok"] * 3
    assert [bool(hour.human.tasks) for hour in hours if hour.human] == [True, False, True]
    assert all("season" in [one.kind for one in hour.human.circumstances] for hour in hours if hour.human)
    said = coopera("replay", "lived")
    assert (said.code, said.out.split("(")[0]) == (0, "3 of 3 hours ")
