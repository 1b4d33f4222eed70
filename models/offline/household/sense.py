"""Common sense in use: what a text is about, what resembles what. The same for person, robot and judge."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from coopera.core.household import plain
from coopera.models.offline.household.knowledge import Activity, Floats, Household, key

SURE = 0.45
"""Certainty from which a text counts as recognised. By MiniLM and the robot's file 9 in 10 of the person's wordings
that are recognised rightly reach it, and 4 in 10 of those whose activity that file lacks: `python -m
benchmarks.household_overlap`."""
_WHEN = re.compile(
    r"(?<=\w) (?:after|before) (?:breakfast|lunch|dinner|supper|a meal|meals|eating|food|work|school|bed|bedtime)\b",
    re.IGNORECASE,
)
REMEMBERED, VECTORS = 2048, 256  # texts and pairs of texts kept; vectors, 0.4 MB of MiniLM's


class Embed(Protocol):
    """What is needed of LangChain's `Embeddings`."""

    def embed_query(self, text: str) -> list[float]:
        """Return one text's vector."""
        ...


class Recognised(NamedTuple):
    """The activity that a text seems to speak of; `certainty` is a cosine, 1 for a known wording."""

    activity: Activity
    certainty: float

    @property
    def sure(self) -> bool:
        """Whether the text is about this activity at all, and not just nearer to it than to any other."""
        return self.certainty >= SURE


class CommonSense:
    """The household file and a text encoder, with what follows from the two.

    Texts are encoded one at a time, so that no answer depends on what was asked before.
    """

    def __init__(self, household: Household, embeddings: Embed) -> None:
        self.household = household
        self._embeddings = embeddings
        self._vectors: dict[str, NDArray[np.float32]] = {}
        self._cosine = lru_cache(maxsize=REMEMBERED)(self._work_out_cosine)

    def vectors(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return unit vectors of the texts, shape (n, d)."""
        return np.stack([self._vector(text) for text in texts])

    def similarity(self, one: str, other: str) -> float:
        """Cosine of two texts, 1 where they are the same but for case, plural underscores and numbers."""
        return self._cosine(_words(one), _words(other))

    def _work_out_cosine(self, one: str, other: str) -> float:
        return 1.0 if one == other else float(self._vector(one) @ self._vector(other))

    def thing_fit(self, thing: str) -> Floats:
        """Return how like a thing is to the likest one that each activity has in hand; shape (activities,)."""
        words = _words(thing)
        fit = np.maximum.reduceat(self._thing_vectors @ self._vector(words), self._thing_starts)
        has = [words in names for names in self._thing_words]
        return np.where(has, 1.0, np.minimum(fit, 0.99)).astype(np.float64)

    def nearest(self, text: str, options: Sequence[str]) -> tuple[int, float]:
        """Return the place of the option nearest in meaning, and its cosine; the first of equals."""
        cosines = [self.similarity(text, option) for option in options]
        best = int(np.argmax(cosines))
        return best, cosines[best]

    def recognise(self, text: str) -> Recognised:
        """Name the activity that an intention's text speaks of, also one that is not from the household file.

        When it is done does not count: "Wash the dishes after breakfast" is about dishes, not about breakfast.
        """
        act = _WHEN.sub("", text)
        if known := self.household.named(text) or self.household.named(act):
            return Recognised(known, 1.0)
        cosines = self._ways_to_say @ self._vector(act)
        best = int(np.argmax(cosines))
        return Recognised(self._said_of[best], float(cosines[best]))

    def index(self, text: str) -> int:
        """Return the place of the activity that a text speaks of."""
        return self.household.index[self.recognise(text).activity.id]

    def fit(self, texts: Sequence[str]) -> Floats:
        """Return how near each text is to each activity; shape (n, activities).

        It is the best cosine to the activity's statement and to one plain text for each of its wordings.
        """
        rows = self.vectors(texts) @ self._activity_texts.T
        return np.maximum.reduceat(rows, self._starts, axis=1).astype(np.float64)

    @cached_property
    def generic_fit(self) -> Floats:
        """How near each activity is to talk of other activities: its bias, taken off before people are compared."""
        fit = self.fit([activity.statement for activity in self.household.activities])
        np.fill_diagonal(fit, np.nan)
        return np.asarray(np.nanmean(fit, axis=0), dtype=np.float64)

    def motion_class(self, motion: str) -> str:
        """Return what a motion looks like to a coarse recogniser; an unknown text is taken as the nearest."""
        known = self.household.looks_like
        if motion in known:
            return known[motion]
        classes = list(dict.fromkeys(known.values()))
        if motion in classes:
            return motion
        captions = list(known)
        return known[captions[self.nearest(motion, captions)[0]]]

    def mentioned(self, text: str, things: Iterable[str]) -> list[str]:
        """Return the things whose names stand in a text, in the given order."""
        said = f" {key(text)} "
        return [thing for thing in things if f" {key(plain(thing))} " in said]

    @cached_property
    def looks(self) -> dict[str, Floats]:
        """Share of each activity's things whose motion looks like a class, by class; shape (activities,) each."""
        shares: dict[str, Floats] = {}
        for cls in dict.fromkeys(self.household.looks_like.values()):
            seen = [[self.household.looks_like[m] == cls for m in a.things.values()] for a in self.household.activities]
            shares[cls] = np.array([np.mean(row) for row in seen], dtype=np.float64)
        return shares

    @cached_property
    def _thing_words(self) -> list[list[str]]:
        return [[_words(thing) for thing in activity.things] for activity in self.household.activities]

    @cached_property
    def _thing_vectors(self) -> NDArray[np.float32]:
        return self.vectors([thing for names in self._thing_words for thing in names])

    @cached_property
    def _thing_starts(self) -> list[int]:
        sizes = [len(names) for names in self._thing_words]
        return [sum(sizes[:i]) for i in range(len(sizes))]

    @cached_property
    def _activity_texts(self) -> NDArray[np.float32]:
        return self.vectors([text for a in self.household.activities for text in (a.statement, *a.canonical)])

    @cached_property
    def _said_of(self) -> list[Activity]:
        return [a for a in self.household.activities for _ in (a.statement, *a.canonical, *a.also)]

    @cached_property
    def _ways_to_say(self) -> NDArray[np.float32]:
        return self.vectors([text for a in self.household.activities for text in (a.statement, *a.canonical, *a.also)])

    @cached_property
    def _starts(self) -> list[int]:
        sizes = [1 + len(activity.canonical) for activity in self.household.activities]
        return [sum(sizes[:i]) for i in range(len(sizes))]

    def _vector(self, text: str) -> NDArray[np.float32]:
        """Return a text's unit vector, encoding it when it is first needed."""
        vector = self._vectors.get(text)
        if vector is None:
            vector = np.asarray(self._embeddings.embed_query(text), dtype=np.float32)
            vector = vector / max(float(np.linalg.norm(vector)), 1e-9)
            if len(self._vectors) >= VECTORS:
                self._vectors.pop(next(iter(self._vectors)), None)
            self._vectors[text] = vector
        return vector


@lru_cache(maxsize=REMEMBERED)
def _words(name: str) -> str:
    """Return a name or text as its words: "the Coffee_table_2" and "coffee table" are told apart by "the" only."""
    return key(plain(name))
