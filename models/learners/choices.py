"""What a person chooses among things when asked for something: a kernel over requests and things, and exact identity.

Each choice teaches that the chosen thing is right for requests like this one, and the others are not. A request that is
met again word for word has the greatest likeness there is, so it counts as an exact identity does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from langchain_core.embeddings import Embeddings
from scipy.linalg import solve

from coopera.memory.embeddings import as_array
from coopera.models.learners.fading import REMNANT, Fading

Floats = npt.NDArray[np.float64]

RIDGE = 0.5
_STEEP = 4.0  # log-odds per score: a choice from which was learned scores near 0.5 above the others
_LIKE = 2  # power of a cosine: what is only vaguely alike says little


@dataclass(frozen=True, slots=True)
class _Told:
    """A choice: the request's vector (d,), the things' (n, d), and n labels that sum to 0."""

    request: Floats
    things: Floats
    labels: Floats


@dataclass(slots=True)
class Choices:
    """Learns from choices in the order in which they are made, and notices by itself when the person has changed.

    Attributes:
        embeddings: Give a text the same vector every time.
        fades: False never forgets: the control.
    """

    embeddings: Embeddings
    fades: bool = True
    fading: Fading = field(default_factory=Fading)
    _told: list[_Told] = field(default_factory=list)

    def told(self, request: str, things: Sequence[str], chosen: str) -> None:
        """Learn that of these things one was chosen.

        Raises:
            ValueError: If what was chosen is not among the things.
        """
        labels = np.array([thing == chosen for thing in things], np.float64)
        if not labels.any():
            raise ValueError(f"{chosen!r} is not among the things to choose from")
        vectors = as_array(self.embeddings, [request, *things]).astype(np.float64)
        one = _Told(vectors[0], vectors[1:], labels - labels.mean())
        step = len(self._told)
        if self.fades and step:
            self.fading.begin(step)
            at = int(labels.argmax())
            foretold = [self._foretold(one, self._since(start)) for start in self.fading.starts]
            self.fading.learn([float(np.log(chances[at])) for chances in foretold])
        self._told.append(one)

    def probabilities(self, request: str, things: Sequence[str]) -> Floats:
        """Return the probability that each thing is chosen, shape (n,); all equal before anything is known."""
        if not things:
            return np.zeros(0)
        vectors = as_array(self.embeddings, [request, *things]).astype(np.float64)
        asked = _Told(vectors[0], vectors[1:], np.zeros(len(things)))
        starts = zip(self.fading.starts, self.fading.weights, strict=True)
        parts = [weight * self._foretold(asked, self._since(start)) for start, weight in starts if weight > 1e-6]
        return np.sum(parts, axis=0) / np.sum(parts)

    def _since(self, start: int) -> Floats:
        """What each choice counts, shape (choices,), to a memory that begins there."""
        return np.where(np.arange(len(self._told)) >= start, 1.0, REMNANT)

    def _foretold(self, asked: _Told, counts: Floats) -> Floats:
        """Return P(chosen) per thing by ridge regression on what was told, each choice counting as said."""
        if not self._told:
            return np.full(len(asked.things), 1.0 / len(asked.things))
        things = np.concatenate([one.things for one in self._told])
        sizes = [len(one.things) for one in self._told]
        requests = np.repeat(np.stack([one.request for one in self._told]), sizes, axis=0)
        labels = np.concatenate([one.labels for one in self._told])
        among = _alike(requests, requests) * _alike(things, things)
        among[np.diag_indices_from(among)] += RIDGE / np.repeat(counts, sizes)
        likeness = _alike(asked.request[None], requests) * _alike(asked.things, things)
        odds = _STEEP * (likeness @ solve(among, labels, assume_a="pos"))
        chances: Floats = np.exp(odds - odds.max())
        return chances / chances.sum()


def _alike(some: Floats, others: Floats) -> Floats:
    """Return how alike unit vectors are, (n, m), in [0, 1]."""
    found: Floats = np.clip(some @ others.T, 0.0, 1.0) ** _LIKE
    return found
