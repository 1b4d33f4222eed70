"""How fast is coopera? Measures, prints, and writes docs/performance.md.

    python -m benchmarks.speed [--full] [--out docs/performance.md] [--only start-up hours ...]

Without `--full` it takes some ten minutes; with it more than an hour of two cores, pictures, a hundred days and a
million memories included. Everything is offline, and every measure has processes of its own. Seconds of processor are
those to compare: on a machine that does other work, the clock's say little.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
import tempfile
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.memory_stream import IN_PROCESS
from benchmarks.speed.measures import Table, child, commit, default_run, growth, machine, start_up, took
from coopera.people.shipped import shipped_ids
from coopera.simulation.homes.scene import load_scene
from coopera.simulation.motions.library import load_library

Parts = Mapping[str, Callable[[bool], list[Table]]]
FIFTY = 50
HOMES = ("pine", "rowan", "maple", "willow", "oak")


def hours(full: bool) -> list[Table]:
    """By stage and by kind of work."""
    cases = [("without pictures", "none"), *([("with pictures", "sampled")] if full else [])]
    found = {name: child("benchmarks.speed.hours", "--days", "5", "--pictures", kind) for name, kind in cases}
    stages = ["person", "world", "robot", "pictures", "evening", "score", "between", "report"]
    return [
        Table(
            "An hour by stage",
            "Milliseconds of processor for each simulated hour of five days, imports and first uses apart. The "
            "models are the offline ones. Evening and report are shared out over the hours; `between` is LangGraph "
            "between the nodes.",
            ["stage", *found],
            _side_by_side(stages, [one["stages"] for one in found.values()]),
        ),
        Table(
            "An hour by kind of work",
            "The same milliseconds by what was done: `their own work` is the reasoning in the nodes of person and "
            "robot.",
            ["work", *found],
            _side_by_side(
                list(dict.fromkeys(k for one in found.values() for k in one["kinds"])),
                [one["kinds"] for one in found.values()],
            ),
        ),
    ]


def overhead(full: bool) -> list[Table]:
    """LangGraph, checkpoints, trace and memory, day by day."""
    days = 100 if full else 20
    found = child("benchmarks.speed.hours", "--days", str(days), "--hours", "13")["framework"]
    tenth, half = max(days // 10, 2), days // 2
    mean = statistics.mean
    rows = [
        [f"{first + 1} to {first + tenth}", f"{mean(found[first : first + tenth]):.1f}"]
        for first in range(0, days, tenth)
    ]
    words = (
        "LangGraph, checkpoints, trace and memory, without models, world and training: milliseconds of processor an "
        f"hour, means over days of thirteen hours; {mean(found):.1f} of all days. At most 40 are asked for. The second "
        f"half of the days took {mean(found[half:]) / mean(found[:half]):.2f} times the first."
    )
    return [Table("What the framework costs, and over a life", words, ["days", "ms an hour"], rows)]


def memory(full: bool) -> list[Table]:
    """Recall among more and more records."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "memory.json"
        quick = [] if full else ["--quick"]
        _said("benchmarks.memory_stream", *quick, "--out", str(out))
        found = json.loads(out.read_text())
    rows = []
    for size, row in found["streams"].items():
        cells = [row.get(name, {}).get("cpu_ms") for name in ("ours", IN_PROCESS, "brute force", "LangChain")]
        rows.append([f"{int(size):,}", *("" if cell is None else f"{cell:.2f}" for cell in cells)])
    ratios = "; ".join(f"{name}: {value}" for name, value in found["ratios"].items())
    words = (
        "Medians of an answer in milliseconds of processor, all in one run (`python -m benchmarks.memory_stream`, "
        f"which docs/memory.md explains; at most 1.5 times the first is asked for). Ratios: {ratios}."
    )
    return [Table("Recall", words, ["records", "ours", "ours in process", "brute force", "LangChain's"], rows)]


