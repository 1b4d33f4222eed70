"""Searching texts of all runs: intentions, tasks, prompts and replies, as they stand in the trace files.

A search takes a bounded time; what is left is searched when the reader asks for more.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from coopera.core.errors import CooperaError
from coopera.rundir.trace_files import read_json
from coopera.web.view.lines import trace_files
from coopera.web.view.links import hour_page
from coopera.web.view.shelf import Shelved

SECONDS, MOST_HITS, MOST_WORDS = 4.0, 60, 200
"""Of one search: how long it may take, how many hours it shows, and how many characters may be asked for."""
_AROUND = 70
_PLACES = {"human": "person", "robot": "robot", "calls": "prompt or reply", "reason": "why it failed", "world": "world"}


class Hit(NamedTuple):
    """An hour in which the words stand: where, and what is before and after them."""

    entry: Shelved
    page: str
    day: int
    hour: int
    where: str
    before: str
    words: str
    after: str


@dataclass(slots=True)
class Result:
    """What a search found; `rest` is from where to go on, empty where all was searched."""

    words: str
    hits: list[Hit] = field(default_factory=list)
    runs: int = 0
    of: int = 0
    rest: str = ""


class Search:
    """Searches the runs of a shelf."""

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds = seconds

    def look(self, entries: Sequence[Shelved], words: str, start: str = "") -> Result:
        """Search runs for words, whatever their case.

        Args:
            entries: All that is on the shelf.
            words: What to search for.
            start: From which run on, by its key.
        """
        wanted = words.strip()[:MOST_WORDS]
        runs = [one for one in entries if one.kind == "run"]
        first = next((n for n, one in enumerate(runs) if one.key == start), 0)
        found = Result(wanted, runs=first, of=len(runs))
        if not wanted:
            return found
        end = time.monotonic() + self._seconds
        for entry in runs[first:]:
            if len(found.hits) >= MOST_HITS or time.monotonic() > end:
                found.rest = entry.key
                break
            found.hits += _in_run(entry, wanted)
            found.runs += 1
        return found


def _in_run(entry: Shelved, words: str) -> Iterator[Hit]:
    """The hours of a run in which some words stand."""
    needles = {json.dumps(words.lower(), ensure_ascii=ascii_only)[1:-1].encode() for ascii_only in (True, False)}
    for day, hour, path in trace_files(entry.root):
        try:
            raw = path.read_bytes()
        except OSError:
            continue
        low = raw.lower() if raw.isascii() else raw.decode("utf-8", "replace").lower().encode()
        if any(needle in low for needle in needles) and (hit := _hit(entry, path, (day, hour), words)):
            yield hit


def _hit(entry: Shelved, path: Path, place: tuple[int, int], words: str) -> Hit | None:
    try:
        data = read_json(path)
    except CooperaError:
        return None
    for where, text in _texts(data):
        at = text.lower().find(words.lower())
        if at >= 0:
            start, end = max(at - _AROUND, 0), at + len(words)
            before = ("…" if start else "") + text[start:at]
            after = text[end : end + _AROUND] + ("…" if len(text) > end + _AROUND else "")
            return Hit(entry, hour_page(*place), *place, where, before, text[at:end], after)
    return None


def _texts(data: Any) -> Iterator[tuple[str, str]]:
    """All texts of a record, the person's and the robot's before the prompts', with the part in which they stand."""
    if not isinstance(data, Mapping):
        return
    for name, called in _PLACES.items():
        left = [data.get(name)]
        while left:
            one = left.pop()
            if isinstance(one, str):
                yield called, one
            elif isinstance(one, Mapping):
                left += reversed(list(one.values()))
            elif isinstance(one, list):
                left += reversed(one)
