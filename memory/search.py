"""Search: the entries of a fixed list that are nearest in meaning to a query (objects, motions)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.errors import ConfigError
from coopera.memory.embeddings import as_array, unit


class Search:
    """Top-k by cosine over a list of texts, encoded once (PAPER App. A: searching objects and motions)."""

    def __init__(self, embeddings: Embeddings, texts: Sequence[str]) -> None:
        """Encode the list.

        Args:
            embeddings: What the vectors come from; with a cache, the list is encoded once ever.
            texts: The list; equal texts are separate entries.
        """
        self.texts = list(texts)
        self._embeddings = embeddings
        self._vectors = unit(as_array(embeddings, self.texts), self.texts).astype(np.float64)

    def __len__(self) -> int:
        """Return the number of entries."""
        return len(self.texts)

    def top(self, query: str, k: int) -> list[tuple[str, float]]:
        """Return the k nearest entries with their cosines, best first; equal ones in the order of the list.

        Raises:
            ConfigError: If k is below 1 or the query is empty.
        """
        if k < 1:
            raise ConfigError(f"k must be at least 1, not {k}")
        if not query.strip():
            raise ConfigError("a search needs a query that is not empty")
        if not self.texts:
            return []
        vector = unit(as_array(self._embeddings, [query]), [query])[0].astype(np.float64)
        scores = (self._vectors * vector).sum(1)  # row by row, so that equal vectors have equal scores
        order = np.argsort(-scores, kind="stable")[:k]
        return [(self.texts[place], float(scores[place])) for place in order]
