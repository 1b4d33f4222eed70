"""What an hour of a life costs, by stage and by kind of work: prints one JSON object, for `benchmarks.speed`.

python -m benchmarks.speed.hours --days 10 --hours 13 [--pictures sampled] [--scene maple]
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path

from benchmarks.speed.clock import FRAMEWORK, lived
from coopera import Config
from coopera.report import page
from coopera.rundir.directory import RunDir

Seconds = Mapping[tuple[str, str], float]


def main() -> None:
    """Live, and print milliseconds an hour."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=5)
    parser.add_argument("--hours", type=int, default=13)
    parser.add_argument("--pictures", default="none")
    parser.add_argument("--scene", default="maple")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        config = Config(
            humans=["amara"],
            scenes=[given.scene],
            days=given.days,
            hours=given.hours,
            pictures=given.pictures,
            out=out,
        )
        watch = lived(config)
        began = time.process_time()
        page.write_report(RunDir.open(out))
        report = time.process_time() - began
    hours = given.days * given.hours
    print(
        json.dumps(
            {
                "hours": hours,
                "stages": _per_hour(watch.days[-1], 0, hours) | {"report": round(1000 * report / hours, 1)},
                "kinds": _per_hour(watch.days[-1], 1, hours),
                "framework": [
                    round(1000 * sum(_of_day(watch.days, n, kind) for kind in FRAMEWORK) / given.hours, 1)
                    for n in range(len(watch.days))
                ],
            }
        )
    )


def _per_hour(seconds: Seconds, which: int, hours: int) -> dict[str, float]:
    """Milliseconds an hour by stage (0), pictures apart, or by kind of work (1)."""
    found: dict[str, float] = defaultdict(float)
    for key, spent in seconds.items():
        found["pictures" if key[1] == "pictures" else key[which]] += 1000 * spent / hours
    return {name: round(value, 1) for name, value in sorted(found.items(), key=lambda one: -one[1])}


def _of_day(days: list[dict[tuple[str, str], float]], number: int, kind: str) -> float:
    """Seconds of a kind of work on one day."""
    until = sum(spent for (_, what), spent in days[number].items() if what == kind)
    return until - (sum(spent for (_, what), spent in days[number - 1].items() if what == kind) if number else 0.0)


if __name__ == "__main__":
    main()
