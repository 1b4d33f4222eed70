"""Can one live in these homes? `python -m benchmarks.homes_lived FOLDER-or-FILE… [--hours 3] [--human amara]`.

In each home a person of the offline model lives one day of some hours, with the robot, without pictures, one home after
the other in one process. What fails is told: a run that ends in an error, an hour that failed, an act that could not be
done with the reason. At the end stands a table, and the exit code is 1 if a run or an hour failed.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.cli import main as coopera


class Lived(NamedTuple):
    """What came of a day in one home: exit code, hours that failed, acts done and not done, and why not."""

    home: str
    code: int
    failed_hours: int
    done: Counter[str]
    reasons: Counter[str]
    said: str


def main() -> None:
    """Live in every home that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("homes", nargs="+", type=Path, help="files of homes, or folders of them")
    parser.add_argument("--hours", type=int, default=3)
    parser.add_argument("--human", default="amara")
    given = parser.parse_args()
    files = [file for path in given.homes for file in (sorted(path.glob("*.json")) if path.is_dir() else [path])]
    lived = []
    start = time.process_time()
    for file in files:
        lived.append(day_in(file, given.human, given.hours))
        one = lived[-1]
        fault = f"; exit code {one.code}: {one.said}" if one.code else ""
        print(f"{one.home}: {one.failed_hours} hours failed, {_share(one.done)} acts done{fault}", flush=True)
    print(table(lived))
    print(f"{(time.process_time() - start) / max(len(lived), 1):.1f} s of CPU for each home")
    sys.exit(any(one.code or one.failed_hours for one in lived))


def day_in(home: Path, human: str, hours: int) -> Lived:
    """One day in one home."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["run", "--scenes", str(home.absolute()), "--humans", human, "--days", "1", "--hours", str(hours)]
        run, said = Path(folder) / "run", io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = coopera([*arguments, "--pictures", "none", "--out", str(run)])
        if code:
            return Lived(home.stem, code, 0, Counter(), Counter(), (said.getvalue().splitlines() or [""])[-1])
        failed = json.loads((run / "summary.json").read_text())["failed_hours"]
        acts = [act for file in sorted(run.glob("trace/day-*/hour-*.json")) for act in _acts(file)]
    done = Counter(f"{act['agent']} {'done' if act['ok'] else 'not done'}" for act in acts)
    reasons = Counter(f"{act['agent']}: {act['reason']}" for act in acts if not act["ok"])
    return Lived(home.stem, code, failed, done, reasons, "")


def _acts(file: Path) -> Iterator[dict[str, Any]]:
    """What came of each act of an hour, of the person and of the robot."""
    hour = json.loads(file.read_text())
    for part in ("world", "robot"):
        yield from (hour.get(part) or {}).get("outcomes", [])


def _share(done: Counter[str]) -> str:
    good = sum(count for what, count in done.items() if not what.endswith("not done"))
    return f"{good} of {done.total()}"


def table(lived: Sequence[Lived]) -> str:
    """All homes together."""
    done, reasons = Counter[str](), Counter[str]()
    for one in lived:
        done += one.done
        reasons += one.reasons
    lines = ["| | |", "|---|---|", f"| homes | {len(lived)} |"]
    lines += [f"| runs that ended in an error | {sum(one.code != 0 for one in lived)} |"]
    lines += [f"| hours that failed | {sum(one.failed_hours for one in lived)} |"]
    for agent in ("human", "robot"):
        both = Counter({what: count for what, count in done.items() if what.startswith(agent)})
        lines.append(f"| acts of the {agent} that were done | {_share(both)} |")
    lines += [f"| not done, {reason} | {count} |" for reason, count in reasons.most_common(12)]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
