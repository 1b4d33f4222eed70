"""Sentence vectors without a trained encoder: another, weaker backbone for the offline model."""

from __future__ import annotations

from langchain_core.embeddings import Embeddings
from sklearn.feature_extraction.text import HashingVectorizer
from typing_extensions import override


class WordEmbeddings(Embeddings):
    """Unit vectors of hashed letter groups: texts that share (parts of) words are near each other, synonyms are not."""

    model_id = "hashed-letters-1"

    def __init__(self) -> None:
        """Nothing is learned or loaded."""
        self._hash = HashingVectorizer(analyzer="char_wb", ngram_range=(3, 5), n_features=1024, alternate_sign=False)

    @override
    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        vectors: list[list[float]] = self._hash.transform(texts).toarray().tolist()
        return vectors

    @override
    def embed_query(self, text: str) -> list[float]:
        return self.embed_documents([text])[0]
