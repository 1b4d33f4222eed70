"""The benchmark as a user meets it: killed and started again, on one worker and on two. Slow."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from coopera.benchmark.grid_runs import do_run
from coopera.cli import main
from coopera.core.errors import RunError
from coopera.rundir.claim import lock

GRID = ["--methods", "ours,frequency_prior", "--settings", "1", "--episodes", "2", "--days", "2", "--hours", "2"]
RESULTS = ("hours.csv", "tables.md", "tables.tex", "figures/breakdown_predicate.svg")


def command(out: Path, *more: str) -> list[str]:
    return [sys.executable, "-m", "coopera.cli", "benchmark", *GRID, "--out", str(out), *more]


def results(out: Path) -> dict[str, str]:
    return {name: (out / "results" / name).read_text().removeprefix(f"# Results of {out.name}\n") for name in RESULTS}


@pytest.mark.slow
def test_five_kills_at_random_moments_change_no_file(tmp_path: Path) -> None:
    subprocess.run(command(tmp_path / "calm"), check=True)
    rng = random.Random(5)
    for _ in range(5):
        running = subprocess.Popen(command(tmp_path / "killed", "--workers", "2"))
        done = len(list((tmp_path / "killed").rglob("hour-*.json")))
        until = time.monotonic() + 300
        while time.monotonic() < until and running.poll() is None:
            if len(list((tmp_path / "killed").rglob("hour-*.json"))) > done + rng.randint(0, 3):
                break
            time.sleep(0.1)  # noqa: TID251 - waits for another process to be at work
        running.send_signal(signal.SIGKILL)
        running.wait()
    subprocess.run(command(tmp_path / "killed", "--workers", "2"), check=True)
    assert results(tmp_path / "killed") == results(tmp_path / "calm")


@pytest.mark.slow
def test_one_worker_two_workers_and_ray_give_the_same_files(tmp_path: Path) -> None:
    pytest.importorskip("ray")
    for name, flags in (("one", ["--workers", "1"]), ("two", ["--workers", "2"]), ("ray", ["--ray", "local"])):
        subprocess.run(command(tmp_path / name, *flags), check=True, env={**os.environ, "RAY_USAGE_STATS_ENABLED": "0"})
    assert results(tmp_path / "one") == results(tmp_path / "two") == results(tmp_path / "ray")


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--methods", "our"], "there is no method 'our'"),
        (["--methods", ""], "methods is empty, so there is nothing to run"),
        (["--settings", "5"], "there is no setting '5'"),
        (["--collab", "both"], "must be numbers such as 1,2"),
        (["--humans", "nobody"], "there is no person 'nobody'"),
        (["--settings", "2", "--scenes", "maple"], "setting 2 needs 5 homes, and there are 1: maple"),
    ],
)
def test_wrong_input_is_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], flags: list[str], sentence: str
) -> None:
    assert main(["benchmark", *flags, "--out", str(tmp_path / "out")]) == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_benchmark_in_a_folder_in_which_another_one_works_is_refused_and_touches_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    live = tmp_path / "out" / "runs" / "live"
    live.mkdir(parents=True)
    (tmp_path / "out" / "grid.yaml").write_text("")
    with lock(tmp_path / "out", "benchmark"):
        assert main(["benchmark", "--episodes", "1", "--days", "1", "--out", str(tmp_path / "out")]) == 1
    assert "another process is writing this benchmark; stop it first" in capsys.readouterr().err
    assert live.is_dir()


def test_a_run_that_a_worker_elsewhere_still_writes_is_not_removed(tmp_path: Path) -> None:
    job = SimpleNamespace(folder=tmp_path / "run")
    job.folder.mkdir()
    with lock(job.folder), pytest.raises(RunError, match="another process is writing this run"):
        do_run(job)
    assert job.folder.is_dir()


def test_a_misspelt_field_of_a_grid_file_is_named_with_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    grid = tmp_path / "grid.yaml"
    grid.write_text("method: [ours]\n")
    assert main(["benchmark", str(grid), "--out", str(tmp_path / "out")]) == 2
    assert "grid.yaml: there is no field 'method' (did you mean methods?)" in " ".join(capsys.readouterr().err.split())


def test_a_leaderboard_names_the_results_of_another_version(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "results.json").write_text('{"format": 99}')
    (tmp_path / "theirs" / "hours.csv").write_text("")
    assert main(["leaderboard", str(tmp_path)]) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "theirs/results.json: the results are of format 99, and this coopera reads format 1" in said
    assert main(["leaderboard", str(tmp_path / "nowhere")]) == 2
