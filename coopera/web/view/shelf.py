"""What lies below a folder: runs and benchmarks, found by their files, each read once while these stay as they are.

Links are not followed, neither to folders nor to files, so that a folder from elsewhere shows nothing but itself.
"""

from __future__ import annotations

import hashlib
import os
import re
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from coopera.config.files import reason
from coopera.config.schema import Config, load_config
from coopera.core.errors import ConfigError, CooperaError
from coopera.core.foreign.files import read_json
from coopera.core.household import SceneId
from coopera.core.people import PersonId
from coopera.evaluation import SETTINGS, schedule
from coopera.evaluation.methods import find_method
from coopera.rundir import claim
from coopera.rundir.about import read_about

MOST_DEEP, MOST_FOUND, MOST_FOLDERS = 8, 20_000, 200_000
"""Folders within folders that are looked into; runs and benchmarks that are listed; folders that are looked at."""
_WITHIN = {"trace", "frames", "video", "memory", "adapters", "people", "figures", ".git", "__pycache__"}
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
_FIELDS = ("method", "setting", "collab", "seed", "people", "scenes", "models")


@dataclass(frozen=True, slots=True)
class Shelved:
    """A run, or a benchmark, as the list shows it.

    Attributes:
        key: Its name in addresses: one word, safe in a file's name.
        name: Its folder, relative to the folder that is shown.
        root: The folder.
        kind: "run" or "benchmark".
        state: Of a run: running, stopped, failed, finished, or unreadable (then `problem` says why).
        problem: A sentence, where something cannot be read.
        facts: What it was run with: method, setting, collab, seed, people, scenes, models.
        started: And `ended`, in UTC, as text.
        ended: Empty while it runs.
        hours: That were lived, and `failed` of them; `planned` is None where that is not told.
        failed: Hours.
        planned: Hours of the whole run.
        need: Need F1 of all days; `f1` that of the paper.
        f1: By the predicate.
        tokens: Of all calls.
        faults: Calls with faults.
        benchmark: The key of the benchmark that it is a run of; empty for others.
        lived: Whether it is a benchmark's life without a robot.
    """

    key: str
    name: str
    root: Path
    kind: str
    state: str = ""
    problem: str = ""
    facts: Mapping[str, Any] = field(default_factory=dict)
    started: str = ""
    ended: str = ""
    hours: int = 0
    failed: int = 0
    planned: int | None = None
    need: float | None = None
    f1: float | None = None
    tokens: int = 0
    faults: int = 0
    benchmark: str = ""
    lived: bool = False


class Shelf:
    """The runs and benchmarks below a folder.

    Args:
        root: The folder; it may be a run or a benchmark itself.

    Raises:
        ConfigError: If it is no folder.
    """

    def __init__(self, root: Path) -> None:
        if not root.is_dir():
            what = "this is no folder" if root.exists() else "there is no such folder"
            raise ConfigError(f"{root}: {what}; give the folder in which runs lie, or a run.")
        try:
            next(root.iterdir(), None)
        except OSError as err:
            raise ConfigError(f"{root}: this folder cannot be read ({reason(err)}).") from err
        self.root = root.resolve()
        self._known: dict[Path, tuple[tuple[int, ...], Shelved]] = {}
        self._keys: dict[Path, str] = {}
        self._lock = threading.RLock()  # each page is made in a thread of its own

    def entries(self) -> list[Shelved]:
        """All runs and benchmarks, by name; what is new or was changed since is read again."""
        with self._lock:
            return self._entries()

    def _entries(self) -> list[Shelved]:
        places = list(self._places())
        self._name(path for path, _ in places)
        benchmarks = {path: self._keys[path] for path, kind in places if kind == "benchmark"}
        found = []
        for path, kind in places:
            of = next((benchmarks[one] for one in path.parents if one in benchmarks), "")
            found.append(self._entry(path, kind, of))
        return found

    def find(self, key: str, kind: str) -> Shelved | None:
        """A run or benchmark by its key."""
        known = next((path for path, name in self._keys.items() if name == key), None)
        if known is not None and _kind(known) == kind:  # as when the list was made last
            of = next((self._keys[one] for one in known.parents if one in self._keys and _kind(one) == "benchmark"), "")
            return self._entry(known, kind, of)
        return next((one for one in self.entries() if (one.key, one.kind) == (key, kind)), None)

    def _places(self) -> Iterator[tuple[Path, str]]:
        """Folders that are a run or a benchmark, with what they are, in order of their names."""
        found = 0
        for looked, (here, folders, _) in enumerate(os.walk(self.root), 1):
            path = Path(here)
            kind = _kind(path)
            deep = len(path.relative_to(self.root).parts)
            folders[:] = sorted(one for one in folders if one not in _WITHIN) if deep < MOST_DEEP else []
            if kind:
                found += 1
                yield path, kind
            if kind == "run":
                folders.clear()
            if found >= MOST_FOUND or looked >= MOST_FOLDERS:
                return

    def _name(self, paths: Iterator[Path]) -> None:
        """Give each folder a key that stays the same as long as the program runs, and usually beyond."""
        taken = set(self._keys.values())
        for path in paths:
            if path in self._keys:
                continue
            inner = path.relative_to(self.root).as_posix()
            plain = _UNSAFE.sub("_", self.root.name if inner == "." else inner.replace("/", "~~").replace("~~", "--"))
            plain = plain.lstrip(".")[:150] or "run"
            if plain in taken or plain != inner.replace("/", "--"):
                plain = plain if plain not in taken else f"{plain}-{hashlib.sha256(inner.encode()).hexdigest()[:8]}"
            taken.add(plain)
            self._keys[path] = plain

    def _entry(self, path: Path, kind: str, of: str) -> Shelved:
        files = ("run.json", "summary.json") if kind == "run" else ("grid.yaml", "results/results.json", "results.json")
        state = tuple(one for name in files for one in _state(path / name))
        if kind == "run":
            state += _state(path / "trace")
        known = self._known.get(path)
        if known is not None and known[0] == state and known[1].state != "running":
            return known[1]
        inner = path.relative_to(self.root).as_posix()
        name = self.root.name if inner == "." else inner
        entry = Shelved(self._keys[path], name, path, kind, benchmark=of)
        made = _run(entry) if kind == "run" else entry
        self._known[path] = (state, made)
        return made


