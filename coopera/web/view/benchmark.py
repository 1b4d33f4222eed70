"""The page of a benchmark: its results, and the runs behind each of their figures."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache
from pathlib import Path
from typing import Any

from coopera.benchmark.results_page import CARD, TABLE, read_results, shown
from coopera.core.errors import CooperaError
from coopera.web.view.desk import Desk
from coopera.web.view.reading import plainly
from coopera.web.view.shelf import Shelved


def page(desk: Desk, entry: Shelved) -> dict[str, Any]:
    """What the page of a benchmark shows; without results, its runs and why there are none."""
    runs = [one for one in desk.shelf.entries() if one.kind == "run" and one.benchmark == entry.key]
    folder = entry.root / "results" if (entry.root / "grid.yaml").is_file() else entry.root
    results: dict[str, Any] = {"card": None, "tables": [], "figures": []}
    problem = ""
    try:
        results = _results(folder, *_stamp(folder))
    except CooperaError as err:
        problem = plainly(err, entry.root)
    helped = [one for one in runs if not one.lived]
    return {
        **results,
        "entry": entry,
        "problem": problem,
        "runs": helped,
        "lives": [one for one in runs if one.lived],
        "states": Counter(one.state for one in helped),
        "methods": Counter(str(one.facts.get("method")) for one in helped if one.facts),
    }


def _stamp(folder: Path) -> tuple[float, float]:
    """By what results are known to be as they were."""
    found = []
    for name in (CARD, TABLE):
        try:
            found.append((folder / name).stat().st_mtime)
        except OSError:
            found.append(0.0)
    return found[0], found[1]


@lru_cache(maxsize=8)
def _results(folder: Path, card_at: float, table_at: float) -> dict[str, Any]:
    """The results of a folder, worked out once while its files stay as they are."""
    card, rows = read_results(folder)
    return shown(card, rows)
