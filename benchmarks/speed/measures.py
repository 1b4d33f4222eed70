"""What is measured: each measure gives a title, the command that repeats it, and a Markdown table."""

from __future__ import annotations

import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

RUN = (sys.executable, "-c", "import sys; from coopera.cli import main; sys.exit(main())")
HELP, FIRST = 0.3, 3.0


class Table(NamedTuple):
    """A part of the page: a heading, what is said of it, the columns and the rows."""

    title: str
    words: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]

    def __str__(self) -> str:
        head = f"| {' | '.join(self.columns)} |\n|{'---|' * len(self.columns)}"
        return f"## {self.title}\n\n{self.words}\n\n{head}\n" + "\n".join(f"| {' | '.join(row)} |" for row in self.rows)


class Took(NamedTuple):
    """What a process took: seconds by the clock and of the processor, and its largest resident set."""

    wall: float
    cpu: float
    megabytes: float
    first_line: float = 0.0
    first_cpu: float = 0.0
    first_hour: float = 0.0
    first_hour_cpu: float = 0.0


def took(arguments: Sequence[str]) -> Took:
    """Carry out a command of coopera in a process of its own.

    Raises:
        SystemExit: If it fails.
    """
    began = time.perf_counter()
    process = subprocess.Popen([*RUN, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert process.stdout is not None
    seen: dict[str, tuple[float, float]] = {}
    said = []
    for line in process.stdout:
        said.append(line)
        now = time.perf_counter() - began, _cpu_of(process.pid)
        seen.setdefault("line", now)
        if " done (" in line:
            seen.setdefault("hour", now)
    _, status, used = os.wait4(process.pid, 0)  # its own: what is asked of all children keeps the largest of them
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"coopera {' '.join(arguments)}: {''.join(said[-3:])}")
    firsts = (*seen.get("line", (0.0, 0.0)), *seen.get("hour", (0.0, 0.0)))
    return Took(time.perf_counter() - began, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, *firsts)


def _cpu_of(pid: int) -> float:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def middle(values: Sequence[float]) -> str:
    """The median, with two decimals below 10 and one above."""
    value = statistics.median(values)
    return f"{value:.2f}" if value < 10 else f"{value:.1f}"


def start_up(times: int) -> Table:
    """`--help`, and a run until its first line and its first hour."""
    helps = [took(["--help"]) for _ in range(times)]
    with tempfile.TemporaryDirectory() as folder:
        runs = [took(_life(Path(folder) / str(n), days=1, hours=1)) for n in range(times)]
    rows = [
        ["`coopera --help`", middle([one.wall for one in helps]), middle([one.cpu for one in helps]), f"{HELP:g}"],
        [
            "`coopera run`, its first line",
            middle([one.first_line for one in runs]),
            middle([one.first_cpu for one in runs]),
            f"{FIRST:g}",
        ],
        [
            "`coopera run`, its first hour lived",
            middle([one.first_hour for one in runs]),
            middle([one.first_hour_cpu for one in runs]),
            "",
        ],
    ]
    words = f"Medians of {times} processes, with Python's byte code written before."
    return Table("Start-up", words, ["what", "s by the clock", "s of processor", "at most"], rows)


def default_run(times: int, pictures: bool) -> Table:
    """The run that `coopera run` is: one person, 5 days of 13 hours, both graphs, world, evenings, trace, report.

    The first, which encodes the texts, is not counted. The memory is that of the largest process.
    """
    rows = []
    for what, kind, most in (("without pictures", "none", "35"), ("as it is, with pictures", "sampled", "60")):
        if kind == "none" or pictures:
            with tempfile.TemporaryDirectory() as folder:
                _, *found = (took(_life(Path(folder) / str(n), 5, 13, pictures=kind)) for n in range(times + 1))
            figures = [middle([getattr(one, name) for one in found]) for name in ("wall", "cpu", "megabytes")]
            rows.append([what, *figures, most])
    words = f"Five days of 13 hours, one person, seed 0; medians of {times}, texts encoded by a run before."
    columns = ["`coopera run`", "s by the clock", "s of processor", "MB at most", "s asked for"]
    return Table("The default run", words, columns, rows)


def growth(title: str, words: str, cases: Sequence[tuple[str, Sequence[str], int]]) -> Table:
    """Processor seconds an hour of runs of different sizes, less those of a first hour: (name, flags, hours).

    A first hour lived before has the data folder know the texts of the home and its motions; those of further hours
    and people are encoded within.
    """
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for n, (name, flags, hours) in enumerate(cases):
            _, start, run = (
                took(["run", *some, "--out", str(Path(folder) / f"{n}-{which}"), "--pictures", "none"])
                for which, some in enumerate((_shortest(flags), _shortest(flags), flags))
            )
            rows.append(
                [
                    name,
                    f"{run.cpu:.1f}",
                    f"{1000 * (run.cpu - start.cpu) / max(hours - 1, 1):.0f}",
                    f"{run.megabytes:.0f}",
                ]
            )
    return Table(
        title, words, [title.lower(), "s of processor in all", "ms an hour, without the start", "MB at most"], rows
    )


def _shortest(flags: Sequence[str]) -> list[str]:
    """The same run of one person's first hour."""
    short = {"--days": "1", "--hours": "1"}
    found = list(flags)
    for name, value in short.items():
        found[found.index(name) + 1] = value
    if "--humans" in found:
        at = found.index("--humans") + 1
        found[at] = found[at].split(",")[0]
    return found


def _life(out: Path, days: int, hours: int, pictures: str = "none") -> list[str]:
    size = ["--days", str(days), "--hours", str(hours)]
    return ["run", "--humans", "amara", *size, "--pictures", pictures, "--out", str(out)]


def machine() -> str:
    """The processor, cores, memory and Python."""
    try:
        info = Path("/proc/cpuinfo").read_text()
        name = next(iter(re.findall(r"model name\s*: (.+)", info)), platform.processor())
        memory = int(re.findall(r"MemTotal:\s+(\d+)", Path("/proc/meminfo").read_text())[0]) / 2**20
    except (OSError, IndexError):
        name, memory = platform.processor(), 0.0
    python, load = platform.python_version(), os.getloadavg()[0]
    return f"{os.cpu_count()} cores of {name}, {memory:.0f} GiB, Python {python}, load {load:.1f} at the start"


def commit() -> str:
    """The commit that is measured."""
    asked = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    return asked.stdout.strip() or "no commit"


def child(module: str, *arguments: str) -> dict[str, Any]:
    """The last line that a benchmark of its own prints, which is one JSON object."""
    asked = subprocess.run([sys.executable, "-m", module, *arguments], capture_output=True, text=True, check=False)
    if asked.returncode:
        raise SystemExit(f"{module}: {asked.stderr[-2000:]}")
    found: dict[str, Any] = json.loads(asked.stdout.strip().splitlines()[-1])
    return found
