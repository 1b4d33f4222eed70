from __future__ import annotations

import csv
import errno
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from coopera.config.schema import Config
from coopera.core.errors import ConfigError, ModelCallError, RunError, StoppedError
from coopera.core.hour import FeedbackItem, HourRecord, HumanHour
from coopera.evaluation.measuring import all_measures
from coopera.people.shipped import find
from coopera.rundir.directory import RunDir
from coopera.rundir.stopping import Stop
from coopera.rundir.summary import summarise
from coopera.rundir.trace_files import read_record
from coopera.studies.study import resume_study
from tests.coopera.fake_run import fake_run


def measures_with_rows() -> list[str]:
    return [one.name for one in all_measures() if one.row is None]


def start(out: Path) -> RunDir:
    config = Config(humans=["amara"], scenes=["maple"], days=1, hours=2, out=out)
    people = [find("amara", config.data_dir)]
    return RunDir.create(config, people=people, prompts={"human/intention": "ab"}, models={"human": "offline"})


def info(run: RunDir) -> dict[str, object]:
    return json.loads((run.root / "run.json").read_text())


@pytest.fixture
def run(tmp_path: Path) -> Iterator[RunDir]:
    with start(tmp_path / "run") as run:
        yield run


def failed_hour(day: int, hour: int) -> HourRecord:
    return HourRecord(
        day=day, episode=0, episode_day=day, hour=hour, person="amara", scene="maple",
        human=None, robot=None, world={}, success=None, status="failed", reason="no reply",
    )  # fmt: skip


def test_a_new_run_says_who_writes_it_and_with_what(run: RunDir) -> None:
    found = info(run)
    assert (found["state"], found["pid"], found["schema"]) == ("running", os.getpid(), 2)
    assert {"coopera", "python", "langgraph"} <= set(found["versions"])
    assert found["prompts"] == {"human/intention": "ab"}
    assert run.people()["amara"].name == "Amara Osei"


def test_records_come_back_as_they_were_written(small_run: RunDir) -> None:
    records = small_run.hours()
    assert [(record.day, record.hour) for record in records[:9]] == [(0, hour) for hour in range(9, 17)] + [(1, 9)]
    assert records[8].episode_day == 1
    assert [evening.day for evening in small_run.evenings()] == [0, 1, 2, 3]


def test_the_trace_has_the_fields_that_other_programs_read(small_run: RunDir) -> None:
    hour = json.loads((small_run.root / "trace/day-00/hour-10.json").read_text())
    assert set(hour["human"]["found"]) >= {"objects", "motions"}
    assert len(hour["human"]["found"]["objects"]) == len(hour["human"]["found"]["fixed"]) + len(
        hour["human"]["found"]["movable"]
    )
    assert hour["robot"]["frames"] == ["frames/day-00/hour-10/" + name for name in FRAMES]
    assert all({"task", "ok", "reason"} <= set(outcome) for outcome in hour["robot"]["outcomes"])
    assert "moved" in hour["world"]


FRAMES = ["robot-0.webp", "robot-1.webp", "human-0.webp", "human-1.webp"]


def test_two_equal_runs_are_equal_byte_for_byte_but_for_the_clock(tmp_path: Path) -> None:
    runs = [fake_run(tmp_path / name, days=1, hours=3, frames=1) for name in ("a", "b")]
    other = fake_run(tmp_path / "c", days=1, hours=3, frames=1, seed=1)

    def content(run: RunDir) -> dict[str, bytes]:
        files = sorted(path for path in run.root.rglob("*") if path.is_file() and path.name != "run.json")
        return {path.relative_to(run.root).as_posix(): path.read_bytes() for path in files}

    assert content(runs[0]) == content(runs[1])
    assert content(runs[0])["metrics.csv"] != content(other)["metrics.csv"]


def test_an_hour_written_again_replaces_the_first(run: RunDir) -> None:
    run.write_hour(failed_hour(0, 9))
    run.write_hour(failed_hour(0, 9).model_copy(update={"reason": "again"}))
    assert [record.reason for record in run.read_day(0)] == ["again"]


