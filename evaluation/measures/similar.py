"""Success by the similarity of whole tasks: thought and act in words, where the predicate compares the things alone.

DEVIATES: the paper has no such measure. Its predicate takes a notebook for a wanted sketchbook for useless, and a
hairbrush for a wanted toothbrush for useful; with thought and act beside the thing, sentence embeddings tell these
apart more often. The thresholds were set on one half of the hand-labelled offers of `benchmarks/samples/offers`, in
which no run was judged; `python -m benchmarks.offers` sets them anew and reports on the other half.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from coopera.core.hour import Task, TaskCandidate
from coopera.evaluation.measuring import MeasuredHour, by_counts

SIMILAR = {"pick_place": 0.59, "hand_over": 0.44}
"""The cosine from which an offer helps, by the kind of the robot's act: two sentences "put … on …" are always alike."""


def in_words(thought: str, act: str) -> str:
    """Say a whole task: why, and what."""
    return f"{thought.strip().rstrip('.')}. {act}."


def helps(alike: Callable[[str, str], float], offer: TaskCandidate, remaining: Sequence[Task]) -> bool:
    """Whether an offer is similar to one of the remaining tasks."""
    offered, least = _said(offer), SIMILAR[offer.act.kind]
    return any(alike(offered, _said(task)) >= least for task in remaining)


def _said(task: Task | TaskCandidate) -> str:
    return in_words(task.thought, task.act.describe())


def _verdicts(hour: MeasuredHour) -> list[bool]:
    return [helps(hour.alike, offer, hour.remaining) for offer in hour.candidates]


MEASURE = by_counts(
    "similar",
    "F1 over the robot's candidates; one helps if it is similar to a remaining task as a whole, thought and act",
    _verdicts,
    order=4,
    at_end=False,
)
