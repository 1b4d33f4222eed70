"""Weeks with one person: success, the evening's learning and memory, day by day.

    python -m benchmarks.weeks --humans amara,chen,idris --days 50 --out runs/weeks

Each person lives with a robot of their own, in a process of its own, without pictures. Seconds are processor time of
the evening's `learn` node; megabytes are the largest resident set so far, and the size of the run's memory on file. A
life that is there already is read. Ends with a Markdown table: the mean over people of each ten days (need F1 with a 95
% interval), and the slowest evening.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path
from statistics import fmean
from typing import Any

from coopera import Config, run_study
from coopera.evaluation.statistics import mean_over_people

DECADE = 10


class Watch:
    """Takes the time and the memory of each evening from the events of a run."""

    def __init__(self, run: Path) -> None:
        self._run, self._last = run, time.process_time()
        self.evenings: list[dict[str, float]] = []
        self._learning = 0.0

    def __call__(self, event: dict[str, Any]) -> None:
        """Note what the node that has ended took."""
        now = time.process_time()
        if event["node"] == "learn":
            self._learning = now - self._last
        elif event["node"] == "end_day" and event["hour"] is None:
            self._note()
        self._last = time.process_time()

    def _note(self) -> None:
        stored = sum(path.stat().st_size for path in (self._run / "memory").rglob("*") if path.is_file())
        held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        self.evenings.append({"seconds": self._learning, "held_mb": held / 1e6, "stored_mb": stored / 1e6})


def live(person: str, args: argparse.Namespace) -> dict[str, Any]:
    """One person's weeks: the days of the summary, and each evening's seconds and megabytes."""
    out = args.out / person
    noted = out / "weeks.json"
    if noted.is_file():
        found: dict[str, Any] = json.loads(noted.read_text())
        return found
    watch = Watch(out)
    summary = run_study(
        Config(humans=[person], days=args.days, method=args.method, household=args.household, pictures="none", out=out),
        on_event=watch,  # type: ignore[arg-type]
    )
    evenings = watch.evenings[:: len(watch.evenings) // args.days or 1][: args.days]
    lived = {"need": [day["help"]["f1"] or 0.0 for day in summary["days"]], "evenings": evenings}
    noted.write_text(json.dumps(lived))
    return lived


def main() -> None:
    """Live what is missing and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--humans", default="amara,chen,idris")
    parser.add_argument("--days", type=int, default=50)
    parser.add_argument("--method", default="ours")
    parser.add_argument("--household", default="own")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/weeks"))
    args = parser.parse_args()
    with ProcessPoolExecutor(args.workers, max_tasks_per_child=1) as pool:
        lives = list(pool.map(live, args.humans.split(","), repeat(args)))
    print("| days | need F1 | an evening's learning, s | slowest, s | held, MB | memory on file, MB |")
    print("|---|---|---|---|---|---|")
    for start in range(0, args.days, DECADE):
        days = slice(start, min(start + DECADE, args.days))
        need = mean_over_people([fmean(one["need"][days]) for one in lives])
        evenings = [evening for one in lives for evening in one["evenings"][days]]
        seconds = [evening["seconds"] for evening in evenings]
        last = [one["evenings"][days][-1] for one in lives]
        held, stored = (fmean(evening[name] for evening in last) for name in ("held_mb", "stored_mb"))
        print(
            f"| {days.start + 1}-{days.stop} | {need} | {fmean(seconds):.2f} | {max(seconds):.2f} | {held:.0f} | "
            f"{stored:.1f} |"
        )


if __name__ == "__main__":
    main()
