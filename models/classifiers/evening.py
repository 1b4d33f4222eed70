"""What the classifiers trained by gradient share of an evening: which examples, which are held out, how weighed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import torch
from torch import Tensor

from coopera.core.errors import LearningError
from coopera.core.hour import Example
from coopera.models.classifiers.text import Inputs, Lesson, lesson


class Evening(NamedTuple):
    """What is learned from in an evening.

    Attributes:
        examples: A bounded number of labelled ones, in order of time.
        labels: Shape (n,); both labels occur.
        held_out: Shape (n,): examples of each fourth hour, on which the threshold is chosen. None where they, or the
            others, would not have both labels.
        rng: For the order of training; it chose the examples.
    """

    examples: list[Example]
    labels: npt.NDArray[np.bool_]
    hours: list[int]
    held_out: npt.NDArray[np.bool_]
    rng: np.random.Generator


def evening(
    examples: Sequence[Example], inputs: Inputs, *, most: int, seed: int
) -> tuple[dict[str, float], Evening | None]:
    """Choose what to learn from; None where there is not at least one example of each label.

    Returns:
        How many `examples` had a label and how many `positives` there were, and what is chosen of them.
    """
    taught = lesson(examples, inputs)
    counts = {"examples": float(len(taught.labels)), "positives": float(sum(taught.labels))}
    if not taught.teaches:
        return counts, None
    rng = np.random.default_rng(seed)
    taught = _rehearsed(taught, most, rng)
    labels, held_out = np.array(taught.labels), _every_fourth_hour(taught)
    if len(set(labels[~held_out])) < 2 or len(set(labels[held_out])) < 2:
        held_out[:] = False
    return counts, Evening(taught.examples, labels, taught.hours, held_out, rng)


def balanced(labels: npt.NDArray[np.bool_]) -> Tensor:
    """Return a weight per example by which both labels weigh the same in all, with mean 1, shape (n,)."""
    yes = float(labels.mean())
    return torch.from_numpy(np.where(labels, 0.5 / yes, 0.5 / (1 - yes)).astype(np.float32))


def must_be_finite(what: str, value: float, *, classifier: str, rate: float) -> None:
    """Raise LearningError if a loss or an answer is no number; what was learned before must then be kept."""
    if not math.isfinite(value):
        raise LearningError(
            f"the {classifier} could not learn: its {what} became {value} at learning rate {rate}; "
            "what it learned before is kept"
        )


def _every_fourth_hour(taught: Lesson) -> npt.NDArray[np.bool_]:
    """Mark the examples of each fourth hour, other hours each day and the same each evening, shape (n,)."""
    days, hours = np.divmod(np.array(taught.hours), 24)
    marked: npt.NDArray[np.bool_] = (days + hours) % 4 == 3
    return marked


def _rehearsed(taught: Lesson, most: int, rng: np.random.Generator) -> Lesson:
    """Keep at most `most` examples: up to a third positives, the newest day's first, then a sample."""
    n = len(taught.labels)
    if n <= most:
        return taught
    newest = taught.hours[-1] // 24
    chance = rng.random(n)
    rank = sorted(range(n), key=lambda row: (taught.hours[row] // 24 != newest, chance[row]))
    yes = [row for row in rank if taught.labels[row]][: most // 3]
    no = [row for row in rank if not taught.labels[row]]
    kept = sorted([*yes, *no[: most - len(yes)]])
    return Lesson(
        [taught.examples[row] for row in kept],
        [taught.labels[row] for row in kept],
        [taught.hours[row] for row in kept],
    )


@contextmanager
def one_thread() -> Iterator[None]:
    """Compute on one thread, so that sums have one order and a run leaves the other cores alone."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
