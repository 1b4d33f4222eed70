"""Examples as numbers, and how alike two examples are: a sum of products of simple kernels.

Similarity of what is proposed is multiplied with similarity of when, to whom and after what. So "yes" to a cup of tea
at 4 pm speaks for a similar thing at a similar hour, more for the same person than for another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings

from coopera.core.hour import Example
from coopera.core.people import TRAITS
from coopera.memory.embeddings import as_array
from coopera.models.classifiers.text import sentences

Floats = npt.NDArray[np.float64]
Vectors = npt.NDArray[np.float32]
Ints = npt.NDArray[np.int32]
Said = TypeVar("Said", str, tuple[str, ...])

_SENTENCES, _INTENTIONS, _TASKS = 6, 3, 5  # so many are looked at: PAPER App. D retrieves 3 intentions and 5 tasks
_AT_ONCE = 2**16  # likenesses; half a megabyte
_FADING = 0.7  # a recalled text counts so much of the one before it


@dataclass(frozen=True, slots=True)
class Batch:
    """n examples over a table of the vectors of all their texts. An index of -1 points at no text."""

    texts: Sequence[str]
    """Length u, each once."""
    vectors: Vectors
    """(u, d), unit norm, float32."""
    candidate: Ints
    intention: Ints
    profile: Ints
    """(n, 6): the first sentences of the profile."""
    intentions: Ints
    """(n, 3): recalled, best first."""
    tasks: Ints
    """(n, 5)"""
    hour: Floats
    rank: Floats
    """-1 where unknown."""
    big_five: Floats
    """(n, 5), each in [1, 5]; 3 where unknown."""
    person: npt.NDArray[np.str_]

    def __len__(self) -> int:
        return len(self.candidate)

    def take(self, rows: npt.NDArray[np.int64]) -> Batch:
        """Return some of the examples over the same table."""
        return replace(self, **{name: column[rows] for name, column in self.columns().items()})

    def columns(self) -> dict[str, Any]:
        """Return what there is of each example, by name."""
        return {name: getattr(self, name) for name in COLUMNS}


COLUMNS = tuple(field.name for field in fields(Batch) if field.name not in ("texts", "vectors"))


def read(examples: Sequence[Example], embeddings: Embeddings) -> Batch:
    """Look up every text's vector, each text once."""
    table: dict[str, int] = {}

    def indices(texts: Sequence[str], width: int) -> list[int]:
        found = [table.setdefault(text, len(table)) for text in texts[:width] if text]
        return found + [-1] * (width - len(found))

    def column(said: Sequence[Said], texts: Callable[[Said], Sequence[str]], width: int) -> Ints:
        once = {one: indices(texts(one), width) for one in dict.fromkeys(said)}
        return np.array([once[one] for one in said], np.int32).reshape(-1, width)

    candidate = column([e.candidate for e in examples], lambda text: [text], 1)[:, 0]
    intention = column([e.intention for e in examples], lambda text: [text], 1)[:, 0]
    profile = column([e.profile for e in examples], sentences, _SENTENCES)
    intentions = column([tuple(e.intentions) for e in examples], list, _INTENTIONS)
    tasks = column([tuple(e.tasks) for e in examples], list, _TASKS)
    traits = [[getattr(e.big_five, trait) if e.big_five else 3.0 for trait in TRAITS] for e in examples]
    texts = list(table)
    return Batch(
        texts=texts,
        vectors=as_array(embeddings, texts),
        candidate=candidate,
        intention=intention,
        profile=profile,
        intentions=intentions,
        tasks=tasks,
        hour=np.array([e.hour for e in examples], np.float64),
        rank=np.array([-1 if e.rank is None else e.rank for e in examples], np.float64),
        big_five=np.array(traits, np.float64).reshape(-1, len(TRAITS)),
        person=np.array([e.person for e in examples], np.str_),
    )


