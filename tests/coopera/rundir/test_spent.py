from __future__ import annotations

from pathlib import Path

from coopera.models.settings import Spent
from coopera.rundir.directory import RunDir
from tests.coopera.fake_run import fake_run


def test_a_finished_run_counts_what_was_spent_by_an_evening_that_was_killed(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=2)
    assert run.state == "finished"
    shown = RunDir.open(run.root).spent()
    run.note_spent(Spent(calls=shown.calls - 1, tokens=shown.tokens - 1))
    assert RunDir.open(run.root).info["spent"] == shown.model_dump()
