"""Retention: which evenings' adapters a run keeps.

A robot goes on from the newest evening of its episode. So an evening before may go once the next one has all that it
had. The examples stay in any case: whatever is missing is trained again from them.
"""

from __future__ import annotations

from pathlib import Path

from coopera.core.hour import Evening
from coopera.graphs.robots.learning import EXAMPLES, TOLD
from coopera.graphs.robots.own_robot import ACCOUNT
from coopera.rundir.seals import Seal

_RECORDS = (EXAMPLES, TOLD, ACCOUNT)


def superseded(kept: str, evening: Evening, past: Evening | None, before: Seal | None, now: Seal) -> list[str]:
    """Files of the day before that go, now that a day is finished.

    Args:
        kept: The setting: `all`, `last` or `every:N`.
        evening: The day's.
        past: That of the day before, if there is one.
        before: The seal of the day before, if there is one.
        now: What the day itself has.

    Returns:
        Their paths in the run.
    """
    if kept == "all" or past is None or before is None or past.episode != evening.episode:
        return []
    every = int(kept.partition(":")[2] or 0)
    if every and (past.episode_day + 1) % every == 0:
        return []
    ours, theirs = f"adapters/day-{evening.day:02d}/", f"adapters/day-{past.day:02d}/"
    return [
        name
        for name in before.files
        if name.startswith(theirs) and Path(name).name not in _RECORDS and ours + name.removeprefix(theirs) in now.files
    ]


def remove(root: Path, names: list[str]) -> None:
    """Remove files of a run's folder `adapters`, and folders that they leave empty."""
    home = (root / "adapters").resolve()
    for name in names:
        if not (root / name).resolve().is_relative_to(home):
            continue
        (root / name).unlink(missing_ok=True)
        for folder in (root / name).parents:
            if folder == root / "adapters" or not folder.is_dir() or any(folder.iterdir()):
                break
            folder.rmdir()
