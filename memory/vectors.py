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
from typing import TYPE_CHECKING, TypeAlias

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
_ROOM = 256  # vectors by which a table grows
_FEW = 4  # few are those of which there are so many times fewer than of all in their table

Places: TypeAlias = npt.NDArray[np.int32]
"""Where vectors are in a table, shape (n,)."""


class Vectors:
    """The vectors of one model in one store, by text, in a Chroma collection; streams share them."""

    def __init__(self, collection: Collection, where: str) -> None:
        """Take the collection; `where` names the store in messages."""
        self._collection = collection
        self._where = where
        self._known: dict[str, None] = {}
        self._waiting: dict[str, Vector] = {}
        self.table = Table()
        """Those that the streams have in RAM."""
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


class Table:
    """Vectors that blocks in RAM consist of, each different one held once, for as long as a block holds it.

    What the streams of a store have in RAM says the same again and again; a block of it is then a row of numbers.
    """

    def __init__(self) -> None:
        """Start empty; the first vectors say how long all are."""
        self.rows: Vector = np.zeros((0, 0), np.float32)
        """Room for vectors, by place; those of places that nobody holds are of no meaning."""
        self._at: dict[bytes, int] = {}
        self._known: list[bytes] = []
        self._holders: list[int] = []
        self._free: list[int] = []
        self._lock = threading.Lock()

    def __len__(self) -> int:
        """How many different vectors are held."""
        return len(self._at)

    def hold(self, vectors: Vector) -> Places:
        """Hold n vectors, shape (n, d), until `let_go`; returns where they are, shape (n,).

        Raises:
            MemoryStoreError: If those that are held have another length.
        """
        with self._lock:
            if vectors.shape[1] != self.rows.shape[1]:
                if self._at:
                    raise MemoryStoreError(f"vectors have {self.rows.shape[1]} numbers here, not {vectors.shape[1]}")
                self.rows = np.zeros((0, vectors.shape[1]), np.float32)
                self._known, self._holders, self._free = [], [], []
            return np.array([self._hold(row) for row in np.ascontiguousarray(vectors, np.float32)], np.int32)

    def let_go(self, places: Places) -> None:
        """Hold these no longer; places that come several times were held as often."""
        with self._lock:
            for place in places.tolist():
                self._holders[place] -= 1
                if not self._holders[place]:
                    del self._at[self._known[place]]
                    self._free.append(place)

    def _hold(self, row: Vector) -> int:
        known = hashlib.blake2b(row.tobytes(), digest_size=16).digest()
        place = self._at.get(known)
        if place is None:
            place = self._at[known] = self._free.pop() if self._free else self._more()
            self._known[place] = known
            self.rows[place] = row
        self._holders[place] += 1
        return place

    def _more(self) -> int:
        """Make room for one more; readers go on with the array that they have."""
        place = len(self._known)
        if place == len(self.rows):
            room = np.zeros((place + _ROOM, self.rows.shape[1]), np.float32)
            room[:place] = self.rows
            self.rows = room
        self._known.append(b"")
        self._holders.append(0)
        return place


@dataclass(frozen=True, slots=True)
class Held:
    """n vectors in a table, shape (n, d): those at `places`."""

    table: Table
    places: Places

    def __len__(self) -> int:
        """Return n."""
        return len(self.places)

    def __getitem__(self, part: slice | npt.NDArray[np.int64]) -> Held:
        """Return some of them."""
        return Held(self.table, self.places[part])

    def array(self) -> Vector:
        """Return them as an array, bit for bit."""
        return self.table.rows[self.places]

    def different(self) -> tuple[Vector, npt.NDArray[np.int64]]:
        """Return each different one once, shape (m, d), and which of these each of the n is, shape (n,)."""
        rows = self.table.rows  # once, since others may make room meanwhile
        if _FEW * len(self.places) < len(rows):
            places, of = np.unique(self.places, return_inverse=True)
            return rows[places], of
        there = np.zeros(len(rows), np.bool_)  # many are found faster without being sorted
        there[self.places] = True
        return rows[there], (np.cumsum(there) - 1)[self.places]
