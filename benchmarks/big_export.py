"""A thousand person-days as data sets: seconds, memory and size, and whether their own libraries read them.

    python -m benchmarks.big_export RUN... [--days 1000] [--hours 13] [--reader PYTHON] [--out DIR]

The days are those of all RUNs under new numbers, and over and over only if these are fewer: the runs of a grid, such as
`runs/paper/runs/*/{ours,paper}`, have thousands. `--reader` is a Python that has `datasets` and `lerobot`, which need
not be this one: what it reads is counted there. The last line is one JSON object.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from coopera.rundir.directory import RunDir
from coopera.rundir.export import export

READ = """
import json, sys
from datasets import __version__ as version, load_dataset
hours = load_dataset(sys.argv[1] + "/hours", split="train", cache_dir=sys.argv[2])
found = {"datasets": version, "hours": hours.num_rows}
try:
    from lerobot import __version__ as version
    from lerobot.datasets.lerobot_dataset import LeRobotDataset
    data = LeRobotDataset("local/coopera", root=sys.argv[1] + "/episodes")
    data[0], data[len(data) - 1]
    found |= {"lerobot": version, "frames": len(data), "episodes": data.num_episodes}
except ImportError as err:
    found["lerobot"] = str(err)
print(json.dumps(found))
"""


def main() -> None:
    """Gather, export, read back."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN")
    parser.add_argument("--days", type=int, default=1000)
    parser.add_argument("--hours", type=int, default=13, help="of each day, at most")
    parser.add_argument("--reader", default=sys.executable)
    parser.add_argument("--prelude", type=Path, help="a file of Python that the reader carries out first")
    parser.add_argument("--out", type=Path, help="keeps the data sets here")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        big = Path(scratch) / "run"
        lived = gathered(given.runs, big, given.days, given.hours)
        out = given.out or Path(scratch) / "export"
        began = time.process_time()
        made: dict[str, Any] = export(RunDir.open(big), out)
        made |= {
            "days lived": min(lived, given.days),
            "seconds of processor": round(time.process_time() - began, 1),
            "MB held at most": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024),
            "MB of traces": _megabytes(big / "trace"),
            "MB of hours": _megabytes(out / "hours"),
            "MB of episodes": _megabytes(out / "episodes"),
        }
        made["read"] = read(given.reader, out, Path(scratch) / "cache", given.prelude)
    print(json.dumps(made))


def gathered(runs: Sequence[Path], big: Path, days: int, hours: int) -> int:
    """A run of so many days, made of those of others; returns how many days these have."""
    for run in reversed(runs):
        unlike = shutil.ignore_patterns("trace", "memory", "adapters", "*.sqlite*", "lock", "seal*")
        shutil.copytree(run, big, ignore=unlike, dirs_exist_ok=True)
    lived = [day for run in runs for day in sorted((run / "trace").glob("day-*"))]
    for day in range(days):
        folder = big / "trace" / f"day-{day:02d}"
        folder.mkdir(parents=True)
        for file in sorted(lived[day % len(lived)].glob("hour-*.json"))[:hours]:
            record = json.loads(file.read_text(encoding="utf-8"))
            record |= {"day": day, "episode_day": day}
            (folder / file.name).write_text(json.dumps(record), encoding="utf-8")
    return len(lived)


def read(python: str, out: Path, cache: Path, prelude: Path | None) -> dict[str, Any]:
    """What the libraries find in the folder, each with its version."""
    first = prelude.read_text(encoding="utf-8") if prelude else ""
    asked = subprocess.run(
        [python, "-c", first + READ, str(out), str(cache)], capture_output=True, text=True, check=False
    )
    if asked.returncode:
        raise SystemExit(f"{python}: {asked.stderr[-2000:]}")
    found: dict[str, Any] = json.loads(asked.stdout.strip().splitlines()[-1])
    return found


def _megabytes(folder: Path) -> float:
    return round(sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) / 1e6, 1)


if __name__ == "__main__":
    main()
