"""Examples as numbers, and how alike two examples are: a sum of products of simple kernels.

Similarity of what is proposed is multiplied with similarity of when, to whom and after what. So "yes" to a cup of tea
at 4 pm speaks for a similar thing at a similar hour, more for the same person than for another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings

from core.hour import Example
from core.people import TRAITS
from memory.embeddings import as_array
from models.classifiers.text import sentences

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

_SENTENCES, _INTENTIONS, _TASKS = 6, 3, 5  # so many are looked at: PAPER App. D retrieves 3 intentions and 5 tasks
MATCHES = 6


@dataclass(frozen=True, slots=True)
class Batch:
    """n examples over a table of the vectors of all their texts. An index of -1 points at no text."""

    vectors: Floats
    """(u, d), unit norm."""
    candidate: Ints
    intention: Ints
    profile: Ints
    """(n, 6): the first sentences of the profile."""
    intentions: Ints
    """(n, 3): recalled, best first."""
    tasks: Ints
    """(n, 5)"""
    hour: Floats
    big_five: Floats
    """(n, 5), each in [1, 5]; 3 where unknown."""
    person: npt.NDArray[np.str_]

    def __len__(self) -> int:
        return len(self.candidate)

    def take(self, rows: npt.NDArray[np.int64]) -> Batch:
        """Return some of the examples over the same table."""
        columns = {name: column[rows] for name, column in self.arrays().items() if name != "vectors"}
        return replace(self, **columns)

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Return the fields by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def read(examples: Sequence[Example], embeddings: Embeddings) -> Batch:
    """Look up every text's vector, each text once."""
    table: dict[str, int] = {}

    def indices(texts: Sequence[str], width: int) -> list[int]:
        found = [table.setdefault(text, len(table)) for text in texts[:width] if text]
        return found + [-1] * (width - len(found))

    def column(texts: Callable[[Example], Sequence[str]], width: int) -> Ints:
        return np.array([indices(texts(example), width) for example in examples], np.int32).reshape(-1, width)

    candidate = column(lambda e: [e.candidate], 1)[:, 0]
    intention = column(lambda e: [e.intention], 1)[:, 0]
    profile = column(lambda e: sentences(e.profile), _SENTENCES)
    intentions = column(lambda e: e.intentions, _INTENTIONS)
    tasks = column(lambda e: e.tasks, _TASKS)
    traits = [[getattr(e.big_five, trait) if e.big_five else 3.0 for trait in TRAITS] for e in examples]
    return Batch(
        vectors=as_array(embeddings, list(table)).astype(np.float64),
        candidate=candidate,
        intention=intention,
        profile=profile,
        intentions=intentions,
        tasks=tasks,
        hour=np.array([e.hour for e in examples], np.float64),
        big_five=np.array(traits, np.float64).reshape(-1, len(TRAITS)),
        person=np.array([e.person for e in examples], np.str_),
    )


@dataclass(frozen=True, slots=True)
class Similarity:
    """The product kernel, with its widths and weights.

    Widths were chosen on simulated people whom no benchmark uses (see benchmarks/classifier.py), with a wide optimum.

    Attributes:
        task: Whether what is judged is a task, which belongs to an intention.
        centre: Mean vector of the learned candidates and of their intentions, shape (2, d): what all have in common
            says nothing, so it is taken off.
    """

    task: bool
    centre: Floats
    width: float = 0.7
    hours: float = 1.5
    match: float = 0.37
    profile: float = 0.5
    traits: float = 3.0
    kin: float = 0.5
    """How far a person just like this one counts as this one, in [0, 1]."""
    private: float = 1.0
    """Weight of what is learned of one person, relative to what is learned of all."""

    def gram(self, a: Batch, b: Batch) -> Floats:
        """Return how alike each example of `a` is to each of `b`, shape (len(a), len(b)); symmetric and PSD."""
        hours = np.exp(-((a.hour[:, None] - b.hour[None]) ** 2) / (2 * self.hours**2))
        who = self._persons(a, b) * self.private + 1.0
        total = 1.0 + _rbf(_matches(a), _matches(b), self.match * np.sqrt(MATCHES))
        after = _rbf(_mean(a, a.intentions), _mean(b, b.intentions), self.width)
        what = self._texts(a, b, "candidate", 0)
        if not self.task:
            return total + what * (1.0 + hours + after) * who / 2
        aim = self._texts(a, b, "intention", 1)
        return total + (aim * (1.0 + hours + after + 2.0 * what) + what) * who / 2

    def _texts(self, a: Batch, b: Batch, column: str, centre: int) -> Floats:
        ia, ib = getattr(a, column), getattr(b, column)
        ua, ja = np.unique(ia, return_inverse=True)
        ub, jb = np.unique(ib, return_inverse=True)
        kernel = _rbf(_rows(a, ua) - self.centre[centre], _rows(b, ub) - self.centre[centre], self.width)
        spread: Floats = kernel[np.ix_(ja, jb)]
        return spread

    def _persons(self, a: Batch, b: Batch) -> Floats:
        """1 for the same person; for others at most `kin`, less the less their profiles and traits are alike."""
        same = (a.person[:, None] == b.person[None]).astype(np.float64)
        alike = _rbf(_mean(a, a.profile), _mean(b, b.profile), self.profile)
        alike *= _rbf(a.big_five, b.big_five, self.traits)
        mixed: Floats = (1 - self.kin) * same + self.kin * alike
        return mixed


def centre_of(batch: Batch) -> Floats:
    """Return the mean vectors of the distinct candidates and of the distinct intentions, shape (2, d)."""
    means = [_rows(batch, np.unique(column)).mean(axis=0) for column in (batch.candidate, batch.intention)]
    return np.stack(means)


def _rows(batch: Batch, indices: Ints) -> Floats:
    """Return the vectors at some indices, zeros for -1."""
    padded = np.vstack([batch.vectors, np.zeros((1, batch.vectors.shape[1]))])
    return padded[indices]


def _mean(batch: Batch, indices: Ints) -> Floats:
    """Return the mean vector of each row's texts, earlier ones counting more; zeros where there are none."""
    weights = (indices >= 0) * 0.7 ** np.arange(indices.shape[1])
    total = weights.sum(axis=1, keepdims=True)
    weights = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    mean: Floats = np.einsum("nk,nkd->nd", weights, _rows(batch, indices))
    return mean


def _matches(batch: Batch) -> Floats:
    """Return how well each candidate fits what is known: cosines with the recalled and the profile, shape (n, 6)."""
    aim = np.where(batch.intention >= 0, batch.intention, batch.candidate)
    parts = []
    for what, known in ((aim, batch.intentions), (batch.candidate, batch.tasks), (aim, batch.profile)):
        cosines = np.einsum("nd,nkd->nk", _rows(batch, what), _rows(batch, known))
        there = known >= 0
        best = np.where(there.any(axis=1), np.where(there, cosines, -1.0).max(axis=1), 0.0)
        mean = np.where(there, cosines, 0.0).sum(axis=1) / np.maximum(there.sum(axis=1), 1)
        parts += [best, mean]
    return np.stack(parts, axis=1)


def _rbf(a: Floats, b: Floats, width: float) -> Floats:
    """Return exp(-squared distance / (2 width²)) for each pair of rows."""
    squared = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1)[None] - 2 * (a @ b.T)
    kernel: Floats = np.exp(np.maximum(squared, 0.0) / (-2 * width * width))
    return kernel
