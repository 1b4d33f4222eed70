"""Results of several groups side by side: every results folder under a folder, each checked before it is shown."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from coopera.benchmark.results_files import CARD, read_results
from coopera.core.errors import ConfigError
from coopera.evaluation.analysis import last_day


class Entry(NamedTuple):
    """One method of one results folder on one setting and type."""

    results: str
    method: str
    setting: str
    collab: int
    offline: bool
    success: float
    low: float
    high: float
    help: float | None
    people: int
    n: int


def entries(folder: Path) -> list[Entry]:
    """Read all results below a folder, best first within each setting and type.

    Raises:
        ConfigError: If there are none, or one of them is damaged or of another format; names the file.
    """
    cards = sorted(folder.rglob(CARD))
    if not cards:
        raise ConfigError(f"{folder}: no results are in this folder (no {CARD}, at any depth).")
    found: list[Entry] = []
    for path in cards:
        card, rows = read_results(path.parent)
        name = card.name if path.parent == folder else path.parent.relative_to(folder).as_posix()
        for setting, collab in sorted({(row.setting, row.collab) for row in rows}):
            chosen = [row for row in rows if (row.setting, row.collab) == (setting, collab)]
            helps, people = last_day(chosen, "help"), len({row.person for row in chosen})
            for method, cell in last_day(chosen).items():
                given = helps.get(method)
                found.append(
                    Entry(name, method, setting, collab, card.offline, *cell.interval,
                          given.interval.mean if given else None, people, cell.n)
                )  # fmt: skip
    return sorted(found, key=lambda one: (one.setting, one.collab, -one.success, one.results, one.method))