def _kind(path: Path) -> str:
    """What a folder is: a run, a benchmark, or neither."""
    if _is_file(path / "run.json"):
        return "run"
    if _is_file(path / "grid.yaml") or (_is_file(path / "results.json") and _is_file(path / "hours.csv")):
        return "" if path.name == "results" and _is_file(path.parent / "grid.yaml") else "benchmark"
    return ""


def _is_file(path: Path) -> bool:
    try:
        return path.is_file() and not path.is_symlink()
    except OSError:
        return False


def _state(path: Path) -> tuple[int, ...]:
    try:
        at = path.lstat()
    except OSError:
        return (0, 0)
    return at.st_mtime_ns, at.st_size


def _run(entry: Shelved) -> Shelved:
    """Read what the list shows of a run: from run.json and summary.json, or else from config.yaml."""
    try:
        info = read_about(entry.root / "run.json")
    except CooperaError as err:
        return replace(entry, state="unreadable", problem=_short(err, entry.root))
    state = "stopped" if info["state"] == "running" and claim.is_gone(info) else str(info["state"])
    entry = replace(
        entry,
        state=state,
        problem=str(info.get("reason") or "")[:300],
        started=str(info.get("started") or "")[:40],
        ended=str(info.get("ended") or "")[:40],
    )
    told = _summary(entry.root)
    if told is not None and state == "finished":
        return _told(entry, told)
    facts, planned = _configured(entry.root)
    hours = sum(1 for _ in (entry.root / "trace").glob("day-*/hour-[0-9][0-9].json"))
    return replace(entry, facts=facts, planned=planned, hours=hours, lived=_is_life(facts.get("method")))


def _told(entry: Shelved, told: Mapping[str, Any]) -> Shelved:
    try:
        counts = [day["predicate"] for day in told["days"]]
        tp, fp, fn = (sum(int(one.get(name, 0)) for one in counts) for name in ("tp", "fp", "fn"))
        return replace(
            entry,
            facts={name: told.get(name) for name in _FIELDS},
            hours=int(told["hours"]),
            planned=int(told["hours"]),
            failed=int(told["failed_hours"]),
            need=_figure((told.get("need") or {}).get("f1")),
            f1=2 * tp / (2 * tp + fp + fn) if tp + fp + fn else None,
            tokens=int(told["tokens"]),
            faults=int(told["calls_with_faults"]),
            lived=_is_life(told.get("method")),
        )
    except (KeyError, TypeError, ValueError, AttributeError):
        return replace(entry, problem="summary.json is not what coopera writes; `coopera doctor` says more.")


def _is_life(method: Any) -> bool:
    """Whether a method is none: somebody's life, lived once, which the robots of a benchmark then meet."""
    try:
        return not find_method(str(method)).robot
    except CooperaError:
        return False


def _figure(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def _summary(root: Path) -> Mapping[str, Any] | None:
    try:
        found = read_json(root / "summary.json")
    except CooperaError:
        return None
    return found if isinstance(found, dict) else None


def _configured(root: Path) -> tuple[dict[str, Any], int | None]:
    """What a run that has no summary was asked for, and how many hours that comes to, as far as config.yaml says so."""
    try:
        config = load_config(root / "config.yaml")
    except CooperaError:
        return {}, None
    facts = {name: getattr(config, name) for name in ("method", "setting", "collab", "seed")}
    facts |= {"people": config.humans or [], "scenes": config.scenes or [], "models": config.models.model_dump()}
    return facts, _planned(config)


def _planned(config: Config) -> int | None:
    """How many hours a run comes to; None where that is not told."""
    if config.schedule:
        return len(config.schedule) * len(config.day_hours)
    people, scenes = config.humans or [], config.scenes or []
    try:
        days = schedule(
            SETTINGS[config.setting],
            [PersonId(one) for one in people],
            [SceneId(one) for one in scenes],
            days=config.days,
            hours=config.hours,
            collab=config.collab,
        )
    except CooperaError:
        return None
    return sum(len(day.hours) for day in days)


def _short(err: CooperaError, root: Path) -> str:
    """An error's sentence without the path, which the reader sees anyway."""
    return str(err).replace(f"{root}{os.sep}", "")[:500]
