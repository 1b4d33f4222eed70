"""Fixtures: one small run that many tests read, and the command line as a function."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from coopera.cli import main
from coopera.rundir.directory import RunDir
from tests.coopera.fake_run import fake_run


class Said(NamedTuple):
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out.splitlines()[-1])


@pytest.fixture(scope="session")
def small_run(tmp_path_factory: pytest.TempPathFactory) -> RunDir:
    """Two people, two days each, hours 9 to 16, of which 4 pm on day 1 failed; read it, never write it."""
    root = tmp_path_factory.mktemp("runs") / "small"
    fake_run(root, people=("amara", "bruno"), days=2, hours=8, frames=2)
    return RunDir.open(root)


@pytest.fixture
def coopera(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., Said]:
    """Run the command line in an empty folder with an empty data folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path / "data"))

    def run(*args: object) -> Said:
        code = main([str(arg) for arg in args])
        out, err = capsys.readouterr()
        return Said(code, out, err)

    return run
