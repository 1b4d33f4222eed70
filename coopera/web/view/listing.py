"""The list: benchmarks, then the runs that stand for themselves."""

from __future__ import annotations

import hashlib
import itertools
from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from coopera.web.view.desk import Desk
from coopera.web.view.shelf import Shelved

MOST_PAIRS = 40
"""Pairs of runs that are written side by side; each is a page for every hour."""


class BenchmarkRow(NamedTuple):
    """A benchmark with how its runs stand."""

    entry: Shelved
    runs: int
    states: dict[str, int]
    methods: list[str]


def page(desk: Desk) -> dict[str, Any]:
    """What the list shows."""
    entries = desk.shelf.entries()
    runs = [one for one in entries if one.kind == "run"]
    own = sorted((one for one in runs if not one.benchmark), key=lambda one: one.started, reverse=True)
    rows = []
    for one in entries:
        if one.kind == "benchmark":
            of = [entry for entry in runs if entry.benchmark == one.key and not entry.lived]
            methods = Counter(str(entry.facts.get("method")) for entry in of if entry.facts)
            rows.append(BenchmarkRow(one, len(of), dict(Counter(entry.state for entry in of)), list(methods)))
    return {
        "runs": own,
        "benchmarks": rows,
        "states": Counter(one.state for one in own),
        "total": len(runs),
        "pairs": [f"{one.key} {other.key}" for one, other in pairs_of(entries)] if desk.files else None,
        "live": live(entries)["running"],
        "stamp": live(entries)["stamp"],
    }


def pairs_of(entries: Sequence[Shelved]) -> list[tuple[Shelved, Shelved]]:
    """Runs that are written side by side where pages are files: those of the same people and setting, not too many."""
    runs = [one for one in entries if one.kind == "run"]
    found = ((one, other) for one, other in itertools.combinations(runs, 2) if alike(one, other))
    return list(itertools.islice(found, MOST_PAIRS))


def alike(one: Shelved, other: Shelved) -> bool:
    """Whether two runs are of the same people, so that their hours can stand side by side."""
    if other.kind != "run" or other.key == one.key or one.lived or other.lived or not one.facts or not other.facts:
        return False
    return all(one.facts.get(name) == other.facts.get(name) for name in ("people", "setting"))


def live(entries: Sequence[Shelved]) -> dict[str, Any]:
    """Whether something runs, and a stamp that changes with whatever the list shows."""
    running = sum(one.state == "running" for one in entries)
    said = "\n".join(f"{one.key} {one.state} {one.hours} {one.need}" for one in entries)
    return {"running": running, "stamp": hashlib.sha256(said.encode()).hexdigest()[:16]}