def test_metrics_have_a_row_per_hour_and_measure(small_run: RunDir) -> None:
    rows = list(csv.DictReader((small_run.root / "metrics.csv").read_text().splitlines()))
    measures = measures_with_rows()
    assert [row["measure"] for row in rows] == measures * (2 * 2 * 8)
    failed = [row for row in rows if row["status"] == "failed"]
    assert [(row["day"], row["hour"], row["f1"]) for row in failed] == [("1", "16", "")] * len(measures)


def _mended(human: HumanHour | None, times: int) -> HumanHour | None:
    return human and human.model_copy(update={"repairs": ["Task 9.1 was dropped."] * times})


def test_the_summary_adds_up_the_hours_of_a_day(small_run: RunDir) -> None:
    summary = json.loads((small_run.root / "summary.json").read_text())
    assert summary == small_run.summary()
    assert (summary["failed_hours"], summary["people"], len(summary["days"])) == (1, ["amara", "bruno"], 4)
    assert [day["episode"] for day in summary["days"]] == [0, 0, 1, 1]
    mended = [hour.model_copy(update={"human": _mended(hour.human, 2)}) for hour in small_run.read_day(0) if hour.human]
    assert summarise(small_run.config, mended)["repairs"] == 2 * len(mended) > 0 == summary["repairs"]
    day, hours = summary["days"][0]["predicate"], small_run.read_day(0)
    tp, fp, fn = (sum(getattr(hour.success.predicate, name) for hour in hours) for name in ("tp", "fp", "fn"))
    assert (day["tp"], day["fp"], day["fn"]) == (tp, fp, fn)
    assert day["f1"] == pytest.approx(2 * tp / (2 * tp + fp + fn), abs=1e-12)
    calls = [call for hour in small_run.hours() for call in hour.calls]
    evening = [call for one in small_run.evenings() for call in one.calls]
    assert summary["calls"] == len(calls) + len(evening)
    assert summary["tokens"] == sum(call.tokens_in + call.tokens_out for call in [*calls, *evening])


def test_agreement_with_the_person_is_hour_by_hour(small_run: RunDir) -> None:
    hours = [hour.model_copy(update={"day": 0}) for hour in small_run.hours() if hour.robot and hour.success][:2]
    answers = [
        FeedbackItem(hour=hour.hour, kind="task", text=t.act.describe(), accepted=bool(t.accepted), helpful=t.correct)
        for hour in hours
        for t in (hour.robot.tasks if hour.robot else [])
    ]
    evening = small_run.evenings()[0].model_copy(update={"day": 0, "feedback": answers})
    assert summarise(small_run.config, hours, [evening])["agreement"]["predicate"] == 0
    assert summarise(small_run.config, hours)["agreement"] == dict.fromkeys(("predicate", "judge", "similar"))


@pytest.mark.parametrize(
    ("error", "state", "reason"),
    [
        (ModelCallError("the server is away"), "failed", "the server is away"),
        (ZeroDivisionError("oops"), "failed", "ZeroDivisionError: oops"),
        (KeyboardInterrupt(), "stopped", "interrupted"),
        (None, "stopped", "the work ended before it was complete"),
    ],
)
def test_how_the_work_ended_is_recorded(tmp_path: Path, error: BaseException | None, state: str, reason: str) -> None:
    def work() -> RunDir:
        with start(tmp_path / "run") as run:
            if error:
                raise error
            return run

    if error:
        with pytest.raises(type(error)):
            work()
    else:
        work()
    run = RunDir.open(tmp_path / "run")
    assert (run.state, run.info["reason"]) == (state, reason)
    assert run.info["ended"]


