"""Compare the yes/no classifiers in a toy of the whole loop: what they learn in four evenings, and how long it takes.

    python -m benchmarks.classifier --people 8 --classifiers kernel lora

Each person lives five days. Each hour the robot imagines five intentions, and the classifier under test accepts some.
The robot imagines five tasks for each of these, and the classifier accepts some. In the evening it learns from all
these candidates. Day 0 is untrained. "task F1" is the study's measure: over the tasks imagined for accepted intentions.
All classifiers meet the same human days. `lora-instruct` has a small random model of Mistral's architecture for a base,
without any language, unless --classifier-config gives another. People 0 to 99 served to develop the classifiers; a
benchmark takes people from 1000 on.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
from langchain_core.embeddings import Embeddings

from benchmarks.tiny_mistral import tiny_recipe
from benchmarks.toy_household import Lived, Robot, draw_person, live_day
from coopera.core.hour import CandidateKind, Example
from coopera.core.protocols import Classifier
from coopera.graphs.robots.rehearsal import keep
from coopera.memory.embeddings import bundled
from coopera.models.classifiers import Inputs, known_classifiers, make_classifier
from coopera.models.classifiers.calibration import score_at
from coopera.prompts import PromptLibrary

DAYS = 5
FIRST_TEST_PERSON = 1000
USUAL_SHARE = 1.75


class AlwaysYes:
    """Accepts everything: what an untrained robot does."""

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """Return 1 for all."""
        return [1.0] * len(examples)

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Learn nothing."""
        return {}

    def save(self, folder: Path) -> None:
        """Keep nothing."""

    def load(self, folder: Path) -> None:
        """Read nothing."""


class Frequency(AlwaysYes):
    """Says yes to what was right most often so far, by its wording alone; to as many as the kernel at first."""

    def __init__(self) -> None:
        self._rates: dict[tuple[str, str], tuple[int, int]] = {}
        self._base, self._threshold = 0.5, 0.5

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        """Return how often this was right, shifted so that 0.5 is the threshold."""
        return [0.5 + (self._rate(example) - self._threshold) / 2 for example in examples]

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        """Count."""
        self._rates = {}
        for example in examples:
            yes, n = self._rates.get(self._key(example), (0, 0))
            self._rates[self._key(example)] = (yes + bool(example.label), n + 1)
        self._base = float(np.mean([bool(example.label) for example in examples]))
        rates = np.array([self._rate(example) for example in examples])
        self._threshold = score_at(rates, USUAL_SHARE * self._base)
        return {}

    def _key(self, example: Example) -> tuple[str, str]:
        return example.candidate, example.intention

    def _rate(self, example: Example) -> float:
        yes, n = self._rates.get(self._key(example), (0, 0))
        return (yes + self._base) / (n + 1)


Judged: TypeAlias = tuple[Example, bool]  # with its label, and whether it was accepted


class Day(NamedTuple):
    """What came of one day with one person."""

    intention_f1: float
    task_f1: float
    learn_seconds: float
    judge_seconds: float
    """Per 25 candidates."""


def live(
    number: int, make: Callable[[CandidateKind], Classifier], embeddings: Embeddings, days: int, mode: str = "warm"
) -> list[Day]:
    """Let a robot with two classifiers of a make live with a person, learning in the evenings as `Learner` does."""
    person = draw_person(0, number)
    robot = Robot(person, 0, embeddings)
    judges: dict[CandidateKind, Classifier] = {"intention": make("intention"), "task": make("task")}
    lessons: dict[CandidateKind, list[Example]] = {"intention": [], "task": []}
    results = []
    for day in range(days):
        lived = live_day(person, 0, day)
        asked: dict[CandidateKind, list[Judged]] = {"intention": [], "task": []}
        seconds = 0.0
        for hour in lived:
            seconds += _live_hour(robot, judges, hour, asked)
        told = [robot.hear_intention(hour) for hour in lived]
        robot.learn_person(lived)
        newest = {"profile": robot.profile, "big_five": robot.big_five}
        start = time.process_time()
        for kind in judges:
            known = [*lessons[kind], *(example for example, _ in asked[kind]), *(told if kind == "intention" else [])]
            if mode == "fresh":
                judges[kind] = make(kind)
            judges[kind].train([example.model_copy(update=newest) for example in known], seed=day)
            lessons[kind] = keep(known) if mode == "warm" else known
        learning = time.process_time() - start
        judged = sum(map(len, asked.values()))
        results.append(Day(_f1(asked["intention"]), _f1(asked["task"]), learning, seconds / judged * 25))
    return results


