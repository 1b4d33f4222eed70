"""Which adapters stay when an evening is over."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.hour import Evening
from coopera.core.household import SceneId
from coopera.core.people import Belief, PersonId
from coopera.rundir.retention import remove, superseded
from coopera.rundir.seals import Seal

FILES = (
    "intention/examples.jsonl",
    "intention/kept.jsonl.gz",
    "intention/kernel.npz",
    "account.json",
    "robot/state.json",
)
WEIGHTS = ["intention/kept.jsonl.gz", "intention/kernel.npz", "robot/state.json"]


def evening(day: int, episode: int = 0, episode_day: int | None = None) -> Evening:
    return Evening(
        day=day,
        episode=episode,
        episode_day=day if episode_day is None else episode_day,
        person=PersonId("amara"),
        scene=SceneId("maple"),
        feedback=[],
        belief=Belief(),
    )


def seal(day: int, files: tuple[str, ...] = FILES) -> Seal:
    return Seal(files={f"adapters/day-{day:02d}/{name}": "ab" for name in files} | {f"trace/day-{day:02d}/e": "cd"})


def gone(kept: str, day: int) -> list[str]:
    found = superseded(kept, evening(day), evening(day - 1), seal(day - 1), seal(day))
    return [name.removeprefix(f"adapters/day-{day - 1:02d}/") for name in found]


@pytest.mark.parametrize(
    ("kept", "days"), [("all", []), ("last", [0, 1, 2, 3, 4, 5]), ("every:3", [0, 1, 3, 4]), ("every:1", [])]
)
def test_what_is_learned_goes_once_the_next_evening_has_it_and_examples_stay(kept: str, days: list[int]) -> None:
    assert [day for day in range(6) if gone(kept, day + 1) == WEIGHTS] == days
    assert all(gone(kept, day + 1) in (WEIGHTS, []) for day in range(6))


def test_the_last_evening_of_an_episode_stays() -> None:
    assert superseded("last", evening(3, 1, 0), evening(2, 0, 2), seal(2), seal(3)) == []


def test_nothing_goes_that_the_next_evening_lacks() -> None:
    assert superseded("last", evening(1), evening(0), seal(0), seal(1, ())) == []
    assert superseded("last", evening(0), None, None, seal(0)) == []
    assert superseded("last", evening(1), evening(0), None, seal(1)) == []


def test_only_files_of_adapters_are_removed_with_folders_that_are_then_empty(tmp_path: Path) -> None:
    kept, gone = tmp_path / "adapters/day-00/account.json", tmp_path / "adapters/day-00/robot/state.json"
    other = tmp_path / "people/amara.yaml"
    for path in (kept, gone, other):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("text")
    remove(tmp_path, ["adapters/day-00/robot/state.json", "people/amara.yaml", "adapters/day-00/not-there"])
    assert (kept.exists(), other.exists(), gone.parent.exists()) == (True, True, False)