def test_ctrl_c_ends_the_work_of_other_threads_at_their_next_record(tmp_path: Path) -> None:
    stopped_at: list[int] = []
    begun = threading.Event()

    def live(run: RunDir) -> None:
        for hour in range(9, 10_000):
            try:
                run.write_hour(failed_hour(0, hour))
            except RunError:
                stopped_at.append(hour)
                return
            begun.set()

    def work() -> None:
        with start(tmp_path / "run") as run:
            worker = threading.Thread(target=live, args=[run])
            worker.start()
            try:
                begun.wait()
                signal.raise_signal(signal.SIGTERM)
            finally:
                worker.join()

    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt):
        work()
    assert stopped_at
    assert RunDir.open(tmp_path / "run").state == "stopped"
    assert signal.getsignal(signal.SIGTERM) == before


def test_a_run_is_stopped_by_what_stops_all(tmp_path: Path) -> None:
    with Stop() as stop:
        run = RunDir.create(Config(out=tmp_path / "run"), people=[], prompts={}, models={}, stop=stop)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(StoppedError), run:
            run.write_hour(failed_hour(0, 9))
    assert RunDir.open(tmp_path / "run").state == "stopped"


def test_a_finished_run_is_finished_and_not_resumed(run: RunDir) -> None:
    run.write_hour(failed_hour(0, 9))
    run.finish()
    assert info(run)["state"] == "finished"
    with pytest.raises(RunError, match="this run is finished"):
        RunDir.resume(run.root)


def test_a_stopped_run_goes_on_with_what_it_has(tmp_path: Path) -> None:
    with start(tmp_path / "run") as run:
        run.write_hour(failed_hour(0, 9))
    (run.root / "trace" / "day-00" / ".hour-10.json.77.tmp").write_text("half")
    with RunDir.resume(run.root) as again:
        assert again.state == "running"
        again.write_hour(failed_hour(0, 10))
        again.finish()
    assert len((run.root / "metrics.csv").read_text().splitlines()) == 1 + 2 * len(measures_with_rows())
    assert not list(run.root.rglob(".*.tmp"))


def test_two_writers_are_never_let_in(run: RunDir) -> None:
    with pytest.raises(RunError, match="another process is writing this run"):
        RunDir.resume(run.root)


def test_a_run_of_a_living_process_is_refused_and_of_a_dead_one_taken_over(tmp_path: Path) -> None:
    with start(tmp_path / "run") as run:
        pass
    sleeper = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    claimed = info(run) | {"state": "running", "pid": sleeper.pid, "pid_start": None}
    (run.root / "run.json").write_text(json.dumps(claimed))
    with pytest.raises(RunError, match=f"process {sleeper.pid} is still writing this run"):
        RunDir.resume(run.root)
    sleeper.communicate()
    with RunDir.resume(run.root) as again:
        assert again.info["pid"] == os.getpid()


def test_a_reused_process_number_is_not_taken_for_the_writer(tmp_path: Path) -> None:
    with start(tmp_path / "run") as run:
        pass
    claimed = info(run) | {"state": "running", "pid": os.getppid(), "pid_start": 1}
    (run.root / "run.json").write_text(json.dumps(claimed))
    with RunDir.resume(run.root) as again:
        assert again.state == "running"


def test_a_run_whose_writer_is_gone_does_not_say_that_it_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, text: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    with pytest.raises(RunError, match="the memory is full"), start(tmp_path / "run") as run:  # noqa: PT012
        monkeypatch.setattr("coopera.rundir.directory.write_atomic", full)
        raise RunError("the memory is full")
    monkeypatch.undo()
    assert info(run)["state"] == "running"
    assert RunDir.open(run.root).state == "running"  # this process still is
    claimed = info(run) | {"pid_start": 1}
    (run.root / "run.json").write_text(json.dumps(claimed))
    assert RunDir.open(run.root).state == "stopped"


def test_a_folder_that_is_taken_is_left_as_it_was(tmp_path: Path) -> None:
    with start(tmp_path / "run"):
        pass
    before = sorted(path.name for path in (tmp_path / "run").iterdir())
    with pytest.raises(ConfigError, match="already holds another run"):
        start(tmp_path / "run")
    assert sorted(path.name for path in (tmp_path / "run").iterdir()) == before
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    with pytest.raises(ConfigError, match="is not empty"):
        start(tmp_path / "full")
    assert [path.name for path in (tmp_path / "full").iterdir()] == ["notes.txt"]


