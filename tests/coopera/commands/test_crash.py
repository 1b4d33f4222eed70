"""Whatever goes wrong, the command line says it in one sentence, and what nobody foresaw stands in a log."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.report import page
from coopera.rundir import crash
from coopera.rundir.directory import RunDir
from tests.coopera.conftest import Said

Report = Callable[[BaseException], Said]
VERSION = [sys.executable, "-m", "coopera.cli", "--version"]


@pytest.fixture
def report(coopera: Callable[..., Said], small_run: RunDir, monkeypatch: pytest.MonkeyPatch) -> Report:
    """The command `coopera report`, which fails with an error."""

    def failing(error: BaseException) -> Said:
        def write_report(run: RunDir) -> Path:
            raise error

        monkeypatch.setattr(page, "write_report", write_report)
        return coopera("report", small_run.root)

    return failing


def test_what_nobody_foresaw_is_one_sentence_and_a_log_with_the_place_and_without_secrets(
    report: Report, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-very-secret")
    said = report(TypeError("odd: http://me:pass@host/v1\nwith sk-very-secret"))
    assert said.code == 1
    [sentence] = said.err.splitlines()
    assert sentence.startswith("coopera: coopera failed unexpectedly (test_crash.py, line ")
    assert "TypeError: odd: http://***@host/v1 with ***. Details: " in sentence
    [log] = (tmp_path / "data" / "crashes").iterdir()
    assert str(log) in sentence
    text = log.read_text()
    assert "Traceback" in text
    assert f"coopera report {os.sep}" in text
    assert not [word for word in ("sk-very-secret", "me:pass") if word in said.err + text]
    assert log.stat().st_mode & 0o777 == 0o600


def test_the_log_goes_elsewhere_where_the_data_folder_cannot_be_written_and_nowhere_at_worst(
    report: Report, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "data").write_text("a file")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    assert f"Details: {tmp_path / 'coopera-'}" in report(LookupError("x")).err

    def full(file: Path, text: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(file))

    monkeypatch.setattr(crash, "_write", full)
    assert "LookupError: x. No log of it could be written." in report(LookupError("x")).err


def test_a_full_disk_is_one_sentence_with_the_file(report: Report, tmp_path: Path) -> None:
    said = report(OSError(errno.ENOSPC, "No space left on device", "there/summary.json"))
    assert (said.code, said.err) == (1, "coopera: there/summary.json: no space left on device; make room, and go on.\n")
    assert not (tmp_path / "data").exists()


def test_a_pipe_to_somebody_else_that_breaks_is_not_taken_for_a_closed_output(report: Report) -> None:
    said = report(BrokenPipeError(errno.EPIPE, "Broken pipe"))
    assert (said.code, said.err) == (1, "coopera: The system refuses this: broken pipe.\n")


def test_ctrl_c_ends_any_command_with_130_and_no_word(report: Report) -> None:
    said = report(KeyboardInterrupt())
    assert (said.code, said.err.strip()) == (130, "")


def test_paths_that_no_system_takes_are_refused_in_a_sentence(coopera: Callable[..., Said]) -> None:
    for command in (["trace"], ["report"], ["resume"], ["run", "--scenes", "maple", "--out"]):
        said = coopera(*command, "x" * 500)
        assert said.code in (1, 2)
        assert said.err.startswith("coopera: "), said.err
        assert "file name too long" in said.err


def test_a_path_that_is_no_utf_8_is_refused_before_anything_is_written(
    coopera: Callable[..., Said], tmp_path: Path
) -> None:
    said = coopera("run", "--scenes", "maple", "--out", os.fsdecode(b"new/\xff"))
    assert (said.code, said.err.count("coopera: "), "must be UTF-8" in said.err) == (2, 1, True), said.err
    assert not (tmp_path / "new").exists()


def test_an_output_that_is_full_is_a_sentence_and_one_that_nobody_reads_is_none() -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(VERSION, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.splitlines()) == (
        1,
        ["coopera: The system refuses this: no space left on device; make room, and go on."],
    )
    end, start = os.pipe()
    os.close(end)
    with open(start, "w") as unread:
        done = subprocess.run(VERSION, stdout=unread, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "")


def test_an_error_of_the_system_names_its_file_if_it_has_one() -> None:
    assert crash.in_words(OSError(errno.EROFS, "Read-only file system", "a/b")) == "a/b: read-only file system."