@dataclass(frozen=True, slots=True)
class _Shared:
    """Values of n examples, the equal ones stored once: `rows[of]` has shape (n, d)."""

    rows: Floats
    of: npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class _Means:
    """Mean vectors of the texts of n examples, the equal ones once: `rows()[of]` has shape (n, d).

    A classifier keeps them for all that it learned from, so the rows are worked out anew each time: what they are made
    of is half as large in a long life.

    Attributes:
        vectors: The batch's, shape (u, d), float32.
        texts: Which of them, shape (m, k); -1 for none.
        weights: What each counts, shape (m, k).
        centre: What is taken off.
        of: Which row is whose, shape (n,).
    """

    vectors: Vectors
    texts: Ints
    weights: Floats
    centre: Floats | float
    of: npt.NDArray[np.int64]

    def rows(self) -> Floats:
        """The means less the centre, shape (m, d)."""
        found = np.zeros((len(self.texts), self.vectors.shape[1]))
        for texts, weights in zip(self.texts.T, self.weights.T, strict=True):
            there = texts >= 0
            found[there] += weights[there, None] * self.vectors[texts[there]]
        return found - self.centre


@dataclass(frozen=True, slots=True)
class _People:
    """The person of each of n examples as they were known then, each different one once.

    Attributes:
        profile: Mean vectors, shape (u, d).
        big_five: Shape (u, 5).
        name: Shape (u,).
        of: Which of them it is, shape (n,).
    """

    profile: Floats
    big_five: Floats
    name: npt.NDArray[np.str_]
    of: npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Points:
    """What the similarity of n examples is computed from; see `Similarity.points`."""

    candidate: _Means
    intention: _Means
    after: _Means
    hour: _Shared
    rank: _Shared
    people: _People
    matches: Floats

    def __len__(self) -> int:
        return len(self.matches)


