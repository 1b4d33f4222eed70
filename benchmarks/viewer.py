"""How long the viewer's pages take, and how large they are: `python -m benchmarks.viewer RUN [--folder DIR]`.

Of a run of a day or more copies are made: one of 5 days with its pictures, one of 100 days, and a benchmark of 1,000
runs. Each page is made twice; what is told is the processor's time, which other work on the machine does not change.
"""

from __future__ import annotations

import argparse
import json
import shutil
import tempfile
import time
from pathlib import Path

from coopera.report.page import fitted
from coopera.rundir.directory import RunDir
from coopera.web.view.site import Site


def main() -> None:
    """Make the copies, show their pages, and tell how long that took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--folder", type=Path, help="where the copies are made; they need 1 GB")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        root = Path(name)
        _longer(given.run, root / "five" / "run", days=5, pictures=True)
        _longer(given.run, root / "hundred" / "run", days=100, pictures=False)
        _benchmark(given.run, root / "thousand" / "grid", runs=1000)
        print(f"{_megabytes():.0f} MB at the start")
        for folder in ("five", "hundred"):
            pages = ["index.html", "day-02/hour-10.html", "analysis.html"]
            _show(folder, Site.of(root / folder), [f"run/run/{page}" for page in pages])
        site = Site.of(root / "thousand")
        key = next(one.key for one in site.desk.shelf.entries() if one.kind == "benchmark")
        other = next(one.key for one in site.desk.shelf.entries() if one.kind == "run")
        _show("thousand", site, ["index.html", f"benchmark/{key}/index.html", f"run/{other}/index.html"])
        before = time.process_time()
        size = len(fitted(RunDir.open(root / "five" / "run")).encode())
        print(f"report of five days: {time.process_time() - before:.2f} s, {size / 1e6:.1f} MB")


def _show(folder: str, site: Site, addresses: list[str]) -> None:
    for address in addresses:
        seconds, size = [], 0
        for _ in range(2):
            before = time.process_time()
            answer = site.answer(address)
            seconds.append(time.process_time() - before)
            size = len(answer.body) if answer else 0
        first, again = seconds
        print(
            f"{folder}, {address}: {first:.2f} s, again {again:.2f} s; {size / 1e6:.2f} MB; {_megabytes():.0f} MB held"
        )


def _longer(run: Path, copy: Path, *, days: int, pictures: bool, hours: int = 13) -> None:
    """A run of many days, made of the hours of the last day of a shorter one."""
    copy.mkdir(parents=True)
    for name in ("config.yaml", "run.json", "summary.json"):
        shutil.copy(run / name, copy)
    shutil.copytree(run / "people", copy / "people")
    last = max(path for path in (run / "trace").iterdir() if (path / "evening.json").is_file())
    lived = [json.loads(path.read_text()) for path in sorted(last.glob("hour-*.json"))]
    evening = json.loads((last / "evening.json").read_text())
    for day in range(days):
        folder = copy / "trace" / f"day-{day:02d}"
        folder.mkdir(parents=True)
        for number in range(hours):
            record = json.loads(json.dumps(lived[number % len(lived)]))
            record |= {"day": day, "episode_day": day, "hour": 9 + number}
            frames = [Path(one) for one in (record["robot"] or {}).get("frames", [])]
            named = [Path("frames") / folder.name / f"hour-{9 + number:02d}" / one.name for one in frames]
            for one, other in zip(frames, named, strict=True) if pictures else ():
                (copy / other).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(run / one, copy / other)
            if record["robot"]:
                record["robot"]["observation"]["frames"] = [one.as_posix() for one in named]
            (folder / f"hour-{9 + number:02d}.json").write_text(json.dumps(record))
        (folder / "evening.json").write_text(json.dumps({**evening, "day": day, "episode_day": day}))


def _benchmark(run: Path, folder: Path, *, runs: int) -> None:
    """A benchmark's folder of copies of one run."""
    for number in range(runs):
        copy = folder / "runs" / f"life-{number // 10}" / f"method-{number % 10}"
        copy.mkdir(parents=True)
        for name in ("config.yaml", "run.json", "summary.json"):
            shutil.copy(run / name, copy)
        for name in ("trace", "people"):
            shutil.copytree(run / name, copy / name)
    (folder / "grid.yaml").write_text("methods: [ours]\n")


def _megabytes() -> float:
    """What this process holds in memory."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 1e6


if __name__ == "__main__":
    main()
