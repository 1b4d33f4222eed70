"""Is every run that a full disk ends told of in a sentence, and gone on with? `python -m benchmarks.full_disk`.

A run of one day is done once undisturbed, and its writes are counted: whatever needs room under its folder and its data
folder, by Python, by SQLite and by Chroma. Then it is done again and again, each time with another of these writes
refused for want of room, is resumed once there is room, and is compared with the undisturbed run. The refusals come
from a library of some hundred lines (`full_disk.c`), which takes a C compiler (`cc`) and Linux.

A write that is refused either stays the only one (`once`), or writes half of what it was given, and nothing is taken
from then on (`full`).
"""

from __future__ import annotations

import argparse
import atexit
import gc
import hashlib
import itertools
import json
import math
import mmap
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

from benchmarks.forks import Photographer, import_all, prober, redirect
from benchmarks.run_contents import Contents, contents, differences
from coopera.core.errors import CooperaError

SOURCE = Path(__file__).with_suffix(".c")
MODES = ("once", "full")
_STATE = struct.Struct("4q")


class Trial(NamedTuple):
    """What came of one refused write: `wrong` is empty where all went as it should.

    `which`: its kind, and the how-manieth of that kind it was in the undisturbed run; the same in each, unlike `place`.
    `name`: what was refused in truth, which may be its neighbour where several processes write at once.
    """

    place: int
    name: str
    which: str
    mode: str
    code: int
    said: str
    wrong: str


_NAMES, _NAME = 16_384, 64  # as in full_disk.c
_UNLIKE = re.compile(r"[0-9a-f]{8}-[0-9a-f]{4}-[-0-9a-f]*|\.\d+\.tmp|\d+")


class Disk:
    """The steering of `full_disk.c`, loaded into this process before it began."""

    def __init__(self, base: Path) -> None:
        """Take the folder that `under_watch` made ready."""
        self.base = base
        self.root = base / "disk"
        file = (base / "state").open("r+b")
        self._state = mmap.mmap(file.fileno(), _STATE.size + _NAMES * _NAME)

    def arm(self, place: int, mode: str) -> None:
        """Let the write of this number fail, counted from 1 and from now; 0 lets none fail."""
        self._state[: _STATE.size] = _STATE.pack(0, place, MODES.index(mode), 0)

    def disarm(self) -> None:
        """Let no further write fail, and note how many there were so far."""
        (self.base / "writes").write_text(str(self.writes))
        self._state[8:16] = bytes(8)

    @property
    def writes(self) -> int:
        """How many writes there were since `arm`."""
        return int(_STATE.unpack(self._state[: _STATE.size])[0])

    @property
    def noted(self) -> int:
        """How many there were before `disarm`."""
        return int((self.base / "writes").read_text())

    def name(self, place: int) -> str:
        """What the write of this number was: the call, and the end of the path."""
        at = _STATE.size + (place - 1) * _NAME
        return self._state[at : at + _NAME].split(b"\0")[0].decode(errors="replace")

    @property
    def refused(self) -> int:
        """How many of them failed."""
        return int(_STATE.unpack(self._state[: _STATE.size])[3])


