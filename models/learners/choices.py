"""What a person chooses among things when asked for something: a kernel over requests and things, and exact identity.

Each choice teaches that the chosen thing is right for requests like this one, and the others are not. A request that is
met again word for word has the greatest likeness there is, so it counts as an exact identity does.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings
from scipy.linalg import solve
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

from coopera.memory.embeddings import as_array
from coopera.models.learners.fading import REMNANT, Fading

Floats = npt.NDArray[np.float64]

RIDGE = 0.5
_STEEP = 4.0  # log-odds per score: a choice from which was learned scores near 0.5 above the others
_LIGHT = 1e-6  # memories of less weight are not asked
_LIKE = 2  # power of a cosine: what is only vaguely alike says little


class Choices:
    """Learns from choices in the order in which they are made, and notices by itself when the person has changed.

    Attributes:
        fading: How much each choice still counts.
    """

    def __init__(self, embeddings: Embeddings, *, fades: bool = True) -> None:
        """Start with nothing told.

        Args:
            embeddings: Give a text the same vector every time.
            fades: False never forgets: the control.
        """
        self.fading = Fading()
        self._embeddings = embeddings
        self._fades = fades
        self._step = np.zeros(0, np.int64)
        self._labels = np.zeros(0)
        self._requests, self._things, self._among = np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((0, 0))
        self._solved: dict[int, Floats] = {}

    def told(self, request: str, things: Sequence[str], chosen: str) -> None:
        """Learn that of these things one was chosen.

        Raises:
            ValueError: If what was chosen is not among the things.
        """
        labels = np.array([thing == chosen for thing in things], np.float64)
        if not labels.any():
            raise ValueError(f"{chosen!r} is not among the things to choose from")
        with _one_thread():
            requests, those = self._vectors(request, things)
            likeness = self._likeness(requests, those)
            step = int(self._step[-1]) + 1 if len(self._step) else 0
            if self._fades and step:
                self.fading.begin(step)
                at = int(labels.argmax())
                foretold = [self._foretold(likeness, start)[at] for start in self.fading.starts]
                self.fading.learn(np.log(foretold))
            own = _alike(requests, requests) * _alike(those, those)
            self._among = np.block([[self._among, likeness.T], [likeness, own]]) if step else own
        self._requests = np.concatenate([self._requests, requests]) if step else requests
        self._things = np.concatenate([self._things, those]) if step else those
        self._labels = np.concatenate([self._labels, labels - labels.mean()])
        self._step = np.concatenate([self._step, np.full(len(things), step)])
        self._solved = {}

    def probabilities(self, request: str, things: Sequence[str]) -> Floats:
        """Return the probability that each thing is chosen, shape (n,); all equal before anything is known."""
        if not things:
            return np.zeros(0)
        with _one_thread():
            likeness = self._likeness(*self._vectors(request, things))
            starts = zip(self.fading.starts, self.fading.weights, strict=True)
            parts = [weight * self._foretold(likeness, start) for start, weight in starts if weight > _LIGHT]
        chances: Floats = np.sum(parts, axis=0)
        chances /= chances.sum()
        return chances

    def _vectors(self, request: str, things: Sequence[str]) -> tuple[Floats, Floats]:
        """Return the vectors of the request, once per thing, and of the things, (n, d) each."""
        vectors = as_array(self._embeddings, [request, *things]).astype(np.float64)
        return np.repeat(vectors[:1], len(things), axis=0), vectors[1:]

    def _likeness(self, requests: Floats, things: Floats) -> Floats:
        """Return how alike n things for a request are to all that was told, (n, rows told)."""
        if not len(self._step):
            return np.zeros((len(things), 0))
        return _alike(requests, self._requests) * _alike(things, self._things)

    def _foretold(self, likeness: Floats, start: int) -> Floats:
        """Return P(chosen) per thing, by a memory that begins with a choice."""
        odds = _STEEP * (likeness @ self._solution(start))
        chances: Floats = np.exp(odds - odds.max())
        chances /= chances.sum()
        return chances

    def _solution(self, start: int) -> Floats:
        """Return the weights of all that was told, by ridge regression in which what came before counts REMNANT."""
        if start not in self._solved:
            counts = np.where(self._step >= start, 1.0, REMNANT)
            found: Floats = solve(self._among + np.diag(RIDGE / counts), self._labels, assume_a="pos")
            self._solved[start] = found
        return self._solved[start]


def _one_thread() -> Any:
    """Compute on one thread: sums then have one order, and such small matrices are solved sooner."""
    return threadpool_limits(limits=1, user_api="blas")


def _alike(some: Floats, others: Floats) -> Floats:
    """Return how alike unit vectors are, (n, m), in [0, 1]."""
    found: Floats = np.clip(some @ others.T, 0.0, 1.0) ** _LIKE
    return found
