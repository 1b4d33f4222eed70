"""Does the robot learn? Success by day over the shipped people and several seeds, with intervals.

.venv/bin/python -m benchmarks.learning --seeds 5 --collab 2 --methods ours,shuffled --out runs/learning

Each seed lives with two of the ten people (seed 0 with the first two, and so on in turn), five days each, in one home,
without pictures. Runs that are finished already are read, not done again. Prints a Markdown table: the mean predicate
and judge F1 of each day over person-episodes, and last day minus first day, each with a 95 % bootstrap interval.

The method "shuffled" is ours with the yes and no of each day dealt out anew at random to the classifiers: what it gains
is not learned from feedback.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from coopera import Config, run_study
from coopera.config import default_data_dir
from coopera.humans import shipped_ids
from core.hour import Example
from core.protocols import Classifier
from evaluation import METHODS, register
from evaluation.statistics import bootstrap_mean
from memory.embeddings import bundled
from models.classifiers import Kind, make_classifier

PEOPLE_PER_SEED = 2


class Shuffled:
    """A classifier that learns from labels dealt out at random; all else is the inner one's."""

    def __init__(self, inner: Classifier) -> None:
        self._inner = inner
        self.probabilities, self.save, self.load = inner.probabilities, inner.save, inner.load

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Shuffle the labels of each day among themselves, then learn."""
        dealt = list(examples)
        for day in sorted({example.day for example in examples}):
            rows = [row for row, example in enumerate(examples) if example.day == day]
            for row, other in zip(rows, np.random.default_rng(day).permutation(rows), strict=True):
                dealt[row] = examples[row].model_copy(update={"label": examples[other].label})
        return self._inner.train(dealt, seed=seed)


def shuffled(kind: Kind) -> Classifier:
    """A new kernel classifier behind `Shuffled`."""
    embeddings = bundled(default_data_dir() / "embeddings.sqlite")
    return Shuffled(make_classifier("kernel", kind=kind, embeddings=embeddings))


def main() -> None:
    """Run what is missing and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--days", type=int, default=5)
    parser.add_argument("--collab", default="1,2")
    parser.add_argument("--methods", default="ours,random")
    parser.add_argument("--classifier", default="kernel")
    parser.add_argument("--humans", help="comma-separated ids, by default the ten shipped people")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/learning"))
    args = parser.parse_args()
    types = [int(collab) for collab in args.collab.split(",")]
    jobs = list(product(args.methods.split(","), types, range(args.seeds)))
    with ProcessPoolExecutor(args.workers) as pool:
        summaries = list(pool.map(_summary, [(args, *job) for job in jobs]))
    for collab in types:
        _print_table(collab, args.days, [s for s, job in zip(summaries, jobs, strict=True) if job[1] == collab])


def _summary(job: tuple[argparse.Namespace, str, int, int]) -> dict[str, Any]:
    args, method, collab, seed = job
    folder = args.out / f"{method}-{args.classifier}-type{collab}-seed{seed}"
    if (folder / "summary.json").is_file():
        found: dict[str, Any] = json.loads((folder / "summary.json").read_text())
        return found
    people = args.humans.split(",") if args.humans else list(shipped_ids())
    first = seed * PEOPLE_PER_SEED % len(people)
    register(replace(METHODS["ours"], name="shuffled", judge=shuffled))
    config = Config(
        humans=people[first : first + PEOPLE_PER_SEED],
        collab=collab,
        days=args.days,
        method=method,
        seed=seed,
        classifier=args.classifier,
        pictures="none",
        out=folder,
    )
    return run_study(config)


def _print_table(collab: int, days: int, summaries: list[dict[str, Any]]) -> None:
    print(f"\nCollaboration type {collab}\n")
    print("| method | measure | " + " | ".join(f"day {day + 1}" for day in range(days)) + " | last - first |")
    print("|---|---|" + "---|" * (days + 1))
    for method, measure in product(dict.fromkeys(s["method"] for s in summaries), ("predicate", "judge")):
        curves = _curves([s for s in summaries if s["method"] == method], measure)
        columns = [bootstrap_mean([curve[day] for curve in curves]) for day in range(days)]
        gain = bootstrap_mean([curve[-1] - curve[0] for curve in curves])
        cells = [f"{c.mean:.3f} [{c.low:.3f}, {c.high:.3f}]" for c in (*columns, gain)]
        print(f"| {method} (n={len(curves)}) | {measure} | " + " | ".join(cells) + " |")


def _curves(summaries: list[dict[str, Any]], measure: str) -> list[list[float]]:
    """F1 by day of each person-episode; a day without any F1 counts as 0."""
    curves: dict[tuple[int, int], list[float]] = {}
    for summary in summaries:
        for day in summary["days"]:
            curves.setdefault((summary["seed"], day["episode"]), []).append(day[measure]["f1"] or 0.0)
    return list(curves.values())


if __name__ == "__main__":
    main()
