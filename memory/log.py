"""The durable log of one stream: records numbered 0, 1, 2, … in order of time, addressed by those numbers only."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from coopera.core.errors import MemoryStoreError
from coopera.memory.client import translated
from coopera.memory.folder import DamagedMemoryError
from coopera.memory.lately import Lately
from coopera.memory.minilm import Vector
from coopera.memory.numbering import Numbering, position_of
from coopera.memory.questions import Texts
from coopera.memory.rows import AS_DOCUMENTS, FORMAT, Record, Row, hour_of, restored, row
from coopera.memory.scan import AT_ONCE, BLOCK, Block, Tail
from coopera.memory.vectors import Held, Places, Table, Vectors

if TYPE_CHECKING:
    from chromadb.api.models.Collection import Collection

_PER_CALL = 1000  # ids per request; SQLite's limit on variables lies above 3000
_TEXTS_IN_RAM = AT_ONCE * BLOCK  # what a robot reads every hour: five tasks of each of sixty days' hours
_FAN = 32  # positions looked at together when searching by hour


class Log:
    """A stream's records in Chroma, with the newest block and the recently read ones in RAM.

    Implements `scan.Rows`. Calls come under `lock`.
    """

    def __init__(
        self, reach: Callable[[], Collection], where: str, vectors: Vectors | None, *, exclusive: bool
    ) -> None:
        """Find the end of the log.

        Args:
            reach: Gets the stream's collection as it now is.
            where: Store and stream, for messages.
            vectors: Where the texts' vectors are; None where the collection itself has them.
            exclusive: Whether no one else can write; if not, each write is read back.

        Raises:
            MemoryStoreError: If records are missing or damaged.
        """
        self.lock = threading.RLock()
        self.where = where
        self._reach = reach
        self._vectors = vectors
        self._exclusive = exclusive
        self._collection = reach()
        self._numbering = Numbering()
        self._length = 0
        self._table = vectors.table if vectors is not None else Table()
        self._tail = Tail.empty(0)
        self._blocks: OrderedDict[int, Block] = OrderedDict()
        self._starts: dict[int, int] = {}
        self._lately = Lately(_TEXTS_IN_RAM)
        self._waiting: list[Row] = []
        self._format = FORMAT
        self._known = False
        self.know()

    def know(self) -> None:
        """Read the log's end from the store, unless it is known: it is not after a store that failed failed again.

        Raises:
            MemoryStoreError: If the store fails, or if records are missing or damaged.
        """
        if not self._known:
            with self.lock:
                self._reload()

    def __len__(self) -> int:
        """Return the number of records."""
        return self._length

    @property
    def dimension(self) -> int | None:
        """Numbers per vector; None while there is no record."""
        return int(self._table.rows.shape[1]) if self._length else None

    @property
    def last_hour(self) -> int | None:
        """Hour of the newest record; None while there is no record."""
        return int(self._hours_of_tail()[-1]) if self._length else None

    def block(self, number: int) -> Block:
        """Return one block of 512 records, from RAM if it is there."""
        if number * BLOCK == self._tail.start:
            filled = self._length - self._tail.start
            return self._block(self._tail, filled)
        block = self._blocks.pop(number, None)
        if block is None:
            vectors, hours = self._read(number * BLOCK, min((number + 1) * BLOCK, self._length))
            block = Block(number * BLOCK, Held(self._table, self._table.hold(vectors)), hours)
        self._keep_block(number, block)
        return block

    def first_at(self, hour: int) -> int:
        """Return the position of the first record at this hour or later; the length if there is none."""
        hours = self._hours_of_tail()
        if self._length == 0 or hours[0] < hour:
            return self._tail.start + int(np.searchsorted(hours, hour))
        before, after = -1, self._tail.start // BLOCK  # numbers of blocks that begin before the hour, and not before
        while after - before > 1:
            step = max(1, (after - before) // _FAN)
            numbers = list(range(before + step, after, step))
            starts = self._start_hours(numbers)
            earlier = [number for number in numbers if starts[number] < hour]
            before = max(earlier, default=before)
            after = min((number for number in numbers if starts[number] >= hour), default=after)
        if before < 0:
            return 0
        return before * BLOCK + int(np.searchsorted(self.block(before).hours, hour))

    def append(
        self,
        texts: Sequence[str],
        vectors: Vector,
        hours: Sequence[int],
        metadata: Sequence[Mapping[str, Any]],
        *,
        at_once: bool = True,
    ) -> None:
        """Add records at the end, up to 1000 of them at once or not at all.

        Args:
            texts: n texts.
            vectors: Unit vectors, shape (n, d).
            hours: n hours, none before `last_hour`, non-decreasing.
            metadata: n mappings of JSON data.
            at_once: Whether they are in the store when this returns; if not, those of a full block are.

        Raises:
            MemoryStoreError: If the store fails; what is in it then is what this log has.
        """
        for start in range(0, len(texts), _PER_CALL):
            part = slice(start, start + _PER_CALL)
            self._append(texts[part], vectors[part], hours[part], metadata[part])
            if at_once or len(self._waiting) >= BLOCK:
                self.flush()

    def keep(self, texts: Sequence[str], vectors: Vector) -> None:
        """Keep vectors, shape (n, d), of texts that will be added to streams of this store and model."""
        if self._vectors is not None:
            self._vectors.add(texts, vectors)

    def flush(self) -> None:
        """Have all records in the store.

        Raises:
            MemoryStoreError: If it fails; what is in it then is what this log has.
        """
        with self.lock:
            try:
                while some := self._waiting[:_PER_CALL]:
                    self._write(some)
                    del self._waiting[: len(some)]
            except MemoryStoreError:
                self._known = False
                with suppress(MemoryStoreError):  # what is in it is found out once it answers
                    self.know()
                raise

    def cut(self, length: int) -> None:
        """Drop all records from this position on, at once or not at all."""
        if length >= self._length:
            return
        self.flush()
        numbering = self._numbering.cut(length, self._length)
        try:
            with translated(self.where):
                self._collection.modify(metadata={**self._collection.metadata, **numbering.metadata()})
        finally:
            self._reload()

    def records(self, positions: Sequence[int]) -> list[Record]:
        """Return records by position, in the order asked for.

        Raises:
            MemoryStoreError: If one is missing or is not what was written.
        """
        found = self._lately.of(positions)
        missing = [position for position in positions if position not in found]
        for start in range(0, len(missing), _PER_CALL):
            read = self._read_records(missing[start : start + _PER_CALL])
            self._lately.keep(read.items())
            found |= read
        return [found[position] for position in positions]

    def texts(self, start: int, stop: int) -> Texts:
        """Return the texts and hours of the records from one position to before another.

        Raises:
            MemoryStoreError: If one is missing or is not what was written.
        """
        if (found := self._lately.texts(start, stop)) is not None:
            return found
        records = self.records(range(start, stop))
        return Texts([record.text for record in records], [record.hour for record in records])

    def _keep_block(self, number: int, block: Block) -> None:
        self._blocks[number] = block
        if len(self._blocks) > AT_ONCE:
            _, oldest = self._blocks.popitem(last=False)
            self._let_go_of(oldest)

    def _let_go_of(self, block: Block) -> None:
        if isinstance(block.vectors, Held):
            self._table.let_go(block.vectors.places)

    def _block(self, tail: Tail, filled: int) -> Block:
        return Block(tail.start, Held(self._table, tail.places[:filled]), tail.hours[:filled])

    def _read_records(self, positions: Sequence[int]) -> dict[int, Record]:
        """Return records by position from the store, up to `_PER_CALL` of them."""
        self._put(max(positions) + 1)
        with translated(self.where):
            rows = self._collection.get(ids=self._ids(positions), include=["documents", "metadatas"])
        documents, metadatas = rows["documents"] or [], rows["metadatas"] or []
        told = zip(rows["ids"], documents, metadatas, strict=True)
        stored = {position_of(key): (document, meta or {}) for key, document, meta in told}
        found = {}
        for position in positions:
            if position not in stored:
                raise DamagedMemoryError(self.where, f"record {position} is missing")
            record, whole = restored(*stored[position])
            if record is None or not whole:
                raise DamagedMemoryError(self.where, f"the text of record {position} is not what was written")
            found[position] = record
        return found

    def _append(
        self, texts: Sequence[str], vectors: Vector, hours: Sequence[int], metadata: Sequence[Mapping[str, Any]]
    ) -> None:
        places = self._table.hold(vectors)
        ids = self._ids(range(self._length, self._length + len(texts)))
        records = [Record(*one) for one in zip(texts, hours, metadata, strict=True)]
        rows = [row(*one, self._format) for one in zip(ids, records, vectors, strict=True)]
        self.keep(texts, vectors)
        self._waiting += rows
        added = enumerate(rows, self._length)
        self._lately.keep((at, record) for at, one in added if (record := restored(one.document, one.entry)[0]))
        self._extend(places, np.asarray(hours, np.int64))

    def _write(self, rows: Sequence[Row]) -> None:
        """Put rows into the store, up to `_PER_CALL` of them, once all vectors are there."""
        if self._vectors is not None:
            self._vectors.flush()
        ids, documents, vectors, entries = map(list, zip(*rows, strict=True))
        with translated(self.where):
            self._collection.add(
                ids=ids,
                embeddings=np.stack(vectors) if self._vectors is None else np.ones((len(rows), 1), np.float32),
                documents=documents if self._format in AS_DOCUMENTS else None,
                metadatas=entries,
            )
        if not self._exclusive:
            self._check_written(ids, entries)

    def _put(self, stop: int) -> None:
        """Have the records before this position in the store."""
        if self._length - len(self._waiting) < stop:
            self.flush()

    def _check_written(self, ids: list[str], entries: list[dict[str, str | int]]) -> None:
        """Make sure that these records are ours: adding an id that is there is silently ignored by Chroma."""
        with translated(self.where):
            rows = self._collection.get(ids=ids, include=["metadatas"])
        there = dict(zip(rows["ids"], rows["metadatas"] or [], strict=True))
        if any(there.get(key) != entry for key, entry in zip(ids, entries, strict=True)):
            raise MemoryStoreError(f"{self.where}: another process writes to this stream; a stream has one writer")

    def _extend(self, places: Places, hours: npt.NDArray[np.int64]) -> None:
        """Take records that are in the store into the tail; where it is full, a new one begins.

        The tail is empty only while there is no record, so that the newest hour is always at hand.
        """
        for place, hour in zip(places, hours, strict=True):
            filled = self._length - self._tail.start
            if filled == BLOCK:
                self._keep_block(self._tail.start // BLOCK, self._block(self._tail, filled))
                self._tail = Tail.empty(self._length)
                filled = 0
            self._tail.places[filled] = place
            self._tail.hours[filled] = hour
            self._length += 1

    def let_go(self) -> None:
        """Hold no vectors in RAM any longer, once nobody recalls by this log."""
        for block in (*self._blocks.values(), self._block(self._tail, self._length - self._tail.start)):
            self._let_go_of(block)
        self._blocks.clear()
        self._tail = Tail.empty(self._length)

    def _reload(self) -> None:
        """Read the log's end from the store."""
        self._known = False
        self.let_go()
        self._starts.clear()
        self._lately.clear()
        self._waiting.clear()
        self._length = 0
        self._tail = Tail.empty(0)
        with translated(self.where):
            self._collection = self._reach()
            self._numbering = Numbering.of(self._collection.metadata)
            self._format = self._collection.metadata["format"]
        if length := self._find_length():
            start = (length - 1) // BLOCK * BLOCK
            vectors, hours = self._read(start, length)
            self._tail = Tail.empty(start)
            self._tail.places[: length - start] = self._table.hold(vectors)
            self._tail.hours[: length - start] = hours
            self._length = length
        self._known = True

    def _find_length(self) -> int:
        """Count the records, and make sure that they are numbered without a hole."""
        with translated(self.where):
            length = self._collection.count() - self._numbering.ghosts
            around = self._ids(range(max(0, length - 1), max(0, length) + 1))
            ends = self._collection.get(ids=around, include=[])["ids"]
        if length < 0 or ends != around[:-1]:
            raise DamagedMemoryError(self.where, f"its {length} records are not numbered 0 to {length - 1}")
        return length

    def _read(self, start: int, stop: int) -> tuple[Vector, npt.NDArray[np.int64]]:
        """Read the vectors and hours of some records, checking each against its check sum."""
        self._put(stop)
        ids = self._ids(range(start, stop))
        from chromadb.errors import InternalError  # noqa: PLC0415 - heavy

        what: Literal["embeddings", "documents"] = "embeddings" if self._vectors is None else "documents"
        try:
            with translated(self.where):
                rows = self._collection.get(ids=ids, include=[what, "metadatas"])
        except MemoryStoreError as err:
            if isinstance(err.__cause__, InternalError):
                raise DamagedMemoryError(
                    self.where, f"the vectors of records {start} to {stop - 1} cannot be read: {err}"
                ) from err
            raise
        if len(rows["ids"]) != len(ids):
            raise DamagedMemoryError(
                self.where, f"{len(ids) - len(rows['ids'])} of the records {start} to {stop - 1} are missing"
            )
        order = np.argsort(rows["ids"])
        metadatas: Any = rows["metadatas"]
        if self._vectors is None:
            vectors = np.ascontiguousarray(np.asarray(rows["embeddings"], np.float32)[order])
        else:
            documents: Any = rows["documents"]
            vectors = self._vectors_of([(documents[place], metadatas[place]) for place in order], start)
        hours = [hour_of(metadatas[place], vector) for place, vector in zip(order, vectors, strict=True)]
        if None in hours:
            raise DamagedMemoryError(
                self.where, f"the vector or hour of record {start + hours.index(None)} is not what was written"
            )
        known = np.array(hours, np.int64)
        if (np.diff(known) < 0).any():
            raise DamagedMemoryError(self.where, f"the hours of records {start} to {stop - 1} go backwards")
        return vectors, known

    def _vectors_of(self, stored: Sequence[tuple[str | None, Mapping[str, Any]]], start: int) -> Vector:
        """Return the vectors of stored texts, once each is known to be what was written."""
        assert self._vectors is not None
        texts = []
        for position, one in enumerate(stored, start):
            record, whole = restored(*one)
            if record is None or not whole:
                raise DamagedMemoryError(self.where, f"the text of record {position} is not what was written")
            texts.append(record.text)
        return self._vectors.of(texts)

    def _start_hours(self, numbers: Sequence[int]) -> dict[int, int]:
        """Return the first hour of some full blocks, by block number."""
        unknown = [number for number in numbers if number not in self._starts]
        for record, number in zip(self.records([n * BLOCK for n in unknown]), unknown, strict=True):
            self._starts[number] = record.hour
        return self._starts

    def _ids(self, positions: Sequence[int]) -> list[str]:
        return [self._numbering.id(position) for position in positions]

    def _hours_of_tail(self) -> npt.NDArray[np.int64]:
        return self._tail.hours[: self._length - self._tail.start]
