"""What a page says of an hour in one line, read from its trace file without keeping the file: small, and remembered.

A line is read by hand, not through the record's types, which takes six times as long: the page of a run of a hundred
days needs a line for each of its hours. A file that is damaged becomes a line that says so.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coopera.core.clock import hour_label
from coopera.core.errors import CooperaError
from coopera.core.success import Counts, Help
from coopera.evaluation.counts import pool
from coopera.evaluation.measures.help import Need, need, pool_help
from coopera.rundir.trace_files import read_json

_NAME = re.compile(r"day-(\d{2,})")
_HOUR = re.compile(r"hour-([01]\d|2[0-3])\.json")
MOST_WORDS = 300
"""Characters of an intention in a line."""


@dataclass(frozen=True, slots=True)
class Line:
    """One hour in a line.

    Attributes:
        day: Of the run, which names the folder.
        hour: Of the day.
        person: Whose hour it was.
        scene: In which home.
        episode: And `episode_day`, as in the trace.
        episode_day: The day within the episode.
        intention: What the person was up to; of a failed hour, why it failed.
        state: ok, failed, away, or damaged (then `intention` says what is wrong with the file).
        flags: As of `coopera.report.hours.FLAGS`, but for slow, which depends on the other hours.
        counts: By the predicate; None where nothing was scored.
        judged: By the judge.
        help: What the robot's help was worth.
        seconds: How long models took.
        tokens: Read and written by models.
        calls: Asked of models.
    """

    day: int
    hour: int
    person: str = ""
    scene: str = ""
    episode: int = 0
    episode_day: int = 0
    intention: str = ""
    state: str = "ok"
    flags: tuple[str, ...] = ()
    counts: Counts | None = None
    judged: Counts | None = None
    help: Help | None = None
    seconds: float = 0.0
    tokens: int = 0
    calls: int = 0

    @property
    def label(self) -> str:
        """The hour in words."""
        return hour_label(self.hour)

    @property
    def f1(self) -> float | None:
        """F1 by the predicate."""
        return self.counts.f1 if self.counts else None

    @property
    def path(self) -> str:
        """Where its page lies within the pages of the run."""
        return f"day-{self.day:02d}/hour-{self.hour:02d}.html"


def f1_of(counts: Sequence[Counts | None]) -> float | None:
    """F1 of pooled counts; None where nothing could be scored."""
    return pool([one for one in counts if one is not None]).f1


def need_of(lines: Sequence[Line]) -> Need:
    """Need precision, recall and F1 of some hours, their counts pooled."""
    return need(pool_help([line.help for line in lines if line.help]))


def trace_files(root: Path) -> Iterator[tuple[int, int, Path]]:
    """(day, hour, file) of each hour of a run, in order; links are not followed."""
    trace = root / "trace"
    days = [(int(found[1]), path) for path in _inside(trace) if (found := _NAME.fullmatch(path.name))]
    for day, folder in sorted(days):
        for path in sorted(_inside(folder)):
            if (found := _HOUR.fullmatch(path.name)) and not path.is_symlink():
                yield day, int(found[1]), path


def _inside(folder: Path) -> list[Path]:
    try:
        return [] if folder.is_symlink() else list(folder.iterdir())
    except OSError:
        return []


class Lines:
    """The lines of runs, each read once while its file and its evening stay as they are."""

    def __init__(self) -> None:
        self._known: dict[Path, tuple[tuple[int, ...], Line]] = {}

    def of_run(self, root: Path) -> list[Line]:
        """The lines of all hours of a run, in order."""
        found: list[Line] = []
        told: tuple[int, dict[int, list[bool]]] = (-1, {})
        state: tuple[int, ...] = ()
        for day, hour, path in trace_files(root):
            evening = path.with_name("evening.json")
            if told[0] != day:
                state, told = _state(evening), (day, {})
            now = (*_state(path), *state)
            known = self._known.get(path)
            if known is None or known[0] != now:
                if not told[1] and state:
                    told = (day, _right(evening))
                known = (now, _line(path, day, hour, told[1].get(hour, [])))
                self._known[path] = known
            found.append(known[1])
        return found


def _state(path: Path) -> tuple[int, ...]:
    """By what a file is known to be as it was; empty where there is none."""
    try:
        at = path.lstat()
    except OSError:
        return ()
    return at.st_mtime_ns, at.st_size


def _line(path: Path, day: int, hour: int, right: Sequence[bool]) -> Line:
    """Read a line; `right` says of the robot's intentions of the hour which were right."""
    try:
        return _read(read_json(path), day, hour, right)
    except CooperaError as err:
        return Line(day, hour, state="damaged", intention=str(err).removeprefix(f"{path}: "))
    except (KeyError, TypeError, ValueError, AttributeError):
        return Line(day, hour, state="damaged", intention="This trace file is not what coopera writes.")


def _read(data: Any, day: int, hour: int, right: Sequence[bool]) -> Line:
    human, robot = data.get("human") or {}, data.get("robot") or {}
    calls = data.get("calls") or []
    success = data.get("success") or {}
    doing = human.get("intention") or {}
    failed = data["status"] == "failed"
    waited = math.fsum(float(one.get("seconds", 0)) for one in calls if not one.get("cached") and not one.get("late"))
    return Line(
        day=day,
        hour=hour,
        person=str(data["person"]),
        scene=str(data["scene"]),
        episode=int(data["episode"]),
        episode_day=int(data["episode_day"]),
        intention=str(data.get("reason", "") if failed else doing.get("text", ""))[:MOST_WORDS],
        state="failed" if failed else "away" if doing.get("away") else "ok",
        flags=tuple(_flags(data, human, robot, calls, right)),
        counts=_counts(success.get("predicate")),
        judged=_counts(success.get("judge")),
        help=_help(success.get("help")),
        seconds=waited,
        tokens=sum(int(one.get("tokens_in", 0)) + int(one.get("tokens_out", 0)) for one in calls),
        calls=len(calls),
    )


def _flags(
    data: Mapping[str, Any],
    human: Mapping[str, Any],
    robot: Mapping[str, Any],
    calls: Sequence[Mapping[str, Any]],
    right: Sequence[bool],
) -> Iterator[str]:
    tasks = [(bool(one.get("accepted")), one.get("correct")) for one in robot.get("tasks") or []]
    if (True, False) in tasks:
        yield "wrong"
    if (False, True) in tasks:
        yield "miss"
    if data["status"] == "failed":
        yield "failed"
        return
    if right and not any(right):
        yield "unimagined"
    if human.get("repairs") or any(c.get("faults") or c.get("leniencies") or c.get("attempts", 1) > 1 for c in calls):
        yield "repaired"


def _counts(found: Any) -> Counts | None:
    return Counts.model_validate(found) if found else None


def _help(found: Any) -> Help | None:
    return Help.model_validate({**found, "accepted": found.get("accepted") or 0}) if found else None


def _right(evening: Path) -> dict[int, list[bool]]:
    """By hour, whether each intention that the robot imagined was right, as far as the person said so."""
    try:
        data = read_json(evening)
        found: dict[int, list[bool]] = {}
        for item in data["feedback"]:
            if item["kind"] == "intention" and item["helpful"] is not None:
                found.setdefault(int(item["hour"]), []).append(bool(item["helpful"]))
        return found
    except (CooperaError, KeyError, TypeError, ValueError, json.JSONDecodeError):
        return {}