class Survey:
    """One undisturbed run, and the trials that are compared with it."""

    def __init__(self, disk: Disk, flags: Sequence[str], data: Path | None = None) -> None:
        """Do the undisturbed run and count its writes.

        Args:
            disk: Where.
            flags: Of `coopera run`, without `--out`.
            data: A data folder that knows the texts of this run; None has one run fill it beforehand.
        """
        self.disk = disk
        self.flags = list(flags)
        self.run = disk.root / "run"
        self._warm = disk.base / "data"
        disk.root.mkdir()
        if data is None:
            self._start()
            shutil.copytree(disk.root / "data", self._warm)
        else:
            shutil.copytree(data, self._warm)
        self._clean()
        self._start()
        import_all(json.loads((disk.base / "modules.json").read_text()))
        _warm_up(flags, disk.base, self._warm)
        self._clean()
        disk.arm(0, "once")
        code, said = self._start()
        assert code == 0, said
        self.names = [disk.name(place) for place in range(1, disk.noted + 1)]
        self.which = list(_numbered(_UNLIKE.sub("#", name) for name in self.names))
        self._whole = self._content()

    def trial(self, place: int, mode: str) -> Trial:
        """Refuse one write, or all from there on; then resume with room, or start anew where there is no run yet."""
        self._clean()
        self.disk.arm(place, mode)
        code, said = self._start()
        refused, name = self.disk.refused, self.disk.name(place)
        self.disk.arm(0, "once")
        last = said.strip().rpartition("\n")[2]
        which, wrong = self.which[place - 1], self._judge(code, said, refused)
        return Trial(place, name, which, mode, code, last, wrong)

    def sample(self, each: int) -> list[int]:
        """Numbers of writes: of those with the same call to the same kind of file, the first and each `each`-th.

        Their order is by chance, so that some of them say something about all.
        """
        found = [place for place, which in enumerate(self.which, 1) if int(which.rpartition(" ")[2]) % each == 0]
        return sorted(found, key=lambda place: hashlib.sha256(self.which[place - 1].encode()).digest())

    def _judge(self, code: int, said: str, refused: int) -> str:
        if not refused:
            return "" if code == 0 else f"failed without a refused write: {said}"
        if "Traceback" in said or "Exception ignored" in said or "panicked" in said:
            return f"traceback: {said}"
        if code not in (0, 1, 2) or (code and not _sentence(said)):
            return f"exit code {code} without a sentence: {said}"
        begun = (self.run / "run.json").is_file()
        true = ("finished",) if code == 0 else ("failed", "stopped", "finished")
        if begun and (state := self._state()) not in true:
            return f"untrue: the state is {state}, and the exit code was {code}"
        if not begun:  # the same command is as good as new
            left = [path.name for path in self.run.parent.glob("run*")]
            return f"not resumable: no run is there, and the folder is left: {left}" if left or not code else ""
        if code == 0:
            return self._differences()
        again, why = self._child(["resume", str(self.run)])
        if again:
            return f"not resumable: exit code {again}: {why} (after: {said})"
        return self._differences()

    def _state(self) -> str:
        from coopera.rundir.directory import RunDir  # noqa: PLC0415 - heavy

        try:
            return RunDir.open(self.run).state
        except CooperaError as err:
            return str(err)

    def _differences(self) -> str:
        found = self._content()
        for name, count in self._whole["spent"].items():
            if float(found["spent"].get(name, 0)) > float(count):
                found["spent"][name] = count  # what was done again was paid for again
        odd = differences(self._whole, found)
        return f"different: {', '.join(odd)}" if odd else ""

    def _content(self) -> Contents:
        """What the last command that succeeded has left, but for memories that a resume found damaged and kept."""
        found: Contents = json.loads((self.disk.base / "contents.json").read_text())
        others = found.pop("other files", {})
        found["other files"] = {name: what for name, what in others.items() if not name.startswith("memory.damaged")}
        found["left behind"] = {str(path): "there" for path in self.run.rglob(".*.tmp")}
        return found

    def _start(self) -> tuple[int, str]:
        return self._child(["run", *self.flags, "--out", str(self.run)])

    def _child(self, args: Sequence[str]) -> tuple[int, str]:
        """Do a command in a process of its own; returns its exit code and what it said on standard error."""
        said = self.disk.base / "stderr"
        os.environ["COOPERA_DATA_DIR"] = str(self.disk.root / "data")
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            redirect(said, self.disk.base / "stdout")
            os._exit(_work(args, self.run, self.disk))
        _, status = os.waitpid(child, 0)
        return os.waitstatus_to_exitcode(status), said.read_text()

    def _clean(self) -> None:
        for inside in self.disk.root.iterdir():
            shutil.rmtree(inside)
        shutil.copytree(self._warm, self.disk.root / "data")


def _work(args: Sequence[str], run: Path, disk: Disk) -> int:
    """A whole life of the program in a forked process; where it succeeds, what it left and its modules are noted."""
    from coopera.cli import main  # noqa: PLC0415 - heavy
    from coopera.memory import rebuild, store  # noqa: PLC0415
    from coopera.memory.embeddings import bundled  # noqa: PLC0415
    from coopera.simulation.sight import studio  # noqa: PLC0415

    code, base = 70, disk.base
    rebuild.damage = store.damage = prober()  # type: ignore[attr-defined]
    studio.subprocess = SimpleNamespace(**vars(subprocess) | {"Popen": Photographer()})  # type: ignore[attr-defined,assignment]
    try:
        code = main(args)
        atexit._run_exitfuncs()
        disk.disarm()
        if code == 0:
            (base / "contents.json").write_text(json.dumps(contents(run, bundled())))
            (base / "modules.json").write_text(json.dumps([name for name in sys.modules if name != "__main__"]))
    except BaseException:  # noqa: BLE001 - it is shown, as Python would
        sys.excepthook(*sys.exc_info())
    finally:
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
    return code


def _numbered(kinds: Iterable[str]) -> Iterator[str]:
    """Each kind with a number that counts those before it."""
    met: Counter[str] = Counter()
    for kind in kinds:
        yield f"{kind} {met[kind]}"
        met[kind] += 1