@dataclass(frozen=True, slots=True)
class Similarity:
    """The product kernel, with its widths and weights.

    The widths were chosen on people whom no benchmark uses; the optimum is wide (halving or doubling one of them
    changes F1 by about 0.01).

    Attributes:
        task: Whether what is judged is a task, which belongs to an intention.
        centre: Mean vector of the learned candidates and of their intentions, shape (2, d): what all have in common
            says nothing, so it is taken off.
        width: Width of the kernels over what is proposed and over what was before, in distance of unit vectors.
        hours: Width over the hour.
        match: Width over the cosines of a candidate with what is recalled and with the profile, per cosine.
        rank: Width over the place in the robot's list, in doublings of the place counted from 1.
        profile: Width over profiles, in distance of mean vectors.
        traits: Width over the Big Five, in points.
        kin: How far a person just like this one counts as this one, in [0, 1].
    """

    task: bool
    centre: Floats
    width: float = 0.7
    hours: float = 1.5
    match: float = 0.37
    rank: float = 0.5
    profile: float = 0.5
    traits: float = 3.0
    kin: float = 0.5

    def points(self, batch: Batch) -> Points:
        """Prepare examples for `gram`."""
        return Points(
            candidate=_means(batch, batch.candidate[:, None], self.centre[0]),
            intention=_means(batch, batch.intention[:, None], self.centre[1]),
            after=_means(batch, batch.intentions, 0.0),
            hour=_once(batch.hour / self.hours),
            rank=_once(np.where(batch.rank < 0, np.inf, np.log2(1 + np.abs(batch.rank)) / self.rank)),
            people=self._people(batch),
            matches=_matches(batch) / (self.match * np.sqrt(6)),
        )

    def gram(self, a: Points, b: Points) -> Floats:
        """Return how alike each example of `a` is to each of `b`, shape (len(a), len(b)); symmetric and PSD.

        What is equal is compared once, and the rows are made a few at a time, so that they stay in the cache.
        """
        hours = np.exp((a.hour.rows - b.hour.rows.T) ** 2 / -2)
        candidates = _rbf(a.candidate.rows(), b.candidate.rows(), self.width)[:, b.candidate.of]
        before = _rbf(a.after.rows(), b.after.rows(), self.width)[:, b.after.of]
        aims = _rbf(a.intention.rows(), b.intention.rows(), self.width)[:, b.intention.of] if self.task else candidates
        when, ranks = 1.0 + hours[:, b.hour.of], _rank_alike(a.rank.rows, b.rank.rows)[:, b.rank.of]
        who = ((1.0 + self._same_person(a.people, b.people)) / 2)[:, b.people.of]
        alike = np.empty((len(a), len(b)))
        step = max(1, _AT_ONCE // max(1, len(b)))
        for start in range(0, len(a), step):
            part = slice(start, start + step)
            what, then = candidates[a.candidate.of[part]], when[a.hour.of[part]]
            then += before[a.after.of[part]]
            if self.task:
                then += 2.0 * what
                then *= aims[a.intention.of[part]]
                what += then
            else:
                what *= then
            what *= who[a.people.of[part]]
            what += _rbf(a.matches[part], b.matches, 1.0)
            what += ranks[a.rank.of[part]]
            what += 1.0
            alike[part] = what
        return alike

    def _people(self, batch: Batch) -> _People:
        who = _means(batch, batch.profile, 0.0)
        traits = np.unique(batch.big_five, axis=0, return_inverse=True)[1].reshape(-1)
        names = np.unique(batch.person, return_inverse=True)[1]
        _, first, of = np.unique(np.stack([who.of, traits, names]), axis=1, return_index=True, return_inverse=True)
        profile, big_five = who.rows()[who.of[first]], batch.big_five[first] / self.traits
        return _People(profile, big_five, batch.person[first], of.reshape(-1))

    def _same_person(self, a: _People, b: _People) -> Floats:
        """1 for the same person; for others at most `kin`, less the less their profiles and traits are alike."""
        same = (a.name[:, None] == b.name[None]).astype(np.float64)
        alike = _rbf(a.profile, b.profile, self.profile)
        alike *= _rbf(a.big_five, b.big_five, 1.0)
        mixed: Floats = (1 - self.kin) * same + self.kin * alike
        return mixed


def centre_of(batch: Batch) -> Floats:
    """Return the mean vectors of the distinct candidates and of the distinct intentions, shape (2, d)."""
    padded = np.vstack([batch.vectors.astype(np.float64), np.zeros((1, batch.vectors.shape[1]))])
    return np.stack([padded[np.unique(column)].mean(axis=0) for column in (batch.candidate, batch.intention)])


def _once(values: Floats) -> _Shared:
    """Store equal numbers of n, shape (n,), once."""
    unique, of = np.unique(values, return_inverse=True)
    return _Shared(unique[:, None], of)


def _means(batch: Batch, indices: Ints, centre: Floats | float) -> _Means:
    """The mean vector of each row's texts, earlier ones counting more, less a centre; zeros where are none."""
    unique, of = np.unique(indices, axis=0, return_inverse=True)
    weights = (unique >= 0) * _FADING ** np.arange(unique.shape[1])
    total = weights.sum(axis=1, keepdims=True)
    weights = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    return _Means(batch.vectors, unique, weights, centre, of.reshape(-1))


def _matches(batch: Batch) -> Floats:
    """Return how well each candidate fits what is known: cosines with the recalled and the profile, shape (n, 6)."""
    cosines = np.zeros((len(batch.vectors) + 1, len(batch.vectors) + 1))
    vectors = batch.vectors.astype(np.float64)
    cosines[:-1, :-1] = vectors @ vectors.T
    aim = np.where(batch.intention >= 0, batch.intention, batch.candidate)
    parts = []
    for what, known in ((aim, batch.intentions), (batch.candidate, batch.tasks), (aim, batch.profile)):
        found = cosines[what[:, None], known]
        there = known >= 0
        best = np.where(there.any(axis=1), np.where(there, found, -1.0).max(axis=1), 0.0)
        mean = found.sum(axis=1) / np.maximum(there.sum(axis=1), 1)
        parts += [best, mean]
    return np.stack(parts, axis=1)


def _rank_alike(a: Floats, b: Floats) -> Floats:
    """Compare places, shapes (n, 1) and (m, 1); an unknown one is like an unknown one and like no other."""
    known_a, known_b = np.isfinite(a), np.isfinite(b)
    a, b = np.where(known_a, a, 0.0), np.where(known_b, b, 0.0)
    alike: Floats = np.exp((a - b.T) ** 2 / -2)
    alike *= known_a == known_b.T
    return alike


def _rbf(a: Floats, b: Floats, width: float) -> Floats:
    """Return exp(-squared distance / (2 width²)) for each pair of rows."""
    squared = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1)[None] - 2 * (a @ b.T)
    kernel: Floats = np.exp(np.maximum(squared, 0.0) / (-2 * width * width))
    return kernel
