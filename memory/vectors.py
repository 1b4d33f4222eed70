"""The vectors of a store, each text's once.

A person's days say the same things again and again: of 6,700 records of two months of the offline model, 800 texts are
different. Chroma keeps an index of all vectors of a collection in memory, so those of records would grow for ever.
"""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from coopera.core.errors import MemoryStoreError
from coopera.memory.client import translated
from coopera.memory.folder import DamagedMemoryError
from coopera.memory.minilm import Vector

if TYPE_CHECKING:
    from chromadb.api.models.Collection import Collection

_PER_CALL = 1000
_KNOWN = 4096  # texts of which it is remembered that their vectors are there


class Vectors:
    """The vectors of one model in one store, by text, in a Chroma collection; streams share them."""

    def __init__(self, collection: Collection, where: str) -> None:
        """Take the collection; `where` names the store in messages."""
        self._collection = collection
        self._where = where
        self._known: dict[str, None] = {}
        self._waiting: dict[str, Vector] = {}
        self._lock = threading.Lock()

    def add(self, texts: Sequence[str], vectors: Vector) -> None:
        """Have the next `flush` keep vectors of n texts, shape (n, d); those that are there stay as they are."""
        with self._lock:
            for key, vector in zip(map(_key, texts), vectors, strict=True):
                if key not in self._known:
                    self._waiting.setdefault(key, vector)

    def flush(self) -> None:
        """Have all vectors in the store.

        Raises:
            MemoryStoreError: If it fails; those that are not there wait for the next call.
        """
        with self._lock:
            while some := dict(islice(self._waiting.items(), _PER_CALL)):
                with translated(self._where):
                    self._collection.add(ids=list(some), embeddings=np.stack(list(some.values())))
                self._remember(some)
                for key in some:
                    del self._waiting[key]

    def of(self, texts: Sequence[str]) -> Vector:
        """Return the vectors of n texts, shape (n, d).

        Raises:
            MemoryStoreError: If the store fails, or one is missing.
        """
        keys = list(map(_key, texts))
        found: dict[str, Vector] = {}
        for start in range(0, len(wanted := list(dict.fromkeys(keys))), _PER_CALL):
            found |= self._read(wanted[start : start + _PER_CALL])
        if missing := [text for text, key in zip(texts, keys, strict=True) if key not in found]:
            raise DamagedMemoryError(self._where, f"the vector of {missing[0][:60]!r} is missing")
        with self._lock:
            self._remember(found)
        return np.ascontiguousarray(np.stack([found[key] for key in keys]))

    def _read(self, keys: list[str]) -> dict[str, Vector]:
        from chromadb.errors import InternalError  # noqa: PLC0415 - heavy

        try:
            with translated(self._where):
                rows = self._collection.get(ids=keys, include=["embeddings"])
        except MemoryStoreError as err:
            if isinstance(err.__cause__, InternalError):
                raise DamagedMemoryError(self._where, f"vectors cannot be read: {err}") from err
            raise
        return dict(zip(rows["ids"], np.asarray(rows["embeddings"], np.float32), strict=True))

    def _remember(self, keys: dict[str, Vector]) -> None:
        self._known |= dict.fromkeys(keys)
        for key in list(islice(self._known, max(0, len(self._known) - _KNOWN))):
            del self._known[key]


def _key(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:40]


@dataclass(frozen=True, slots=True)
class Repeated:
    """Vectors among which some are the same, each of them held once: `rows[of]` has shape (n, d)."""

    rows: Vector
    of: npt.NDArray[np.int64]

    def __getitem__(self, part: slice) -> Vector:
        """Return some of the n vectors."""
        some: Vector = self.rows[self.of[part]]
        return some


def repeated(vectors: Vector) -> Repeated:
    """Hold each different vector of n, shape (n, d), once; bit for bit."""
    first: dict[bytes, int] = {}
    of = np.array([first.setdefault(row.tobytes(), len(first)) for row in vectors], np.int64)
    return Repeated(np.frombuffer(b"".join(first), np.float32).reshape(len(first), -1), of)
