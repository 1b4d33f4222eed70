"""Kill runs with SIGKILL at random moments, resume them, and compare each with the run that nobody interrupted.

    python -m benchmarks.kills --kills 100 --rollbacks 20 --workers 2 --out runs/kills

A trial is a short run that is killed one to three times, also while it goes on after a kill. Half of the moments are
drawn over the time that the run takes. The others are drawn over what it does to its files, with the evening and the
end as likely as all hours together: the process dies right before it opens, renames or removes that file. In a trial
with a rollback the checkpoints are harmed besides: copied without their -wal, put back to an older copy, deleted, or
cut short. What a trial must leave is every file of the uninterrupted run, memories and checkpoints included
(`benchmarks.run_contents`), or a refusal in one sentence; but the harmed checkpoints of a finished run may be gone,
since nothing needs them, and a memory that a resume said it had found damaged is kept beside the one made anew. Trials
that leave anything else stay in --out.

The same seed draws the same trials; the moment at which a drawn time strikes depends on the machine.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import count, islice
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from benchmarks.one_life import Moment, in_a_process, live
from benchmarks.run_contents import Contents, contents, differences
from coopera.memory import bundled

_HARMS = ("copied without -wal", "an older copy", "deleted", "cut short")
_PLACES = ("start", "hours", "evening", "end")
SORTS: dict[str, dict[str, Any]] = {
    "one person": {"humans": ["amara"], "days": 2, "hours": 3, "pictures": "none"},
    "with pictures": {"humans": ["amara"], "days": 2, "hours": 2, "frames": 2},
    "two people, who is not told": {
        "schedule": [["amara", "maple"], ["bruno", "oak"], ["amara", "oak"]],
        "hours": 2,
        "collab": 1,
        "identity": "unknown",
        "traits": "hourly",
        "pictures": "none",
    },
    "benchmark": {"methods": ["ours"], "settings": ["1"], "episodes": 1, "days": 1, "hours": 2, "humans": ["amara"]},
}
"""The short runs, as study files; the last is a grid."""
_DRAWN = ("one person",) * 7 + ("with pictures", "two people, who is not told", "benchmark")
"""Of ten trials, so many are of a sort."""


_REBUILT, _DAMAGED = "rebuilt from its texts without loss (kept:", "memory.damaged"
_KEPT = "(a memory was found damaged, and said so; it was rebuilt without loss and is kept)"


@dataclass(slots=True)
class Whole:
    """The uninterrupted run of a sort: how long it took, what it did to its files, and what it left."""

    seconds: float
    steps: list[str]
    left: Contents


@dataclass(slots=True)
class Trial:
    """A trial and what came of it."""

    number: int
    sort: str
    kills: int
    harm: str = ""
    struck: list[str] = field(default_factory=list)
    """Where each kill struck."""
    verdict: str = ""
    """"equal", "refused" or "different"."""
    said: str = ""
    """The sentence of a refusal, or what differs, or that a memory was found damaged and is kept beside its own."""
    heard: str = ""
    """All that its commands said on standard error."""


def main() -> None:
    """Print two tables, and end with one line of JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=100, help="kills that must have struck, without those below")
    parser.add_argument("--rollbacks", type=int, default=20, help="trials whose checkpoints are harmed, too")
    parser.add_argument("--sorts", nargs="+", choices=SORTS, help="only these sorts of runs")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("runs/kills"))
    chosen = parser.parse_args()
    out = chosen.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    os.environ["COOPERA_DATA_DIR"] = str(out / "data")
    drawn = chosen.sorts or _DRAWN
    begun = time.monotonic()
    wholes = {sort: uninterrupted(sort, out / "whole" / sort.replace(" ", "-")) for sort in dict.fromkeys(drawn)}
    done: list[Trial] = []
    with ThreadPoolExecutor(chosen.workers) as pool:

        def carry_out(trials: Iterable[Trial]) -> None:
            for one in pool.map(lambda trial: tried(trial, wholes[trial.sort], out, chosen.seed), trials):
                done.append(one)
                print(_line(one), flush=True)

        runs_alone = [sort for sort in drawn if sort != "benchmark"]
        carry_out(Trial(n, runs_alone[n % len(runs_alone)], 1, _HARMS[n % 4]) for n in range(chosen.rollbacks))
        fresh = (Trial(n, drawn[n % len(drawn)], 1 + n % 3) for n in count(chosen.rollbacks))
        while sum(len(one.struck) for one in done if not one.harm) < chosen.kills:
            carry_out(islice(fresh, chosen.workers * 4))
    show(done, chosen.seed, time.monotonic() - begun)


