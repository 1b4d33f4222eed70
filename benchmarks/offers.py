"""How well an offer that helps is told from one that does not: `python -m benchmarks.offers`.

By the measure `similar` (the cosine of whole tasks, thought and act in words) and by the predicate (type 1: the same
thing and place, type 2: the cosine of the two things alone, at least 0.6), on offers labelled by hand
(`benchmarks/samples/offers/offers.yaml`). Every other task of the file sets the thresholds of `similar`, the others
report. AUC is the chance that an offer that helps scores above one that does not; ties count half.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml
from langchain_core.embeddings import Embeddings

from coopera.config.schema import default_data_dir
from coopera.core.household import use_of
from coopera.evaluation.measures.similar import SIMILAR, in_words
from coopera.evaluation.predicate import SIMILAR as OF_THINGS
from coopera.evaluation.predicate import Predicate
from coopera.memory import bundled

LABELLED = Path(__file__).parent / "samples" / "offers" / "offers.yaml"


class Pair(NamedTuple):
    """An offer and a task that the person had before them, each as (thought, act)."""

    wanted: tuple[str, str]
    offered: tuple[str, str]
    helps: bool

    @property
    def kind(self) -> str:
        """Of the robot's act."""
        return "hand_over" if self.offered[1].startswith("bring ") else "pick_place"


def read_pairs(path: Path = LABELLED) -> tuple[list[Pair], list[Pair]]:
    """Return the labelled pairs: those that set thresholds, and those that report on them; no task is in both."""
    tasks = yaml.safe_load(path.read_text(encoding="utf-8"))
    halves = [
        [Pair(tuple(task["wanted"]), (why, act), helps) for task in half for helps, why, act in task["offers"]]
        for half in (tasks[::2], tasks[1::2])
    ]
    return halves[0], halves[1]


def whole(predicate: Predicate, pair: Pair) -> float:
    """The cosine of whole tasks, as the measure `similar` has it."""
    return predicate.alike(in_words(*pair.wanted), in_words(*pair.offered))


def of_things(predicate: Predicate, pair: Pair) -> float:
    """The paper's predicate: cosine of the things, or in type 1 whether thing and place are the same."""
    wanted, offered = use_of(pair.wanted[1]), use_of(pair.offered[1])
    if wanted is None or offered is None:
        raise ValueError(f"{pair}: these words are of no act")
    if pair.kind == "pick_place":
        return float(wanted == offered)
    return 1.0 if wanted.thing == offered.thing else predicate.alike(wanted.thing, offered.thing)


def auc(scores: Sequence[float], labels: Sequence[bool]) -> float:
    """The area under the ROC curve."""
    yes = [score for score, label in zip(scores, labels, strict=True) if label]
    no = [score for score, label in zip(scores, labels, strict=True) if not label]
    return float(np.mean([(one > other) + 0.5 * (one == other) for one in yes for other in no]))


def threshold(scores: Sequence[float], labels: Sequence[bool]) -> float:
    """The highest threshold, to 0.01, within 0.03 of the best accuracy on single pairs.

    The peak is chance, and in an hour an offer stands beside several tasks, each of which may take it by mistake.
    """
    tried = np.round(np.arange(0.0, 1.0, 0.01), 2)
    right = np.array([np.mean((np.array(scores) >= at) == np.array(labels)) for at in tried])
    return float(tried[right >= right.max() - 0.03].max())


def main() -> None:
    """Print the thresholds that the first half sets, and what both rules are worth on the second."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        report(embeddings)


def report(embeddings: Embeddings) -> None:
    """Print it, by kind of act."""
    predicate, (setting, reporting) = Predicate(embeddings), read_pairs()
    rules: dict[str, tuple[Callable[[Predicate, Pair], float], dict[str, float]]] = {
        "similar": (whole, SIMILAR),
        "predicate": (of_things, {"pick_place": 0.5, "hand_over": OF_THINGS}),
    }
    print(f"{len(setting)} pairs set the thresholds, {len(reporting)} report")
    for kind in ("hand_over", "pick_place"):
        ours = [pair for pair in setting if pair.kind == kind]
        at = threshold([whole(predicate, pair) for pair in ours], [pair.helps for pair in ours])
        print(f"{kind}: threshold set by {len(ours)} pairs: {at:.2f} (in use: {SIMILAR[kind]:.2f})")
    for kind in ("hand_over", "pick_place", ""):
        theirs = [pair for pair in reporting if kind in pair.kind]
        labels = [pair.helps for pair in theirs]
        print(f"{kind or 'both'}: {len(theirs)} pairs, {sum(labels)} of them help")
        for name, (rule, bars) in rules.items():
            scores = [rule(predicate, pair) for pair in theirs]
            said = [score >= bars[pair.kind] for score, pair in zip(scores, theirs, strict=True)]
            hits = sum(yes and label for yes, label in zip(said, labels, strict=True))
            right = np.mean([yes == label for yes, label in zip(said, labels, strict=True)])
            f1 = 2 * hits / (sum(said) + sum(labels))
            print(f"  {name:9} AUC {auc(scores, labels):.3f}  accuracy {right:.3f}  F1 {f1:.3f}  yes to {sum(said)}")


if __name__ == "__main__":
    main()
