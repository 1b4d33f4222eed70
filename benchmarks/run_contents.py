"""What a run holds, so that two runs can be compared: every file is of a kind, and a kind says what of it counts.

    python -m benchmarks.run_contents RUN...

Seconds and process numbers differ between equal runs, so records are compared without them. A file of no kind counts
too: that it is there at all is then what is compared.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from langchain_core.embeddings import Embeddings

from coopera.config.schema import default_data_dir
from coopera.graphs import build_study_graph
from coopera.memory import MemoryStream, bundled
from coopera.memory.store import Store
from coopera.rundir.directory import RunDir
from coopera.studies.standing import THREAD, open_checkpoints

Contents: TypeAlias = dict[str, dict[str, str]]
"""By kind, and in it by file, by memory stream or by what was spent: a SHA-256, a word or a number."""
_SEALED_IN_PART = ("config.yaml", "run.json")
_ONE_RUNS_OWN = ("pid", "pid_start", "host", "started", "ended", "seconds")


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of file.

    Attributes:
        name: As a table shows it.
        pattern: What the file's name in the run looks like.
        read: What of it counts, as text or bytes.
    """

    name: str
    pattern: re.Pattern[str]
    read: Callable[[Path], str | bytes]


def _data(path: Path) -> str:
    """JSON without what differs between equal runs."""
    return json.dumps(_timeless(json.loads(path.read_text(encoding="utf-8"))), sort_keys=True)


def _standing(path: Path) -> str:
    """How a run stands: run.json, but for what was paid, which counts an hour twice that was done again."""
    return json.dumps({key: value for key, value in _info(path).items() if key != "spent"}, sort_keys=True)


def _info(path: Path) -> dict[str, Any]:
    info: dict[str, Any] = _timeless(json.loads(path.read_text(encoding="utf-8")))
    return info


def _timeless(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _timeless(value) for key, value in data.items() if key not in _ONE_RUNS_OWN}
    return [_timeless(value) for value in data] if isinstance(data, list) else data


def _page(path: Path) -> str:
    """That a page is whole; its charts and times are drawn from the records."""
    return "whole" if path.read_text(encoding="utf-8").rstrip().endswith("</html>") else "cut short"


def _seal(path: Path) -> str:
    """Which files a seal names, and of those that are still there, whether they are as they were sealed."""
    root = path.parents[2] if path.parent.name.startswith("day-") else path.parent
    sealed: dict[str, str] = json.loads(path.read_text(encoding="utf-8"))["files"]
    fits = {
        name: not (root / name).is_file() or _sha((root / name).read_bytes()) == sha for name, sha in sealed.items()
    }
    return json.dumps({name: name in _SEALED_IN_PART or fits[name] for name in sorted(sealed)})


def _kind(name: str, pattern: str, read: Callable[[Path], str | bytes] = Path.read_bytes) -> Kind:
    return Kind(name, re.compile(pattern), read)


KINDS = (
    _kind("traces", r"trace/day-\d+/hour-\d+\.json", _data),
    _kind("evenings", r"trace/day-\d+/evening\.json", _data),
    _kind("metrics", r"metrics\.csv"),
    _kind("summary", r"summary\.json", _data),
    _kind("report", r"report\.html", _page),
    _kind("frames", r"(frames|video)/.+"),
    _kind("adapters", r"adapters/.+"),
    _kind("configuration", r"config\.yaml|(people|scenes)/.+"),
    _kind("state", r"run\.json", _standing),
    _kind("seals", r"(trace/day-\d+/)?seal(-end)?\.json", _seal),
)
"""More kinds may be added; the first whose pattern fits counts."""
ELSEWHERE = re.compile(r"lock|memory/.+|checkpoints\.sqlite(-wal|-shm)?")
"""Files that are not compared as such: `contents` compares what memories and checkpoints say."""


def contents(run: Path, embeddings: Embeddings) -> Contents:
    """Everything that a run says, to be compared with another one."""
    found: Contents = {}
    for path in sorted(path for path in run.rglob("*") if path.is_file()):
        name = path.relative_to(run).as_posix()
        if ELSEWHERE.fullmatch(name):
            continue
        kind = next((kind for kind in KINDS if kind.pattern.fullmatch(name)), None)
        what = _sha(kind.read(path)) if kind else "there"
        found.setdefault(kind.name if kind else "other files", {})[name] = what
    found["spent"] = {name: str(count) for name, count in _info(run / "run.json").get("spent", {}).items()}
    resumable = RunDir.open(run).resumable
    found["memories"] = dict(_memories(run / "memory", embeddings)) if resumable else {}
    found["checkpoints"] = {"state": _state(run / "checkpoints.sqlite")} if resumable else {}
    return found


def differences(whole: Contents, other: Contents) -> list[str]:
    """What of a run is not as in the uninterrupted one, each as `kind: name`."""
    return [
        f"{kind}: {name}"
        for kind in sorted({*whole, *other})
        for name in sorted({*whole.get(kind, {}), *other.get(kind, {})})
        if whole.get(kind, {}).get(name) != other.get(kind, {}).get(name)
    ]


def _memories(folder: Path, embeddings: Embeddings) -> Iterator[tuple[str, str]]:
    """Each stream with what it remembers, in order."""
    with closing(Store.open(folder, create=False)) as store:  # held open, since to open it takes longer than to read it
        for name in store.streams():
            with MemoryStream.open(folder, name, embeddings, create=False) as stream:
                yield name, _sha(json.dumps([(one.text, one.hour, dict(one.metadata)) for one in stream.records()]))


def _state(file: Path) -> str:
    """The state with which a study ended."""
    if not file.is_file():
        return "missing"
    try:
        with open_checkpoints(file) as saver:
            values = build_study_graph(saver).get_state(THREAD).values
    except sqlite3.DatabaseError:
        return "damaged"
    return _sha(json.dumps(values, sort_keys=True, default=lambda one: one.model_dump(mode="json")))


def _sha(data: str | bytes) -> str:
    return hashlib.sha256(data.encode() if isinstance(data, str) else data).hexdigest()


def main() -> None:
    """Print a SHA-256 of each kind of what some runs hold: two versions of the code that agree in it do the same."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("runs", nargs="+", type=Path)
    embeddings = bundled(default_data_dir() / "embeddings.sqlite")
    for run in parser.parse_args().runs:
        for kind, files in contents(run, embeddings).items():
            print(f"{_sha(json.dumps(files, sort_keys=True))[:16]}  {len(files):4d}  {kind} of {run}")


if __name__ == "__main__":
    main()
