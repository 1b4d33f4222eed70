"""Exact top-k by recency x relevance over records in order of time, reading only as many as can matter.

A record's score is cosine(query, record) x decay^(now - hour). The scan goes backwards from the newest record. A cosine
is at most 1, so the scan ends at the first recency below the k-th best score so far: no older record can enter the
result. The length of the scan depends on the decay and on the records per hour, not on the number of records. If the
k-th best score is not positive, the bound says nothing and all records are read.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from coopera.memory.minilm import Vector
from coopera.memory.vectors import Held, Places

BLOCK = 512
"""Records per block: what is read at once."""

AT_ONCE = 8
"""Full blocks that stay in RAM while others are read: 6 MB of MiniLM's vectors, where no text is said twice."""

STEP = 192
"""Records scored at once: about as many as decide a recall, so that where blocks begin matters little."""

_ROWS = 128
"""Vectors compared at once: of more, the products would be asked of the system and given back to it each time."""

_MARGIN = 1e-4
"""More than float32 arithmetic can err in a score; what is that near to the k-th best is computed in float64."""


class Block(NamedTuple):
    """Records start, start + 1, …: unit vectors (n, d) float32 and hours (n,) int64, non-decreasing."""

    start: int
    vectors: Vector | Held
    hours: npt.NDArray[np.int64]


class Tail(NamedTuple):
    """The newest block, which is not full: with room for `BLOCK` records from start on."""

    start: int
    places: Places
    hours: npt.NDArray[np.int64]

    @classmethod
    def empty(cls, start: int) -> Tail:
        """Return room for them, with nothing in it."""
        return cls(start, np.zeros(BLOCK, np.int32), np.zeros(BLOCK, np.int64))


class _Part(NamedTuple):
    """Some records of a block, which may leave RAM, and its vectors with it, while others are read."""

    start: int
    vectors: Vector | Held
    hours: npt.NDArray[np.int64]


class Rows(Protocol):
    """Records by position, in order of time."""

    def __len__(self) -> int:
        """Number of records."""
        ...

    def block(self, number: int) -> Block:
        """Return the records number x 512 … number x 512 + 511, or as many of them as there are."""
        ...

    def first_at(self, hour: int) -> int:
        """Return the position of the first record at this hour or later; the number of records if there is none."""
        ...


class Hit(NamedTuple):
    """A record found: its position, its hour and its cosine with the query."""

    position: int
    hour: int
    relevance: float


class Hits(NamedTuple):
    """The best records, best first, and how many were looked at."""

    hits: list[Hit]
    scanned: int


class Compared(NamedTuple):
    """Consecutive records, in order of time, and how alike each is to some queries.

    Attributes:
        start: Position of the first.
        cosines: Shape (queries, n), in float64.
    """

    start: int
    cosines: npt.NDArray[np.float64]


class ArrayRows:
    """Rows held in arrays, for records that live in one process only.

    Args:
        vectors: Unit vectors, shape (n, d), float32.
        hours: Shape (n,), non-decreasing.
    """

    def __init__(self, vectors: Vector, hours: npt.NDArray[np.int64]) -> None:
        self._vectors = vectors
        self._hours = hours

    def __len__(self) -> int:
        """Return the number of records."""
        return len(self._hours)

    def block(self, number: int) -> Block:
        """Return a view of one block."""
        part = slice(number * BLOCK, (number + 1) * BLOCK)
        return Block(number * BLOCK, self._vectors[part], self._hours[part])

    def first_at(self, hour: int) -> int:
        """Find the hour by bisection."""
        return int(np.searchsorted(self._hours, hour))


