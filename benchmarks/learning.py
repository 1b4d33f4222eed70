"""Does the robot learn? Success by day over people and seeds on the very same days, with intervals.

    python -m benchmarks.learning --seeds 5 --collab 2 --methods ours,shuffled --out runs/learning
    python -m benchmarks.learning --humans spc-valid-0001,spc-valid-0002 --seeds 1 --methods ours:lora,frequency_prior

Each seed has some of the people (by default two; seed 0 the first two, and so on in turn), five days each, in one home
(with --scenes seed 0 in the first of these, and so on in turn), without pictures. They first live these days alone, as
an earlier life; then each method's robot meets this life. Finished runs are read, stopped runs go on, so another
--household needs another --out. Prints a Markdown table: the mean need F1, predicate F1 and judge F1 of the first and
the second day, of the early days (2 to 5, those that are not late), of those between and of the late ones (the last
third), and growth from early to late, each with a 95 % interval over people; a person who lives under several seeds
is averaged first. A second table has what the first method has more than each other one on the late days, by need F1,
person by person.

A method may name its classifier after a colon (by default `kernel`). `lora-instruct` has a small random model for a
base here, unless --classifier-config gives another. The method "shuffled" is ours with shuffled labels: each day's yes
and no reach the classifiers in random order. All else stays: the retrieved days, the belief, the number of yes. Its
gain cannot come from feedback. The method "unturned" is ours that takes no notice of turns in a life; --changes gives
everybody some, in a file as for `coopera run --changes`. "neither" is ours without traits and without context.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path
from statistics import fmean
from typing import Any, NamedTuple

from coopera import Config, resume_study, run_study
from coopera.config.at_most import at_most, smaller
from coopera.config.schema import default_data_dir
from coopera.core.hour import CandidateKind, Example
from coopera.core.household import Collab
from coopera.core.protocols import Classifier
from coopera.core.randomness import rng_at
from coopera.evaluation import METHODS, register
from coopera.evaluation.analysis import STATED
from coopera.evaluation.statistics import mean_over_people
from coopera.memory.embeddings import bundled
from coopera.models.classifiers import make_classifier
from coopera.people.shipped import shipped_ids


class Shuffled:
    """A classifier that learns from each day's labels dealt out at random among that day's candidates."""

    def __init__(self, inner: Classifier) -> None:
        self._inner = inner
        self.probabilities, self.save, self.load = inner.probabilities, inner.save, inner.load

    @property
    def gives_chances(self) -> bool:
        """As the classifier behind it."""
        return bool(getattr(self._inner, "gives_chances", False))

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Shuffle the labels of each day among themselves, then learn."""
        dealt = list(examples)
        for day in sorted({example.day for example in examples}):
            rows = [row for row, example in enumerate(examples) if example.day == day]
            for row, other in zip(rows, rng_at(seed, "shuffled", day).permutation(rows), strict=True):
                dealt[row] = examples[row].model_copy(update={"label": examples[other].label})
        return self._inner.train(dealt, seed=seed)


def shuffled(kind: CandidateKind) -> Classifier:
    """A new kernel classifier behind `Shuffled`."""
    embeddings = bundled(default_data_dir() / "embeddings.sqlite")
    return Shuffled(make_classifier("kernel", kind=kind, embeddings=embeddings))


class Job(NamedTuple):
    """One run: a method, its classifier, a collaboration type and a seed; `ALONE` is the life without a robot."""

    method: str
    classifier: str
    collab: Collab
    seed: int


ALONE = ("none", "kernel")


