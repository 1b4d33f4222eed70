"""Read changed files by the thousand: only errors of ours may come out, within 10 s of a processor and 1 GB each.

`python -m benchmarks.fuzz --inputs 20000 glb npz` tries two readers (all without names), each in a process of its own
that may not take more than 1 GB above what it starts with. An input that ends in anything but a result or an error of
ours is written to --finds. The last line is one JSON object.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path
from random import Random
from types import FrameType
from typing import Any, NamedTuple, NoReturn

from benchmarks.fuzzing import READERS
from benchmarks.fuzzing.kit import Reader, Target
from benchmarks.fuzzing.mutations import blend
from coopera.core.errors import LONGEST, ConfigError

MOST_SECONDS = 10
MOST_BYTES = 2**30
_STUCK = 600  # seconds of the clock after which a call that no signal ends is ended with its process
_CHUNK = 1000  # inputs of a process


class _Inputs(NamedTuple):
    name: str
    seed: int
    first: int
    end: int
    finds: Path


class _SlowError(BaseException):
    """An input takes too long."""


def main() -> int:
    """Try the readers that are named, and print what came out."""
    options = _options()
    names = options.readers or list(READERS)
    if unknown := set(names) - set(READERS):
        sys.exit(f"There is no reader {min(unknown)!r}; known are {', '.join(READERS)}.")
    warnings.simplefilter("ignore")
    found: dict[str, Any] = {}
    for name in names:
        try:
            found[name] = one = _tried(name, READERS[name], options)
        except ConfigError as err:  # as where a library is missing
            print(f"{name:16} not tried: {err}", flush=True)
            continue
        counted = f"{one['inputs']:6} inputs {one['read']:6} read {one['refused']:6} refused {one['others']:4} others"
        print(f"{name:16} {counted}, slowest {one['slowest']:.2f} s, {one['seconds']:.0f} s", flush=True)
    print(json.dumps({"seed": options.seed, "readers": found}))
    return int(bool(set(names) - set(found)) or any(one["others"] for one in found.values()))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("readers", nargs="*")
    parser.add_argument("--inputs", type=int, default=20_000)
    parser.add_argument("--first", type=int, default=0, help="the first input's number, to go on after others")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--finds", type=Path, default=Path("fuzz-finds"))
    return parser.parse_args()


def _tried(name: str, reader: Reader, options: argparse.Namespace) -> dict[str, Any]:
    """One reader, in processes of `_CHUNK` inputs; one that dies is a find, and the next goes on after its input."""
    total: dict[str, Any] = {**_nothing(), "kinds": {}}
    shared = Path("/dev/shm") if Path("/dev/shm").is_dir() else None
    with tempfile.TemporaryDirectory(prefix="coopera-fuzz-", dir=shared) as folder:
        target = reader.ready(Path(folder))
        target.path.write_bytes(target.seeds[0])
        target.read()  # imports, and what is made once
        at, end = options.first, options.first + options.inputs
        while at < end:
            notes = Path(folder) / "notes"
            notes.write_text(json.dumps(_nothing() | {"kinds": {}}), encoding="utf-8")
            if not (pid := os.fork()):
                _child(_Inputs(name, options.seed, at, min(at + _CHUNK, end), options.finds), reader, target, notes)
            _, status = os.waitpid(pid, 0)
            last = json.loads(notes.read_text(encoding="utf-8"))
            if status:
                last["inputs"] += 1
                last["others"] += 1
                last["kinds"][f"input {at + last['inputs'] - 1}: the process ended with status {status}"] = 1
            for key in _nothing():
                total[key] = max(total[key], last[key]) if key == "slowest" else total[key] + last[key]
            for kind, number in last["kinds"].items():
                total["kinds"][kind] = total["kinds"].get(kind, 0) + number
            at += last["inputs"]
    return total


def _nothing() -> dict[str, Any]:
    return {"inputs": 0, "read": 0, "refused": 0, "others": 0, "slowest": 0.0, "seconds": 0.0}


def _child(inputs: _Inputs, reader: Reader, target: Target, notes: Path) -> NoReturn:
    """Try some inputs, and note what came of them after each."""
    signal.signal(signal.SIGPROF, _too_slow)
    limit = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") + MOST_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    found: dict[str, Any] = {**_nothing(), "kinds": {}}
    with notes.open("r+", encoding="utf-8") as file:
        for number in range(inputs.first, inputs.end):
            data = changed(inputs.name, reader, target, inputs.seed, number)
            target.path.write_bytes(data)
            began = time.process_time()
            kind = _timed(target.read, reader.ours)
            took = time.process_time() - began
            found["slowest"], found["seconds"] = max(found["slowest"], took), found["seconds"] + took
            found["inputs"] += 1
            found[kind if kind in ("read", "refused") else "others"] += 1
            if kind not in ("read", "refused"):
                found["kinds"][kind] = found["kinds"].get(kind, 0) + 1
                if found["kinds"][kind] <= 2:
                    _keep(inputs.finds / inputs.name, number, kind, data)
            file.seek(0)
            json.dump(found, file)
            file.truncate()
            file.flush()
    os._exit(0)


def changed(name: str, reader: Reader, target: Target, seed: int, number: int) -> bytes:
    """The input of that number: always the same."""
    rng = Random(f"{seed} {name} {number}")
    chosen = blend(rng, target.seeds)
    return reader.mutate(rng, chosen) if chosen in target.seeds else chosen


def outcome(read: Callable[[], object], ours: tuple[type[Exception], ...]) -> str:
    """What came of a file: read, refused, or the name and place of what else was raised."""
    try:
        read()
    except ours as err:
        short = len(str(err)) <= LONGEST and "\n" not in str(err)
        return "refused" if short else f"{type(err).__name__}: no short sentence"
    except KeyboardInterrupt:
        raise
    except BaseException as err:  # noqa: BLE001 - whatever else comes out is what is looked for
        places = traceback.extract_tb(err.__traceback__)
        own = [one for one in places if "/lib/" not in one.filename and "/benchmarks/" not in one.filename]
        where = (own or places)[-1]
        said = " ".join(str(err).split())[:80]
        return f"{type(err).__name__} at {Path(where.filename).name}:{where.lineno} ({said})"
    return "read"


def _timed(read: Callable[[], object], ours: tuple[type[Exception], ...]) -> str:
    """The outcome within `MOST_SECONDS`, which are a processor's, so that it does not matter what else it does."""
    faulthandler.dump_traceback_later(_STUCK, exit=True)
    signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)
    try:
        return outcome(read, ours)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        faulthandler.cancel_dump_traceback_later()


def _too_slow(number: int, frame: FrameType | None) -> None:
    raise _SlowError(f"more than {MOST_SECONDS} s of a processor")


def _keep(folder: Path, number: int, kind: str, data: bytes) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{number}").write_bytes(data)
    (folder / f"{number}.txt").write_text(kind + "\n", encoding="utf-8", errors="replace")


if __name__ == "__main__":
    sys.exit(main())