def uninterrupted(sort: str, folder: Path) -> Whole:
    """Do a run of a sort, and look at it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    start = time.monotonic()
    code = live(_command(sort, folder), folder)
    seconds = time.monotonic() - start
    if code != 0:
        sys.exit(f"{sort}: the uninterrupted run failed: {(folder / 'said').read_text()}")
    print(f"{sort}: the uninterrupted run took {seconds:.1f} s", flush=True)
    return Whole(seconds, (folder / "steps").read_text().splitlines(), looked_into(sort, folder))


def tried(trial: Trial, whole: Whole, out: Path, seed: int) -> Trial:
    """Carry a trial out."""
    rng = np.random.default_rng([seed, trial.number])
    folder = out / f"trial-{trial.number:03d}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if trial.harm:
        _roll_back(trial, whole, folder, rng)
    for _ in range(trial.kills):
        if _life(trial, folder, moment_of(whole, rng)) != -signal.SIGKILL:
            break
    code = _life(trial, folder, None)
    said = (folder / "said").read_text()
    if code == 0:
        left = looked_into(trial.sort, folder)
        kept = _REBUILT in trial.heard and _without_damaged(left)
        wrong = differences(whole.left, left)
        if trial.harm and not (folder / "run" / "checkpoints.sqlite").exists():
            wrong.remove("checkpoints: state")  # a finished run's, which a resume removes where they are damaged
        trial.verdict, trial.said = ("different", "; ".join(wrong)) if wrong else ("equal", _KEPT if kept else "")
    else:
        one_sentence = code in {1, 2} and said.count("coopera: ") == 1 and "Traceback" not in said
        trial.verdict, trial.said = "refused" if one_sentence else "different", said[-2000:]
    if trial.verdict == "equal":
        shutil.rmtree(folder)
    return trial


def _without_damaged(left: Contents) -> bool:
    """Leave a memory out that was found damaged and is kept; whether there is one."""
    kept = [(kind, name) for kind in left for name in left[kind] if kind.endswith("other files") and _DAMAGED in name]
    for kind, name in kept:
        del left[kind][name]
    return bool(kept)


def _roll_back(trial: Trial, whole: Whole, folder: Path, rng: np.random.Generator) -> None:
    """Two lives, of which the first leaves an older copy of the checkpoints; then harm is done to them."""
    run, older = folder / "run", folder / "older"
    begun = [n for n, step in enumerate(whole.steps) if _place(step) != "end" and n > len(whole.steps) // 8]
    first, second = sorted(int(n) for n in rng.choice(begun, 2, replace=False))
    _life(trial, folder, _before(whole, first))
    older.mkdir()
    for part in run.glob("checkpoints.sqlite*"):
        shutil.copy(part, older)
    if _life(trial, folder, _before(whole, second)) == -signal.SIGKILL:  # a run that is finished needs none any more
        _harm(trial.harm, run, older, rng)


def moment_of(whole: Whole, rng: np.random.Generator) -> Moment:
    """Draw a moment: over time, or over the steps of a place that is drawn first."""
    if rng.random() < 0.5:
        return Moment(seconds=float(rng.uniform(0, whole.seconds)))
    place = rng.choice(_PLACES[1:])
    steps = [n for n, step in enumerate(whole.steps) if _place(step) == place] or list(range(len(whole.steps)))
    return _before(whole, int(rng.choice(steps)))


def _before(whole: Whole, step: int) -> Moment:
    return Moment(step=whole.steps[step], nth=whole.steps[: step + 1].count(whole.steps[step]))


def _place(step: str) -> str:
    """In which part of a run it does this to a file."""
    if re.search(r"adapters/|evening\.json|metrics\.csv", step):
        return "evening"
    of_the_end = r"summary\.json|seal-end\.json|run\.json|report\.html|rows\.json|results/"
    return "end" if re.search(of_the_end, step) else "hours"


def _life(trial: Trial, folder: Path, moment: Moment | None) -> int:
    """Begin the run or go on with it, until it ends or dies; its exit code, -9 where it was killed."""
    if trial.sort == "benchmark" or not (folder / "run").exists():
        arguments = _command(trial.sort, folder)
    else:
        arguments = ["resume", "run"]
    code = live(arguments, folder, moment)
    trial.heard += (folder / "said").read_text()
    if code == -signal.SIGKILL and moment is not None:
        trial.struck.append(where(folder / "run", SORTS[trial.sort]))
    return code


def where(run: Path, study: dict[str, Any]) -> str:
    """In which part of its life a run stands, by its files."""
    if not list(run.rglob("hour-*.json")):
        return "start"
    days = sorted(folder for folder in run.rglob("trace/day-*"))
    lived = [len(list(day.glob("hour-*.json"))) == study["hours"] for day in days]
    evenings = [(day / "evening.json").is_file() for day in days]
    if len(days) == len(study.get("schedule", range(study.get("days", 0)))) and all(evenings):
        return "end"
    return "evening" if lived[-1] and not evenings[-1] else "hours"


def _command(sort: str, folder: Path) -> list[str]:
    """The command that begins a run of a sort, or a benchmark, which begins again where it was left."""
    (folder / "study.yaml").write_text(yaml.safe_dump(SORTS[sort]))
    if sort == "benchmark":
        return ["benchmark", "study.yaml", "--out", "run"]
    return ["run", "study.yaml", "--out", "run"]


def _harm(harm: str, run: Path, older: Path, rng: np.random.Generator) -> None:
    """Do to a run's checkpoints what a power cut, a careless copy or a mistake does."""
    parts = [run / f"checkpoints.sqlite{end}" for end in ("", "-wal", "-shm")]
    file = parts[0]
    for part in parts if harm in {"deleted", "an older copy"} else parts[1:] if harm == "copied without -wal" else []:
        part.unlink(missing_ok=True)
    if harm == "an older copy":
        for part in older.iterdir():
            shutil.copy(part, run)
    if harm == "cut short" and file.is_file():
        os.truncate(file, int(rng.integers(0, file.stat().st_size + 1)))