def top(rows: Rows, query: Vector, k: int, *, now: int, decay: float, since: int | None = None) -> Hits:
    """Return the k records of the highest score among those with since <= hour <= now.

    Best first, and newer first where scores are equal. The order is that of cosine x decay^(newest - hour), where
    `newest` is the newest hour in question: the same order, but a long pause does not turn all scores into 0.

    Args:
        rows: The records.
        query: Unit vector, shape (d,), float32.
        k: At least 1; fewer hits are returned where there are fewer records.
        now: Hour of the recall.
        decay: In (0, 1]; with 1 nothing fades, and all records are read.
        since: First hour in question; None for no limit.
    """
    low = 0 if since is None else rows.first_at(since)
    high = rows.first_at(now + 1)
    if high <= low:
        return Hits([], 0)
    newest = rows.block((high - 1) // BLOCK)
    window = _Window(query, k, decay, int(newest.hours[high - 1 - newest.start]))
    position = high
    while position > low and not window.complete:
        block = rows.block((position - 1) // BLOCK)
        start = max(low, block.start, position - STEP)
        part = slice(start - block.start, position - block.start)
        window.take(_Part(start, block.vectors[part], block.hours[part]))
        position = start
    return Hits(window.best(), high - position)


def every(
    rows: Rows,
    queries: Vector,
    *,
    now: int,
    since: int | None = None,
    within: tuple[float, float] | None = None,
) -> Compared:
    """Compare all records with since <= hour <= now to some queries; each cosine is the one that `top` gives.

    Args:
        rows: The records.
        queries: Unit vectors, shape (queries, d), float32.
        now: Last hour in question.
        since: First hour in question; None for no limit.
        within: Bounds: a cosine below the first or above the second is given as that bound, which takes less.
    """
    low = 0 if since is None else rows.first_at(since)
    high = max(low, rows.first_at(now + 1))
    cosines = [np.empty((len(queries), 0))]
    numbers = range(low // BLOCK, -(-high // BLOCK))
    for first in range(0, len(numbers), AT_ONCE):
        blocks = [rows.block(number) for number in numbers[first : first + AT_ONCE]]
        parts = [block.vectors[max(0, low - block.start) : high - block.start] for block in blocks]
        unlike, of = _different(_joined(parts))
        cosines.append((_cosines(unlike, queries) if within is None else _clipped(unlike, queries, *within))[:, of])
    return Compared(low, np.concatenate(cosines, axis=1))


class _Window:
    """The records read so far, newest first; only those that may still be among the k best are kept."""

    def __init__(self, query: Vector, k: int, decay: float, newest: int) -> None:
        self._query = query
        self._k = k
        self._decay = decay
        self._newest = newest
        self._kept: list[_Kept] = []
        self._best = np.empty(0)
        self._floor = -np.inf
        self.complete = False
        """Whether no record before those taken can be among the k best."""

    def take(self, block: _Part) -> None:
        """Roughly score some records, in float32."""
        recency = np.power(self._decay, (self._newest - block.hours).astype(np.float64))
        unlike, of = _different(block.vectors)
        scores = recency * (unlike @ self._query)[of]
        self._best = np.concatenate((self._best, scores))
        if len(self._best) >= self._k:
            self._best = np.partition(self._best, -self._k)[-self._k :]
            kth = float(self._best[0])
            self._floor = kth - _MARGIN
            self.complete = bool(recency[0] * (1 + _MARGIN) < self._floor)  # recency[0]: nothing before is newer
        rows = np.flatnonzero(scores >= self._floor)
        unlike, of = _different(block.vectors[rows])
        self._kept.append(_Kept(scores[rows], block.start + rows, block.hours[rows], unlike, of))

    def best(self) -> list[Hit]:
        """Score the records that may be among the k best in float64, one by one, and order them.

        A float32 product depends on where in the matrix a row stands, so it only preselects.
        """
        positions, hours, cosines = [], [], []
        for kept in self._kept:
            near = np.flatnonzero(kept.scores >= self._floor)
            positions.append(kept.positions[near])
            hours.append(kept.hours[near])
            unlike, of = np.unique(kept.of[near], return_inverse=True)
            cosines.append(_cosines(kept.unlike[unlike], self._query[None])[0, of])
        position, hour, cosine = (np.concatenate(column) for column in (positions, hours, cosines))
        asked, place = np.unique(hour, return_inverse=True)
        recency = np.array([self._decay ** (self._newest - one) for one in asked.tolist()])
        order = np.lexsort((-position, -cosine * recency[place]))[: self._k]
        columns = (column[order].tolist() for column in (position, hour, cosine))
        return list(map(Hit._make, zip(*columns, strict=True)))


class _Kept(NamedTuple):
    """n records that may be among the best, with vectors of their own."""

    scores: npt.NDArray[np.float64]
    positions: npt.NDArray[np.int64]
    hours: npt.NDArray[np.int64]
    unlike: Vector
    of: npt.NDArray[np.int64]
    """Which of the `unlike` vectors each record has."""


def _cosines(vectors: Vector, queries: Vector) -> npt.NDArray[np.float64]:
    """Return the cosines of n unit vectors with some queries, shape (queries, n), each by itself.

    They are reckoned vector by vector, so that none depends on which others there are.
    """
    cosines = np.empty((len(queries), len(vectors)))
    for start in range(0, len(vectors), _ROWS):
        part = vectors[start : start + _ROWS].astype(np.float64)
        products = np.empty_like(part)
        for of_query, query in zip(cosines, queries.astype(np.float64), strict=True):
            np.multiply(part, query, out=products)
            of_query[start : start + _ROWS] = products.sum(1)
    return cosines


def _clipped(vectors: Vector, queries: Vector, low: float, high: float) -> npt.NDArray[np.float64]:
    """Return `_cosines`, clipped; those that float32 shows to lie outside the bounds are not reckoned in float64.

    One query after the other: a product of two matrices would wake BLAS's threads, which take ten times as long.
    """
    cosines = np.empty((len(queries), len(vectors)))
    for of_query, query in zip(cosines, queries, strict=True):
        of_query[:] = vectors @ query
        inside = np.flatnonzero((of_query > low - _MARGIN) & (of_query < high + _MARGIN))
        of_query[inside] = _cosines(vectors[inside], query[None])[0]
    return np.clip(cosines, low, high)


def _joined(parts: Sequence[Vector | Held]) -> Vector | Held:
    """Return the vectors of several blocks as those of one: what was said in more than one is then compared once."""
    held = [part for part in parts if isinstance(part, Held)]
    if len(held) == len(parts):
        return Held(held[0].table, np.concatenate([part.places for part in held]))
    return np.concatenate([part.array() if isinstance(part, Held) else part for part in parts])


def _different(vectors: Vector | Held) -> tuple[Vector, npt.NDArray[np.int64]]:
    """Return vectors, each once where equal ones are known, and which of these each of the n is."""
    return vectors.different() if isinstance(vectors, Held) else (vectors, np.arange(len(vectors)))
