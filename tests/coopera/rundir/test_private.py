"""Runs that nobody else may read, and runs beside them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from coopera import Config, RunDir, resume_study, run_study
from coopera.cli import main
from coopera.config.schema import Models
from coopera.core.errors import BudgetError
from coopera.models.settings import Budget
from coopera.rundir.private import only_mine
from tests.models.misbehaving import misbehaving


@pytest.fixture(scope="module")
def data_dir(letters: Path) -> Path:
    return letters


def modes(root: Path) -> set[tuple[bool, str]]:
    return {(path.is_dir(), oct(path.stat().st_mode & 0o777)) for path in (root, *root.rglob("*"))}


def mask() -> int:
    found = os.umask(0o022)
    os.umask(found)
    return found


def test_a_private_run_is_read_by_its_owner_alone_and_its_replies_go_to_no_cache_of_others(
    tmp_path: Path, data_dir: Path
) -> None:
    before, out = mask(), tmp_path / "run"
    out.mkdir(mode=0o755)
    told = {"humans": ["amara"], "days": 1, "hours": 1, "frames": 1, "frame_size": (64, 48)}
    with misbehaving("good") as server:
        told |= {"models": Models(human="openai:tiny"), "base_url": server.url, "budget": Budget(calls=2)}
        with pytest.raises(BudgetError):
            run_study(Config(private=True, out=out, data_dir=data_dir, **told))
        assert modes(out) == {(True, "0o700"), (False, "0o600")}
        resume_study(out, budget=Budget())
    assert RunDir.open(out).state == "finished"
    assert main(["report", str(out)]) == 0
    assert modes(out) == {(True, "0o700"), (False, "0o600")}
    assert mask() == before
    assert (out / "llm_cache.sqlite").is_file()
    assert not (data_dir / "llm_cache.sqlite").exists()


def test_the_mask_of_the_process_comes_back_when_the_last_private_run_ends() -> None:
    before = mask()
    first, second = only_mine(), only_mine()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert mask() == 0o077
    second.__exit__(None, None, None)
    with only_mine(private=False):
        assert mask() == before
