"""Feedback of made-up people, for the tests of classifiers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.hour import Example
from coopera.core.people import PersonId
from coopera.core.protocols import Classifier
from coopera.core.randomness import rng_at
from coopera.models.classifiers import make_classifier


class WordEmbeddings(Embeddings):
    """Unit vectors of the words of a text: texts that share words are near each other, others are not."""

    def __init__(self, language: str = "") -> None:
        self.language = language

    def embed_query(self, text: str) -> list[float]:
        words = text.lower().replace(".", "").split() or ["nothing"]
        total = np.sum([rng_at(0, self.language, word).normal(size=32) for word in words], axis=0)
        return [float(value) for value in (total / np.linalg.norm(total)).astype(np.float32)]

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [self.embed_query(text) for text in texts]


WORDS = WordEmbeddings()
THINGS = ("drink tea", "read books", "lift weights", "paint pictures", "wash clothes")


def kernel(**options: object) -> Classifier:
    return make_classifier("kernel", **{"kind": "intention", "embeddings": WORDS, **options})  # type: ignore[arg-type]


def ask(candidate: str, hour: int, person: str = "ann", **fields: object) -> Example:
    return Example(person=PersonId(person), day=9, hour=hour, candidate=candidate, **fields)  # type: ignore[arg-type]


def days(likes: Callable[[str, int], bool], *, person: str = "ann", n: int = 3, **fields: object) -> list[Example]:
    """Feedback of n days on all five things at every hour."""
    return [
        Example(
            person=PersonId(person),
            day=day,
            hour=hour,
            candidate=thing,
            label=likes(thing, hour),
            **fields,  # type: ignore[arg-type]
        )
        for day in range(n)
        for hour in range(9, 22)
        for thing in THINGS
    ]


def tea_in_the_morning(thing: str, hour: int) -> bool:
    return (thing == "drink tea" and hour < 13) or (thing == "read books" and hour > 17)
