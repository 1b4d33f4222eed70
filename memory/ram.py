"""A stand-in for a Chroma client in RAM, for runs without resumption: a stopped one starts anew.

A durable write takes Chroma some ten milliseconds, longer than all the rest of a quick hour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from coopera.memory.minilm import Vector


@dataclass(slots=True)
class RamCollection:
    """Rows by id, in the order in which they were added."""

    name: str
    metadata: dict[str, Any]
    configuration_json: dict[str, Any]
    _rows: dict[str, tuple[Vector, str, dict[str, Any]]] = field(default_factory=dict)

    def add(
        self,
        *,
        ids: Sequence[str],
        embeddings: Vector,
        documents: Sequence[str] | None = None,
        metadatas: Sequence[dict[str, Any]] | None = None,
    ) -> None:
        """Add rows; one whose id is there stays as it is, as in Chroma."""
        texts, about = documents or [""] * len(ids), metadatas or [{}] * len(ids)
        for key, *row in zip(ids, embeddings, texts, about, strict=True):
            self._rows.setdefault(key, (np.array(row[0], np.float32), row[1], dict(row[2])))

    def get(self, *, ids: Sequence[str], include: Sequence[str]) -> dict[str, Any]:
        """Return the rows that are there, with the columns asked for."""
        there = [key for key in dict.fromkeys(ids) if key in self._rows]
        columns = {name: [self._rows[key][place] for key in there] for place, name in enumerate(_COLUMNS)}
        return {"ids": there, **{name: column if name in include else None for name, column in columns.items()}}

    def count(self) -> int:
        """Return the number of rows."""
        return len(self._rows)

    def modify(self, *, metadata: dict[str, Any]) -> None:
        """Replace the collection's metadata."""
        self.metadata = dict(metadata)


_COLUMNS = ("embeddings", "documents", "metadatas")


class RamClient:
    """Collections by name; `MemoryStream.open` takes it for a Chroma client."""

    def __init__(self) -> None:
        """Start empty."""
        self._collections: dict[str, RamCollection] = {}

    def get_or_create_collection(
        self, name: str, *, configuration: dict[str, Any], metadata: dict[str, Any], embedding_function: None
    ) -> RamCollection:
        """Return a collection, making it if need be."""
        return self._collections.setdefault(name, RamCollection(name, dict(metadata), configuration))

    def get_collection(self, name: str, *, embedding_function: None) -> RamCollection:
        """Return a collection that is there."""
        return self._collections[name]

    def list_collections(self) -> list[RamCollection]:
        """Return all collections."""
        return list(self._collections.values())