def _live_hour(
    robot: Robot, judges: Mapping[CandidateKind, Classifier], hour: Lived, asked: Mapping[CandidateKind, list[Judged]]
) -> float:
    """Imagine and judge for one hour, adding to `asked`; returns the seconds that judging took."""
    guesses = robot.imagine_intentions(hour)
    start = time.process_time()
    p = judges["intention"].probabilities([example for _, example in guesses])
    seconds = time.process_time() - start
    accepted = [value >= 0.5 for value in p]
    if not any(accepted):
        accepted[int(np.argmax(p))] = True
    tasks = []
    for (activity, example), yes in zip(guesses, accepted, strict=True):
        right = activity == hour.activity
        asked["intention"].append((example.model_copy(update={"label": right}), yes))
        for task in robot.imagine_tasks(hour, activity, example) if yes else []:
            helps = right and task.candidate.removeprefix("bring the ") in hour.things
            tasks.append(task.model_copy(update={"label": helps}))
    start = time.process_time()
    verdicts = judges["task"].probabilities(tasks)
    asked["task"].extend((task, value >= 0.5) for task, value in zip(tasks, verdicts, strict=True))
    return seconds + time.process_time() - start


def _f1(asked: Sequence[Judged]) -> float:
    right = sum(yes and bool(example.label) for example, yes in asked)
    counted = sum(yes for _, yes in asked) + sum(bool(example.label) for example, _ in asked)
    return 2 * right / counted if counted else 0.0


def main() -> None:
    """Run the comparison and print it as a table."""
    names = ["always-yes", "frequency", *known_classifiers()]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--people", type=int, default=8, help="how many people (default 8)")
    parser.add_argument("--first", type=int, default=FIRST_TEST_PERSON, help="number of the first person")
    parser.add_argument("--days", type=int, default=DAYS)
    parser.add_argument("--classifiers", nargs="+", choices=names, default=names)
    parser.add_argument("--blind", action="store_true", help="hide the robot's own order from the classifiers")
    parser.add_argument("--learning", choices=["warm", "fresh"], default="warm", help="as in coopera run")
    parser.add_argument("--classifier-config", type=Path, help="recipe of lora-instruct")
    parser.add_argument("--out", type=Path, help="write all figures to this JSON file")
    chosen = parser.parse_args()
    everything = {}
    with tempfile.TemporaryDirectory() as folder:
        embeddings = bundled(Path(folder) / "embeddings.sqlite")
        recipe = chosen.classifier_config
        if recipe is None and "lora-instruct" in chosen.classifiers:
            recipe = tiny_recipe(Path(folder))
        numbers = range(chosen.first, chosen.first + chosen.people)
        for number in numbers:  # so that no classifier is charged for the first encoding of a text
            live(number, lambda kind: AlwaysYes(), embeddings, chosen.days)
        print(f"{chosen.people} people, {chosen.days} days; F1 on day 0 | 1 | …, mean ± standard error over people")
        for name in chosen.classifiers:
            lives = [
                live(
                    number,
                    partial(_make, name, embeddings, Inputs(rank=not chosen.blind), recipe),
                    embeddings,
                    chosen.days,
                    chosen.learning,
                )
                for number in numbers
            ]
            everything[name] = [[day._asdict() for day in one] for one in lives]
            print(_table(name, np.array(lives)))
        embeddings.close()
    if chosen.out:
        chosen.out.write_text(json.dumps(everything, indent=1) + "\n", encoding="utf-8")


def _make(name: str, embeddings: Embeddings, inputs: Inputs, recipe: Path | None, kind: CandidateKind) -> Classifier:
    simple: dict[str, Callable[[], Classifier]] = {"always-yes": AlwaysYes, "frequency": Frequency}
    if name in simple:
        return simple[name]()
    return make_classifier(
        name, kind=kind, embeddings=embeddings, inputs=inputs, recipe=recipe, instruct=PromptLibrary().instruct
    )


def _table(name: str, figures: np.ndarray[tuple[int, int, int], np.dtype[np.float64]]) -> str:
    """Say the figures, shape (people, days, fields of Day), as lines of a table."""
    mean = figures.mean(axis=0)
    error = figures.std(axis=0, ddof=1) / np.sqrt(len(figures)) if len(figures) > 1 else np.zeros_like(mean)

    def row(column: int) -> str:
        return " | ".join(f"{m:.3f} ±{e:.3f}" for m, e in zip(mean[:, column], error[:, column], strict=True))

    return (
        f"{name:>11} | intention F1 | {row(0)}\n{'':>11} |      task F1 | {row(1)}\n"
        f"{'':>11} | last evening {mean[-1, 2]:.2f} s, 25 verdicts {1000 * mean[-1, 3]:.0f} ms"
    )


if __name__ == "__main__":
    main()