def sizes(full: bool) -> list[Table]:
    """People, objects and motions."""
    some = shipped_ids()
    counts = (1, 10, FIFTY) if full else (1, 5, FIFTY)
    clips = (0, 100, 1000) if full else (0, 100)
    each, hours_ = 6 if full else 3, 6
    day, long = (["--days", "1", "--hours", str(count)] for count in (each, hours_))
    with tempfile.TemporaryDirectory(prefix="speed-") as name:
        folder = Path(name)
        many = [some[n] if n < len(some) else str(_copy(folder, some[n % len(some)], n)) for n in range(FIFTY)]
        people = [(f"{n}", ["--humans", ",".join(many[:n]), *day], n * each) for n in counts]
        objects = sorted((len(load_scene(home).objects), home) for home in HOMES)
        homes = [(f"{n} ({home})", ["--humans", "amara", "--scenes", home, *long], hours_) for n, home in objects]
        shipped = len(load_library().captions)
        motions = [
            (f"{shipped + n:,}", ["--humans", "amara", *long, *_motions(folder / str(n), n)], hours_) for n in clips
        ]
        return [
            growth(
                "People",
                "A day each, with the robot, in one run, which encodes their texts for the first time.",
                people,
            ),
            growth("Objects", "In the shipped homes (`coopera list homes`).", homes),
            growth("Motions", "The shipped ones, and as many clips of a folder of one's own (`--motions`).", motions),
        ]


def _motions(folder: Path, count: int) -> list[str]:
    """The flags for a folder with so many clips of half a second, called as the shipped motions and numbered."""
    if not count:
        return []
    folder.mkdir()
    captions = load_library().captions
    for n in range(count):
        turns = np.zeros((15, 156))
        turns[:, 0] = math.pi / 2  # upright
        name = folder / f"{n}.npz"
        np.savez(name, poses=turns, trans=np.zeros((15, 3)), mocap_framerate=30.0)
        name.with_suffix(".txt").write_text(f"{captions[n % len(captions)][:50]} {n}", encoding="utf-8")
    return ["--motions", str(folder)]


def _copy(folder: Path, person: str, number: int) -> Path:
    """Another person like a shipped one, under a name of their own."""
    import yaml  # noqa: PLC0415

    import coopera  # noqa: PLC0415

    data = yaml.safe_load((Path(coopera.__file__).parent / "personas" / f"{person}.yaml").read_text(encoding="utf-8"))
    data["id"] = f"{data['id']}-{number}"
    path = folder / f"{data['id']}.yaml"
    path.write_text(yaml.safe_dump(data, allow_unicode=True), encoding="utf-8")
    return path


PARTS: Parts = {
    "start-up": lambda full: [start_up(5 if full else 3)],
    "run": lambda full: [default_run(5 if full else 1, pictures=full)],
    "hours": hours,
    "overhead": overhead,
    "sizes": sizes,
    "memory": memory,
}


def main() -> None:
    """Measure, print each table as it is there, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--full", action="store_true", help="an hour's work instead of minutes")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--out", type=Path, help="the page's measured part is replaced in this file")
    given = parser.parse_args()
    where = f"{machine()}; commit {commit()}; {datetime.now(UTC):%Y-%m-%d}."
    with tempfile.TemporaryDirectory() as folder:
        took(["run", "--days", "1", "--hours", "1", "--pictures", "none", "--out", str(Path(folder) / "warm")])
    tables = []
    for name in given.only:
        for table in PARTS[name](given.full):
            print(f"{table}\n", flush=True)
            tables.append(table)
    if given.out:
        _write(given.out, where, given.full, tables)


MEASURED = "<!-- measured: what follows is written by `make bench` -->"


def _write(path: Path, where: str, full: bool, tables: list[Table]) -> None:
    """Replace what was measured before; what people wrote above it stays."""
    said = path.read_text(encoding="utf-8").split(MEASURED)[0].rstrip() if path.exists() else "# Performance"
    mode = f"`python -m benchmarks.speed{' --full' if full else ''}`"
    body = "\n\n".join(str(table) for table in tables)
    path.write_text(f"{said}\n\n{MEASURED}\n\nMeasured with {mode} on {where}\n\n{body}\n", encoding="utf-8")


def _said(module: str, *arguments: str) -> None:
    """Carry out a benchmark of its own, and show what it says."""
    import subprocess  # noqa: PLC0415

    subprocess.run([sys.executable, "-m", module, *arguments], check=True)


def _side_by_side(names: list[str], columns: list[dict[str, Any]]) -> list[list[str]]:
    rows = [[name, *(f"{column.get(name, 0.0):.1f}" for column in columns)] for name in names]
    return [*rows, ["all", *(f"{sum(column.get(name, 0.0) for name in names):.1f}" for column in columns)]]


if __name__ == "__main__":
    main()
