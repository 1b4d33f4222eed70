"""Results of several groups side by side: every results folder under a folder, each checked before it is shown."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from coopera.benchmark.results_page import CARD, read_results
from coopera.core.errors import ConfigError
from coopera.evaluation.analysis import endpoint_of, last_day, late_days


class Entry(NamedTuple):
    """One method of one results folder on one setting and type; an interval of too few people has no ends.

    `need` is the primary endpoint: need F1, mean of the late days. `success` is the paper's: predicate F1 on last days.
    """

    results: str
    method: str
    setting: str
    collab: int
    offline: bool
    need: float | None
    need_low: float | None
    need_high: float | None
    success: float
    low: float | None
    high: float | None
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
            late, people = late_days(chosen, endpoint=endpoint_of(card)), len({row.person for row in chosen})
            for method, cell in last_day(chosen).items():
                need = late[method].interval if method in late else None
                found.append(
                    Entry(
                        results=name,
                        method=method,
                        setting=setting,
                        collab=collab,
                        offline=card.offline,
                        need=need.mean if need else None,
                        need_low=need.low if need else None,
                        need_high=need.high if need else None,
                        success=cell.interval.mean,
                        low=cell.interval.low,
                        high=cell.interval.high,
                        people=people,
                        n=cell.n,
                    )
                )
    return sorted(found, key=_rank)


def _rank(one: Entry) -> tuple[object, ...]:
    return one.setting, one.collab, -(one.need or 0.0), -one.success, one.results, one.method
