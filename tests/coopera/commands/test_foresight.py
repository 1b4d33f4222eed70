"""`coopera benchmark --power`: what a grid would find, before anything of it is run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.benchmark import foresight
from tests.coopera.conftest import Said
from tests.names import ROOT

RESULTS = ROOT / "docs" / "results" / "offline-seeds"
GRID = ["--methods", "ours,random,habit", "--settings", "1", "--humans", "8", "--scenes", "1"]


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foresight, "by_people", lambda *_, **__: {6: None})


def test_power_is_told_and_nothing_is_written(coopera: Callable[..., Said], tmp_path: Path) -> None:
    said = coopera("benchmark", *GRID, "--power", "--scatter", RESULTS)
    assert said.code == 0, said.err
    assert "8 people with 1.0 lives of 2.0 late days each" in said.out
    assert f"scatter of random from {RESULTS}; assumed for habit" in said.out
    assert "if unlucky" in said.out
    assert not list(tmp_path.glob("runs*"))


def test_power_for_programs(coopera: Callable[..., Said]) -> None:
    said = coopera("benchmark", *GRID, "--power", "--json").json
    assert [one["method"] for one in said["comparisons"]] == ["random", "habit"]
    first = said["comparisons"][0]
    assert first["power"]["0.02"]["value"] < first["power"]["0.1"]["value"]
    assert 0 < first["detectable"]["error"] < 0.01 < first["detectable"]["value"]


def test_a_study_that_can_find_nothing_is_told_so(coopera: Callable[..., Said]) -> None:
    said = coopera("benchmark", *GRID[:-4], "--humans", "5", "--scenes", "1", "--power")
    assert "NOTHING CAN BE FOUND: the smallest p of this test needs 7 people for 2 comparisons." in said.out


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--methods", "ours", "--power"], "power: nothing is compared with ours; name it and at least one more"),
        (["--methods", "random,habit", "--power"], "power: nothing is compared with ours"),
        ([*GRID, "--scatter", "nowhere"], "nowhere: this folder holds no results"),
        (["--methods", "ours,habit", "--power", "--scatter", str(RESULTS)], "who met ours and one of habit are needed"),
    ],
)
def test_what_cannot_be_foreseen_is_refused_in_a_sentence(
    coopera: Callable[..., Said], flags: list[str], sentence: str
) -> None:
    said = coopera("benchmark", *flags)
    assert said.code == 2
    assert sentence in " ".join(said.err.split())