def _warm_up(flags: Sequence[str], base: Path, data: Path) -> None:
    """Live such a day in this process, off the watched disk and without what has threads, so that much stays loaded."""
    import typer.main  # noqa: PLC0415 - heavy

    from coopera import Config, run_study  # noqa: PLC0415
    from coopera.cli import app  # noqa: PLC0415
    from coopera.report.page import write_report  # noqa: PLC0415
    from coopera.rundir.directory import RunDir  # noqa: PLC0415

    given = dict(zip((flag.removeprefix("--") for flag in flags[::2]), flags[1::2], strict=True))
    days, hours = int(given["days"]), int(given["hours"])
    config = Config(humans=[given["humans"]], days=days, hours=hours, pictures="none", data_dir=data, out=base / "warm")
    run_study(config, resumable=False)
    write_report(RunDir.open(base / "warm"))
    command = typer.main.get_command(app)
    typer.main.get_command = lambda _: command  # type: ignore[assignment]
    gc.collect()
    gc.freeze()


def _sentence(said: str) -> bool:
    return any(line.startswith("coopera: ") for line in said.splitlines())


def under_watch(base: Path) -> None:
    """Begin this program again with `full_disk.c` loaded, unless it is."""
    if os.environ.get("FULL_DISK_STATE"):
        return
    library = base / "full_disk.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(SOURCE), "-ldl"], check=True)
    (base / "state").write_bytes(bytes(_STATE.size + _NAMES * _NAME))
    (base / "tmp").mkdir()
    os.environ |= {
        "LD_PRELOAD": str(library),
        "FULL_DISK_STATE": str(base / "state"),
        "FULL_DISK_ROOT": str(base / "disk"),
        "FULL_DISK_BASE": str(base),
        "TMPDIR": str(base / "tmp"),
    }
    sys.stdout.flush()
    os.execv(sys.executable, sys.orig_argv[:1] + sys.orig_argv[1:])


def main() -> None:
    """Do the trials that the arguments ask for, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=int, default=4)
    parser.add_argument("--pictures", default="none")
    parser.add_argument("--modes", default=",".join(MODES))
    parser.add_argument(
        "--each", type=int, default=1, help="of writes of one kind, refuse the first and each so-many-th"
    )
    parser.add_argument("--data", type=Path, help="a data folder that knows the texts of such a run, to begin sooner")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no trial after so many minutes")
    parser.add_argument(
        "--record", type=Path, help="keep each trial here, as a line of JSON, and do none that is there"
    )
    parser.add_argument("--part", default="1/1", help="K/N: the K-th of N processes that share the trials")
    parser.add_argument("--named", default="", help="only writes in whose name this regular expression is found")
    given = parser.parse_args()
    until = time.monotonic() + 60 * given.minutes
    base = Path(os.environ.get("FULL_DISK_BASE") or tempfile.mkdtemp(prefix="full-disk-"))
    under_watch(base)
    flags = ["--humans", "amara", "--days", "1", "--hours", str(given.hours), "--pictures", given.pictures]
    survey = Survey(Disk(base), flags, given.data)
    print(f"{len(survey.names)} writes, {len(survey.sample(given.each))} of them in the sample", flush=True)
    before = given.record.read_text().splitlines() if given.record and given.record.is_file() else []
    ended = [Trial(**json.loads(line)) for line in before]
    known = {(one.which, one.mode) for one in ended}
    part, parts = map(int, given.part.split("/"))
    trials = list(itertools.product(survey.sample(given.each), given.modes.split(",")))
    for place, mode in trials[part - 1 :: parts]:
        name, which = survey.names[place - 1], survey.which[place - 1]
        if (which, mode) in known or not re.search(given.named, name) or time.monotonic() > until:
            continue
        ended.append(survey.trial(place, mode))
        if given.record:
            with given.record.open("a") as file:
                file.write(json.dumps(ended[-1]._asdict()) + "\n")
    print(f"{len(survey.names)} writes; {table(ended)}")
    print("".join(f"{one}\n" for one in ended if one.wrong), end="")
    shutil.rmtree(base)


def table(ended: Sequence[Trial]) -> str:
    """The trials in numbers."""
    kinds = Counter(one.wrong.partition(":")[0] or "as it should be" for one in ended)
    codes = sorted(Counter(one.code for one in ended).items())
    told = [f"{kind}: {n}" for kind, n in kinds.items()] + [f"exit code {code}: {n}" for code, n in codes]
    return f"{len(ended)} trials; {'; '.join(told)}"


if __name__ == "__main__":
    main()
