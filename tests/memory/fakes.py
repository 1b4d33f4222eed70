"""A model whose vectors can be told by looking at a text."""

from __future__ import annotations

from langchain_core.embeddings import Embeddings
from typing_extensions import override


class Letters(Embeddings):
    """A fake model: counts of some letters. Its name and the letters can be another one's."""

    def __init__(self, model_id: str = "letters", letters: str = "abcd") -> None:
        self.model_id = model_id
        self.dimension = len(letters)
        self.letters = letters

    @override
    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [[float(text.count(letter)) for letter in self.letters] for text in texts]

    @override
    def embed_query(self, text: str) -> list[float]:
        return self.embed_documents([text])[0]