def looked_into(sort: str, folder: Path) -> Contents:
    """What a run holds, or all runs of a benchmark; found out in a process of its own, since it opens stores."""
    in_a_process(_look, sort, folder)
    found: Contents = json.loads((folder / "contents.json").read_text())
    return found


def _look(sort: str, folder: Path) -> None:
    embeddings = bundled(Path(os.environ["COOPERA_DATA_DIR"]) / "embeddings.sqlite")
    run = folder / "run"
    if sort == "benchmark":
        found = {
            f"{one.parent.relative_to(run)} {kind}": names
            for one in sorted(run.glob("*/**/run.json"))
            for kind, names in contents(one.parent, embeddings).items()
        }
    else:
        found = contents(run, embeddings)
    embeddings.close()
    (folder / "contents.json").write_text(json.dumps(found))


def _line(one: Trial) -> str:
    what = f"{one.sort}, checkpoints {one.harm}" if one.harm else one.sort
    return f"{one.number:3d} {what}: killed in {', '.join(one.struck) or 'no part'}: {one.verdict} {one.said}".strip()


def show(done: Sequence[Trial], seed: int, seconds: float) -> None:
    """Print what came of the trials."""
    print("\n| runs | trials | kills | equal | refused in a sentence | different |\n|---|---|---|---|---|---|")
    rows = [(sort, [one for one in done if one.sort == sort and not one.harm]) for sort in SORTS]
    rows += [(f"checkpoints {harm}", [one for one in done if one.harm == harm]) for harm in _HARMS]
    for name, trials in [*rows, ("all", list(done))]:
        verdicts = Counter(one.verdict for one in trials)
        cells = [len(trials), sum(len(one.struck) for one in trials)]
        cells += [verdicts[one] for one in ("equal", "refused", "different")]
        print(f"| {name} | {' | '.join(map(str, cells))} |")
    struck = Counter(place for one in done for place in one.struck)
    print("\n| struck | kills |\n|---|---|")
    for place in _PLACES:
        print(f"| {place} | {struck[place]} |")
    for sentence in sorted({one.said for one in done if one.verdict == "refused"}):
        print(f"\nrefused: {sentence}")
    verdicts = Counter(one.verdict for one in done)
    data = {"trials": len(done), "kills": sum(struck.values()), "seed": seed, "seconds": round(seconds)}
    data["rebuilt"] = sum(one.said == _KEPT for one in done)
    print(json.dumps({**data, **{name: verdicts[name] for name in ("equal", "refused", "different")}}))
    sys.exit(verdicts["different"] > 0)


if __name__ == "__main__":
    main()
