"""The predicate of success: a rule that says which acts help (PAPER §4.3, App. C.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from coopera.core.hour import Task, TaskCandidate
from coopera.core.household import Act, FreeMotion, HandOver, PickPlace, plain
from coopera.simulation.goals.achieved import goal_of

if TYPE_CHECKING:
    from langchain_core.embeddings import Embeddings

Floats = NDArray[np.float64]

SIMILAR = 0.6  # PAPER App. C.3: the threshold of type 2
REMEMBERED = 128
"""Vectors kept; 0.4 MB of MiniLM's."""


class Classes(Protocol):
    """What the rule needs to know of a home."""

    def class_of(self, name: str) -> str:
        """The object's class, such as "mug" for "mug_2"; a name not in the home is its own class."""
        ...


@dataclass(frozen=True, slots=True)
class Predicate:
    """The rule."""

    embeddings: Embeddings
    _vectors: dict[str, Floats] = field(init=False, default_factory=dict, repr=False, compare=False)

    def matches(self, home: Classes, candidate: TaskCandidate, remaining: Sequence[Task]) -> bool:
        """Whether this candidate helps with one of the remaining tasks."""
        return any(self.helps(home, candidate.act, task.act) for task in remaining)

    def helps(self, home: Classes, act: Act, wanted: Act) -> bool:
        """Whether an act of the robot helps with an act that the person has before them.

        PAPER App. C.3: in type 1 the classes of object and receptacle are the same, whichever instances; in type 2
        the offered thing is similar (cosine of at least 0.6) to the one that the person will hold. DEVIATES: the paper
        knows no inside; here a thing that is put on what it should be put in does not help, nor the reverse.
        """
        if isinstance(act, PickPlace) and isinstance(wanted, PickPlace):
            return goal_of(act, home.class_of) == goal_of(wanted, home.class_of)
        if isinstance(act, HandOver) and isinstance(wanted, FreeMotion):
            return self._similarity(act.object, wanted.in_hand) >= SIMILAR
        return False

    def _similarity(self, one: str, other: str) -> float:
        if plain(one).lower() == plain(other).lower():
            return 1.0
        return self.alike(plain(one), plain(other))

    def alike(self, one: str, other: str) -> float:
        """Cosine of two texts."""
        return float(self._vector(one) @ self._vector(other))

    def _vector(self, text: str) -> Floats:
        """A text's vector in float64; the names of a home's things come again every hour."""
        vector = self._vectors.get(text)
        if vector is None:
            vector = np.asarray(self.embeddings.embed_query(text), dtype=np.float64)
            if len(self._vectors) >= REMEMBERED:
                self._vectors.pop(next(iter(self._vectors)), None)
            self._vectors[text] = vector
        return vector
