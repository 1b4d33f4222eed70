"""The trace is the truth about how far a run has come, whatever its checkpoints say."""

from __future__ import annotations

import json
import logging
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coopera import Config, resume_study, run_study
from coopera.core.errors import RunError, StoppedError
from coopera.studies.doctor import examine

Harm = Callable[[Path], object]


def short(out: Path) -> Config:
    return Config(days=2, hours=2, pictures="none", out=out, data_dir=out.parent / "data")


def stopped_in(node: str, day: int) -> Callable[[dict[str, Any]], None]:
    def stop(event: dict[str, Any]) -> None:
        if (event["node"], event["day"]) == (node, day):
            raise StoppedError("The run was interrupted.")

    return stop


def begun(out: Path, node: str, day: int) -> Path:
    with pytest.raises(StoppedError):
        run_study(short(out), on_event=stopped_in(node, day))
    return out


def trace(run: Path) -> dict[str, Any]:
    found = {path.relative_to(run).as_posix(): json.loads(path.read_text()) for path in (run / "trace").rglob("*.json")}
    found = {name: record for name, record in found.items() if not name.endswith("seal.json")}
    for record in found.values():
        for call in record["calls"]:
            call.pop("seconds")
    return found


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("standing") / "whole"
    run_study(short(out))
    return out


@pytest.fixture(scope="module")
def stopped(whole: Path) -> Path:
    """A run that was stopped on its second day."""
    return begun(whole.parent / "stopped", "record", 1)


def copied(run: Path, name: str) -> Path:
    return Path(shutil.copytree(run, run.parent / name))


def lose(run: Path) -> None:
    for part in run.glob("checkpoints.sqlite*"):
        part.unlink()


def cut(run: Path) -> None:
    file = run / "checkpoints.sqlite"
    file.write_bytes(file.read_bytes()[:5000])


def scribble(run: Path) -> None:
    (run / "checkpoints.sqlite").write_bytes(b"no database at all")


@pytest.mark.parametrize("harm", [lose, cut, scribble])
def test_lost_or_damaged_checkpoints_change_nothing_of_what_is_done_next(
    whole: Path, stopped: Path, harm: Harm, caplog: pytest.LogCaptureFixture
) -> None:
    run = copied(stopped, harm.__name__)
    harm(run)
    with caplog.at_level(logging.WARNING):
        resume_study(run)
    assert trace(run) == trace(whole)
    assert (run / "metrics.csv").read_bytes() == (whole / "metrics.csv").read_bytes()
    assert ("the checkpoints are damaged" in caplog.text) == (harm is not lose)


def test_checkpoints_of_an_earlier_hour_have_nothing_done_again(whole: Path) -> None:
    run = begun(whole.parent / "earlier", "end_day", 0)
    older = {part.name: part.read_bytes() for part in run.glob("checkpoints.sqlite*")}
    with pytest.raises(StoppedError):
        resume_study(run, on_event=stopped_in("record", 1))
    stands = {path: path.stat().st_mtime_ns for path in (run / "trace").rglob("*.json")}
    lose(run)
    for name, data in older.items():
        (run / name).write_bytes(data)
    resume_study(run)
    assert trace(run) == trace(whole)
    assert {path: path.stat().st_mtime_ns for path in stands} == stands


def test_checkpoints_that_are_ahead_of_the_trace_are_given_up_and_the_lost_hours_are_lived_again(
    whole: Path, stopped: Path, caplog: pytest.LogCaptureFixture
) -> None:
    run = copied(stopped, "ahead")
    shutil.rmtree(run / "trace/day-01")
    for name in ("evening.json", "seal.json"):
        (run / "trace/day-00" / name).unlink()
    with caplog.at_level(logging.WARNING):
        resume_study(run)
    assert "ahead of the trace" in caplog.text
    assert trace(run) == trace(whole)


def test_a_hole_in_the_trace_is_refused_with_the_name_of_the_file(stopped: Path) -> None:
    run = copied(stopped, "hole")
    (run / "trace/day-00/seal.json").unlink()
    (run / "trace/day-00/hour-10.json").unlink()
    with pytest.raises(RunError, match=r"day-00/hour-10.json: this file is missing, though trace/day-00/evening.json"):
        resume_study(run)


def test_an_altered_home_in_the_trace_is_refused(stopped: Path) -> None:
    run = copied(stopped, "altered")
    (run / "trace/day-00/seal.json").unlink()
    lose(run)
    file = run / "trace/day-00/hour-09.json"
    record = json.loads(file.read_text())
    record["world"]["poses"]["moved"] = {"mug_1": "sofa_1"}
    file.write_text(json.dumps(record))
    with pytest.raises(RunError, match="day 0, 9 am, was altered"):
        resume_study(run)


def test_a_finished_run_is_given_what_it_lacks_and_nothing_else_is_touched(whole: Path) -> None:
    run = copied(whole, "lacks")
    lost = ("report.html", "summary.json", "metrics.csv")
    before = {path: path.read_bytes() for path in run.rglob("*") if path.is_file()}
    for name in lost:
        (run / name).unlink()
    resume_study(run)
    assert {path: path.read_bytes() for path in before if path.name != "report.html"} == {
        path: data for path, data in before.items() if path.name != "report.html"
    }
    assert (run / "report.html").is_file()
    resume_study(run)


def test_damaged_checkpoints_of_a_finished_run_are_given_up(whole: Path, caplog: pytest.LogCaptureFixture) -> None:
    run = copied(whole, "cut at the end")
    file = run / "checkpoints.sqlite"
    file.write_bytes(file.read_bytes()[:5000])
    assert [one.part for one in examine(run)] == ["checkpoints"]
    before = trace(run), (run / "summary.json").read_bytes(), (run / "report.html").read_bytes()
    with caplog.at_level(logging.WARNING):
        resume_study(run)
    assert "the checkpoints are damaged" in caplog.text
    assert not examine(run)
    assert (trace(run), (run / "summary.json").read_bytes(), (run / "report.html").read_bytes()) == before