def main() -> None:
    """Run what is missing and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--days", type=int, default=5)
    parser.add_argument("--collab", default="1,2")
    parser.add_argument("--methods", default="ours,random", help="comma-separated, each METHOD or METHOD:CLASSIFIER")
    parser.add_argument("--classifier-config", type=Path, help="recipe of lora-instruct")
    parser.add_argument(
        "--household", default="own", help="what the robot knows of life at home: own, shared or a file"
    )
    parser.add_argument("--changes", default="none", help="what changes in the lives: none, seeded or a file")
    parser.add_argument("--humans", help="comma-separated ids, by default the ten shipped people")
    parser.add_argument("--people-per-seed", type=int, default=2)
    parser.add_argument("--scenes", help="comma-separated homes, one per seed in turn; by default the first for all")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/learning"))
    args = parser.parse_args()
    args.days = smaller(args.days, at_most().days)
    known: dict[str, Collab] = {"1": 1, "2": 2}
    types = [known[collab] for collab in args.collab.split(",")]
    methods = [f"{method}:kernel".split(":")[:2] for method in args.methods.split(",")]
    if args.classifier_config is None and any(classifier == "lora-instruct" for _, classifier in methods):
        from benchmarks.tiny_mistral import tiny_recipe  # noqa: PLC0415 - torch is heavy

        args.classifier_config = tiny_recipe(args.out / "tiny-mistral")
    seeds = range(args.seeds)
    jobs = [Job(method, judge, collab, seed) for (method, judge), collab, seed in product(methods, types, seeds)]
    lives = [Job(*ALONE, collab, seed) for collab, seed in product(types, seeds)]
    with ProcessPoolExecutor(args.workers) as pool:
        each = map if args.workers == 1 else pool.map
        list(each(_summary, [(args, life) for life in lives]))
        summaries = list(each(_summary, [(args, job) for job in jobs]))
    for collab in types:
        print(f"\nCollaboration type {collab}\n")
        heads = [f"days {b[0] + 1}-{b[-1] + 1}" if len(b) > 1 else f"day {b[0] + 1}" for b in shown(args.days)]
        print("| method | measure | " + " | ".join([*heads, "growth"]) + " |")
        print("|---|---|" + "---|" * (len(heads) + 1))
        of = {
            " ".join(method): [s for s, job in zip(summaries, jobs, strict=True) if job[:3] == (*method, collab)]
            for method in methods
        }
        for name, mine in of.items():
            _print_rows(name, args.days, mine)
        _print_differences({name: _late_need(mine, args.days) for name, mine in of.items()})


def _summary(given: tuple[argparse.Namespace, Job]) -> dict[str, Any]:
    args, job = given
    folder = _folder(args.out, job)
    if (folder / "summary.json").is_file():
        found: dict[str, Any] = json.loads((folder / "summary.json").read_text())
        return found
    register(replace(METHODS["ours"], name="shuffled", judge=shuffled))
    register(replace(METHODS["ours"], name="unturned", turns=False))
    register(replace(METHODS["no_context"], name="neither", traits=False))
    if (folder / "config.yaml").is_file():
        return resume_study(folder)
    people = args.humans.split(",") if args.humans else list(shipped_ids())
    first = job.seed * args.people_per_seed % len(people)
    alone = job[:2] == ALONE
    config = Config(
        humans=people[first : first + args.people_per_seed],
        scenes=[args.scenes.split(",")[job.seed % len(args.scenes.split(","))]] if args.scenes else None,
        collab=job.collab,
        days=args.days,
        method=job.method,
        seed=job.seed,
        classifier=job.classifier,
        household=args.household,
        changes=args.changes,
        classifier_config=args.classifier_config if job.classifier == "lora-instruct" else None,
        pictures="none",
        earlier_life=None if alone else _folder(args.out, Job(*ALONE, job.collab, job.seed)),
        out=folder,
    )
    return run_study(config)


def _folder(out: Path, job: Job) -> Path:
    return out / f"{job.method}-{job.classifier}-type{job.collab}-seed{job.seed}"


def shown(days: int) -> list[range]:
    """The days of each column: the first, the second, the early ones, those between and the late ones."""
    early, late = STATED.early_days(days), STATED.late_days(days)
    between = range(early.stop, late.start) if len(early) else range(0)
    blocks = [range(1), range(1, min(2, days)), early, between, late]
    return [block for place, block in enumerate(blocks) if len(block) and block not in blocks[:place]]


def _print_rows(method: str, days: int, summaries: list[dict[str, Any]]) -> None:
    for measure, name in (("help", "need"), ("predicate", "predicate"), ("judge", "judge")):
        curves = _curves(summaries, measure)
        late, early = STATED.late_days(days), STATED.early_days(days)
        columns = [mean_over_people([_mean(curve, block) for curve in curves]) for block in shown(days)]
        grown = [_mean(curve, late) - _mean(curve, early) for curve in curves] if len(early) else []
        cells = [*map(str, columns), str(mean_over_people(grown)) if grown else "–"]
        print(f"| {method} (n={len(curves)}) | {name} | " + " | ".join(cells) + " |")


def _late_need(summaries: list[dict[str, Any]], days: int) -> list[float]:
    return [_mean(curve, STATED.late_days(days)) for curve in _curves(summaries, "help")]


def _print_differences(late: dict[str, list[float]]) -> None:
    """The first method less each other, by the mean need F1 of the late days."""
    (first, mine), *others = late.items()
    print(f"\n| {first} less | late days | better for |\n|---|---|---|")
    for name, theirs in others:
        more = [one - other for one, other in zip(mine, theirs, strict=True)]
        print(f"| {name} | {mean_over_people(more)} | {sum(x > 0 for x in more)} of {len(more)} |")


def _mean(curve: Sequence[float], days: range) -> float:
    return fmean(curve[day] for day in days)


def _curves(summaries: list[dict[str, Any]], measure: str) -> list[list[float]]:
    """F1 by day of each person, the mean of their episodes; a day without any F1 counts as 0."""
    curves: dict[str, dict[tuple[int, int], list[float]]] = {}
    for summary in summaries:
        for day in summary["days"]:
            episode = curves.setdefault(day["person"], {}).setdefault((summary["seed"], day["episode"]), [])
            episode.append(day[measure]["f1"] or 0.0)
    return [list(map(fmean, zip(*curves[person].values(), strict=True))) for person in sorted(curves)]


if __name__ == "__main__":
    main()