@pytest.mark.parametrize("out", ["file", "file/run", "a/b/" + "x" * 300])
def test_a_folder_that_cannot_be_written_is_refused_and_nothing_is_left(tmp_path: Path, out: str) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="^out: "):
        start(tmp_path / out)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_start_that_fails_half_way_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, text: str) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("coopera.rundir.directory.write_atomic", full)
    with pytest.raises(ConfigError, match="no space left on device"):
        start(tmp_path / "deep" / "run")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("file", "text", "sentence"),
    [
        ("run.json", "{", "run.json: the file is damaged"),
        ("run.json", "{}", "the field schema is missing"),
        ("run.json", '{"schema": 99}', "schema 99 was written by a newer coopera"),
    ],
)
def test_a_damaged_run_is_refused_in_one_sentence(tmp_path: Path, file: str, text: str, sentence: str) -> None:
    with start(tmp_path / "run") as run:
        pass
    (run.root / file).write_text(text)
    with pytest.raises(RunError, match=sentence):
        RunDir.open(run.root)


def as_schema_1(root: Path, state: str) -> None:
    """Write a run again as the first version did: its belief about the person was called a picture."""
    for path in root.glob("trace/*/*.json"):
        path.write_text(path.read_text().replace('"belief":', '"picture":'))
    said = json.loads((root / "run.json").read_text())
    (root / "run.json").write_text(json.dumps(said | {"schema": 1, "state": state}))


def test_a_run_of_the_first_version_is_read_with_the_names_of_today(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=2, hours=2, frames=1)
    before = [record.model_dump() for record in (*run.hours(), *run.evenings())]
    as_schema_1(run.root, "finished")
    again = RunDir.open(run.root)
    assert [record.model_dump() for record in (*again.hours(), *again.evenings())] == before


def test_a_run_of_the_first_version_is_not_gone_on_with(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=1, frames=1)
    as_schema_1(run.root, "stopped")
    with pytest.raises(RunError, match="schema 1 was written by an older coopera"):
        resume_study(run.root)


def test_a_damaged_hour_is_named_with_its_field(tmp_path: Path) -> None:
    with start(tmp_path / "run") as run:
        run.write_hour(failed_hour(0, 9))
    path = run.root / "trace" / "day-00" / "hour-09.json"
    path.write_text(path.read_text().replace('"status": "failed"', '"status": "odd"'))
    with pytest.raises(RunError, match=r"hour-09\.json: the field status is damaged"):
        run.hours()


def test_an_hour_done_again_starts_with_an_empty_folder_of_frames(run: RunDir) -> None:
    (run.frames_folder(0, 9) / "robot-0.webp").write_bytes(b"old")
    assert list(run.frames_folder(0, 9).iterdir()) == []


def test_a_number_that_is_not_finite_never_reaches_the_trace(run: RunDir) -> None:
    record = failed_hour(0, 9).model_copy(update={"world": {"x": float("nan")}})
    with pytest.raises(RunError, match="cannot be written as JSON"):
        run.write_hour(record)
    assert run.read_day(0) == []


def test_runs_of_before_the_accepted_acts_were_counted_have_need_figures_all_the_same(tmp_path: Path) -> None:
    """Each accepted candidate was an act; those whose verdict is unscored are in no count, so there are none here."""
    run = fake_run(tmp_path / "run", days=2, hours=2, frames=1)
    hours = [hour for hour in run.hours() if hour.robot and hour.success and not hour.success.predicate.unscored]
    assert hours
    for hour in hours:
        path = run.root / f"trace/day-{hour.day:02d}/hour-{hour.hour:02d}.json"
        data = json.loads(path.read_text())
        del data["success"]["help"]["accepted"]
        path.write_text(json.dumps(data))
        again = read_record(path, HourRecord)
        assert again.success == hour.success
        assert again.success is not None
        assert again.success.help is not None
        assert hour.robot is not None
        assert again.success.help.accepted == len(hour.robot.outcomes)
    assert RunDir.open(run.root).summary()["need"] == run.summary()["need"]
