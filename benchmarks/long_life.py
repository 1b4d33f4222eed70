"""What a long life costs by day: seconds, memory, open handles and disk, and whether any of them grows.

    python -m benchmarks.long_life --days 100 --hours 6 --out runs/long-life

One person lives day after day in one home, offline and without pictures, with days cut to `--hours`. After each day
the process looks at itself; seconds are of the processor. The growth per day is the slope of a line fitted by least
squares to the days after the tenth. Its data folder is new, so that the encoder of texts is loaded on the first day.
Memory is what the process holds of its own (RssAnon, without mapped files), disk what the run's folder holds. The last
line is one JSON object; the exit code is 1 if memory grows by more than --most MB a day.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coopera import Config, run_study

SETTLED = 10
"""Days after which nothing should grow any longer."""
PARTS = ("checkpoints.sqlite", "checkpoints.sqlite-wal", "memory", "adapters", "trace")
Row = dict[str, float]


def main() -> None:
    """Live, print a table of some days, the slopes, and a line of JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=100)
    parser.add_argument("--hours", type=int, default=6)
    parser.add_argument("--person", default="amara")
    parser.add_argument("--most", type=float, default=0.2, help="MB a day by which memory may grow")
    parser.add_argument("--out", type=Path, default=Path("runs/long-life"))
    chosen = parser.parse_args()
    shutil.rmtree(chosen.out, ignore_errors=True)
    rows = lived(chosen.days, chosen.hours, chosen.person, chosen.out)
    names = list(rows[0])
    print(f"| {' | '.join(names)} |\n|{'---|' * len(names)}")
    for row in rows:
        if row["day"] in {1, 5} or row["day"] % 10 == 0:
            print(f"| {' | '.join(f'{value:g}' for value in row.values())} |")
    grows = {name: round(slope(rows, name), 4) for name in names[1:]}
    print(f"growth a day after day {SETTLED}: {grows}")
    print(json.dumps({"days": chosen.days, "hours": chosen.hours, "growth": grows}))
    sys.exit(grows["RSS MB"] > chosen.most)


def lived(days: int, hours: int, person: str, out: Path) -> list[Row]:
    """A row for each day of a life."""
    rows: list[Row] = []
    at = time.process_time()

    def look(event: Mapping[str, Any]) -> None:
        nonlocal at
        if event["node"] != "day":
            return
        rows.append({"day": len(rows) + 1, "seconds": round((now := time.process_time()) - at, 2), **_held(out)})
        at = now
        print(json.dumps(rows[-1]), file=sys.stderr, flush=True)

    data = out.with_name(f"{out.name}-data")
    shutil.rmtree(data, ignore_errors=True)
    config = Config(humans=[person], days=days, hours=hours, pictures="none", out=out, data_dir=data)
    run_study(config, on_event=look)
    return rows


def slope(rows: Sequence[Row], name: str) -> float:
    """By how much a column grows a day once it has settled."""
    late = [row for row in rows if row["day"] > SETTLED]
    return float(np.polyfit([row["day"] for row in late], [row[name] for row in late], 1)[0]) if len(late) > 1 else 0.0


def _held(out: Path) -> Row:
    status = Path("/proc/self/status").read_text()
    kilobytes = next(int(line.split()[1]) for line in status.splitlines() if line.startswith("RssAnon"))
    sizes = {part: _megabytes(out / part) for part in PARTS}
    return {
        "RSS MB": round(kilobytes / 1024, 1),
        "handles": len(os.listdir("/proc/self/fd")),
        "disk MB": _megabytes(out),
        **{f"{part}, MB": size for part, size in sizes.items()},
    }


def _megabytes(path: Path) -> float:
    files = path.rglob("*") if path.is_dir() else [path]
    return round(sum(file.stat().st_size for file in files if file.is_file()) / 1e6, 2)


if __name__ == "__main__":
    main()
