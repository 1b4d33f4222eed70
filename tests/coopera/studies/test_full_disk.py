"""A disk that takes no more: a sentence, a state that is true, and a run that is gone on with once there is room.

The default test has the system refuse files that grow beyond a size, whoever writes them: Python, SQLite or Chroma. The
slow one refuses single writes of a whole program, as `benchmarks/full_disk.py` does with each of them.
"""

from __future__ import annotations

import json
import resource
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from coopera import Config, resume_study, run_study
from coopera.core.errors import CooperaError
from coopera.rundir.directory import RunDir

KILOBYTE = 1024


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Have the system refuse to let any file of this process grow beyond a size, in bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def short(out: Path, data: Path) -> Config:
    return Config(days=1, hours=1, pictures="none", out=out, data_dir=data)


def result(run: Path) -> dict[str, Any]:
    found: dict[str, Any] = {name: (run / name).read_bytes() for name in ("metrics.csv", "summary.json")}
    for path in (run / "trace").rglob("*.json"):
        record = json.loads(path.read_text())
        for call in record.get("calls", []):
            call.pop("seconds")
        found[path.relative_to(run).as_posix()] = record if "calls" in record else None
    return found


@pytest.fixture(scope="module")
def whole(letters: Path) -> dict[str, Any]:
    out = letters.parent / "whole"
    run_study(short(out, letters))
    return result(out)


@pytest.mark.parametrize("size", [36, 160, 250])
def test_a_file_that_can_grow_no_more_ends_the_run_with_our_error_and_with_room_it_goes_on(
    size: int, letters: Path, whole: dict[str, Any], tmp_path: Path
) -> None:
    out = tmp_path / "run"
    with pytest.raises(CooperaError), files_of_at_most(size * KILOBYTE):
        run_study(short(out, letters))
    run = RunDir.open(out)
    assert run.state == "failed"
    assert run.info["reason"]
    resume_study(out)
    assert result(out) == whole


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux" or shutil.which("cc") is None, reason="needs a C compiler and Linux")
def test_a_full_disk_is_always_a_sentence_and_always_gone_on_from(tmp_path: Path, data_dir: Path) -> None:
    record = tmp_path / "trials.jsonl"
    places = r"lock|memory/chroma|header|checkpoints.sqlite-wal|hour-|examples|evening|summary|report|mkdir"
    command = ["-W", "ignore", "-m", "benchmarks.full_disk", "--hours", "1", "--each", "500", "--named", places]
    subprocess.run([sys.executable, *command, "--record", str(record)], check=True, capture_output=True)
    trials = [json.loads(line) for line in record.read_text().splitlines()]
    assert len(trials) > 20
    assert [trial for trial in trials if trial["wrong"]] == []
