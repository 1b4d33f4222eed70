"""The memory stream: what a person did, recalled by recency x relevance.

PAPER §3.2 (Memory Retrieval): the score of a memory is its cosine with the query times decay^(hours ago). The result is
exactly the best k, and the time to find them does not grow with the number of records (see `coopera.memory.scan`).
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.core.notebook.cards import card, table
from coopera.memory.embeddings import as_array, identity, unit
from coopera.memory.folder import DamagedMemoryError
from coopera.memory.log import Log
from coopera.memory.minilm import Vector
from coopera.memory.questions import Recollection, Relevances, Texts, check_bounds, check_text, whole
from coopera.memory.rebuild import heal
from coopera.memory.rows import Record
from coopera.memory.scan import every, top
from coopera.memory.store import Store

if TYPE_CHECKING:
    from chromadb.api import ClientAPI

    from coopera.memory.ram import RamClient

DECAY = 0.95  # PAPER §3.2: per hour
_PAGE = 1000
_SHOWN = 10  # records on a card


class MemoryStream:
    """One stream of texts in time: append by the hour, recall by recency x relevance.

    Reading changes nothing, and time is what the caller says it is. What `add` has returned from is on disk and
    survives a crash, unless `open` was told otherwise. Several streams of one store, and several objects for one
    stream, may be open in one process.
    """

    def __init__(
        self, store: Store, name: str, log: Log, embeddings: Embeddings, decay: float, durable: bool = True
    ) -> None:
        """Use `MemoryStream.open`."""
        self.name = name
        self.decay = decay
        self.scanned = 0
        """How many records the last `recall` had to look at."""
        self._store = store
        self._log: Log | None = log
        self._embeddings = embeddings
        self._durable = durable

    @classmethod
    def open(
        cls,
        path_or_client: Path | str | ClientAPI | RamClient,
        name: str,
        embeddings: Embeddings,
        decay: float = DECAY,
        *,
        create: bool = True,
        durable: bool = True,
    ) -> Self:
        """Open a stream, or make it.

        A process killed while Chroma writes its index leaves a half-written index. The database holds the same records,
        so the store is first rebuilt from its texts if every text is whole. A warning says so, and the half-written
        store is kept. `coopera.memory.repair` is for all other damage.

        Args:
            path_or_client: Folder of the store; or URL of a Chroma server, such as "http://localhost:8000"; or a
                Chroma client, or a `coopera.memory.ram.RamClient`.
            name: The stream's name, free text of up to 200 characters, such as "human/mara/intentions".
            embeddings: What the records' and queries' vectors come from; always the same for one stream.
            decay: Factor per hour, in (0, 1]. It is not stored: a stream can be read with any.
            create: Whether an unknown stream, or a missing folder, is made.
            durable: Whether what `add` has returned from is on disk. If not, `flush` and `close` put it there, and so
                does each five hundredth record. A crash, or an error that leaves the `with`, then loses the newest,
                and never one before another.

        Raises:
            ConfigError: If the folder is no store, or the name, the decay or (without `create`) the stream is unknown.
            MemoryStoreError: If the store is locked, damaged, or does not answer; or if the stream was written with
                other embeddings, another dimension or another space.
        """
        if not 0 < decay <= 1:
            raise ConfigError(f"the decay of a memory stream must be above 0 and at most 1, not {decay}")
        try:
            store = Store.open(path_or_client, create=create)
        except DamagedMemoryError as damage:
            if not damage.interrupted:
                raise
            heal(damage, embeddings)
            store = Store.open(path_or_client, create=create)
        try:
            store.collection(name, identity(embeddings), create=create)
            where = f"{store.where}: the memory stream {name!r}"
            log = store.share(
                name, lambda: Log(lambda: store.raw(name), where, store.vectors(name), exclusive=store.exclusive)
            )
        except (ConfigError, MemoryStoreError):
            store.close()
            raise
        stream = cls(store, name, log, embeddings, decay, durable)
        try:
            stream._check_dimension()
        except MemoryStoreError:
            stream.close()
            raise
        return stream

    def __len__(self) -> int:
        """Return the number of records."""
        return len(self._open_log)

    def add(self, texts: Sequence[str], hour: int, metadata: Sequence[Mapping[str, Any]] | None = None) -> None:
        """Add an hour's records, in order; up to 1000 of them are written at once or not at all.

        Args:
            texts: Texts of 1 to 100,000 characters.
            hour: Global hour index (day x 24 + hour of day), not before that of any record.
            metadata: JSON data per text, given back with it.

        Raises:
            ConfigError: If a text, the hour or the metadata cannot be taken; nothing is then added.
            MemoryStoreError: If the store fails.
        """
        if isinstance(texts, str):
            raise ConfigError(f"{self._where}: expected a list of texts, not one text")
        if metadata is not None and len(metadata) != len(texts):
            raise ConfigError(f"{self._where}: {len(texts)} texts came with {len(metadata)} entries of metadata")
        own = metadata if metadata is not None else [{}] * len(texts)
        self.extend([Record(text, hour, entry) for text, entry in zip(texts, own, strict=True)])

    def extend(self, records: Sequence[Record]) -> None:
        """Add records of several hours, oldest first, such as those of another stream.

        Raises:
            ConfigError: If a record cannot be taken; nothing is then added.
            MemoryStoreError: If the store fails; whole pages of 1000 may then have been added.
        """
        extend_together([(self, records)])

    def _append(self, records: Sequence[Record], vectors: Vector) -> None:
        """Add checked records, oldest first, with their vectors, shape (n, d)."""
        log = self._open_log
        with log.lock:
            newest = log.last_hour
            for record in records:
                if newest is not None and record.hour < newest:
                    raise ConfigError(f"{self._where}: hour {record.hour} is before hour {newest}, and it comes later")
                newest = record.hour
            texts, hours, own = zip(*records, strict=True)
            log.append(texts, vectors, hours, own, at_once=self._durable)

    def flush(self) -> None:
        """Have all that was added to the streams of this store on disk: one write for each, and one for all vectors.

        Raises:
            MemoryStoreError: If the store fails; what it has then is what its streams have.
        """
        if self._open_log:
            self._store.flush()

    def recall(self, query: str, now: int, k: int, since: int | None = None) -> list[Recollection]:
        """Return the k records with the highest score, best first; newer first where scores are equal.

        Args:
            query: Text of 1 to 100,000 characters.
            now: Hour of the recall; what was added for a later hour is not recalled.
            k: How many, at least 1.
            since: First hour in question, such as the day's first for a memory that starts anew each day.

        Raises:
            ConfigError: If an argument is out of range.
            MemoryStoreError: If the store fails or is damaged.
        """
        check_text(query, "a query")
        now, k = whole(now, "the hour of a recall"), whole(k, "k")
        since = since if since is None else whole(since, "the first hour of a recall")
        if k < 1:
            raise ConfigError(f"k must be at least 1, not {k}")
        log = self._open_log
        if not len(log):
            return []
        [vector] = self._vectors([query])
        with log.lock:
            found = top(log, vector, k, now=now, decay=self.decay, since=since)
            self.scanned = found.scanned
            records = log.records([hit.position for hit in found.hits])
        fades = {hour: float(self.decay ** (now - hour)) for hour in {hit.hour for hit in found.hits}}
        recalled = []
        for hit, record in zip(found.hits, records, strict=True):
            recency = fades[hit.hour]
            score = hit.relevance * recency
            recalled.append(Recollection(record.text, hit.hour, hit.relevance, recency, score, record.metadata))
        return recalled

    def relevances(
        self,
        queries: Sequence[str],
        now: int,
        since: int | None = None,
        within: tuple[float, float] | None = None,
    ) -> Relevances:
        """Return how relevant each record is, whatever its recency: what `recall` says of it, in a fifth of the time.

        Args:
            queries: Texts of 1 to 100,000 characters; several together take less than one after the other.
            now: Last hour in question.
            since: First hour in question; None for no limit.
            within: For whom all below one number are alike, and all above another: such a relevance is given as the
                nearest of the two, which takes less.

        Raises:
            ConfigError: If an argument is out of range.
            MemoryStoreError: If the store fails or is damaged.
        """
        if isinstance(queries, str):
            raise ConfigError(f"queries must be a list of texts, not the text {queries!r:.80}")
        for query in queries:
            check_text(query, "a query")
        check_bounds(within)
        now = whole(now, "the last hour of a comparison")
        since = since if since is None else whole(since, "the first hour of a comparison")
        log = self._open_log
        if not len(log):
            return Relevances([], [], np.empty((len(queries), 0)))
        vectors = self._vectors(queries) if queries else np.empty((0, log.dimension or 0), np.float32)
        with log.lock:
            start, cosines = every(log, vectors, now=now, since=since, within=within)
            texts, hours = log.texts(start, start + cosines.shape[1])
        return Relevances(texts, hours, cosines)

    def texts(self, since: int | None = None) -> Texts:
        """Return what `records` yields, without its metadata, in a tenth of the time.

        Raises:
            MemoryStoreError: If the store fails or is damaged.
        """
        log = self._open_log
        with log.lock:
            return log.texts(0 if since is None else log.first_at(since), len(log))

    def latest(self, n: int) -> list[Record]:
        """Return the n newest records, newest first."""
        n = whole(n, "the number of latest memories")
        if n < 0:
            raise ConfigError(f"the number of latest memories must not be negative, not {n}")
        log = self._open_log
        with log.lock:
            return log.records(range(len(log) - 1, max(-1, len(log) - 1 - n), -1))

    def records(self, since: int | None = None) -> Iterator[Record]:
        """Yield all records, oldest first, from hour `since` on."""
        log = self._open_log
        with log.lock:
            start = 0 if since is None else log.first_at(since)
        while True:
            with log.lock:
                page = log.records(range(start, min(start + _PAGE, len(log))))
            if not page:
                return
            yield from page
            start += len(page)

    def forget_from(self, hour: int) -> int:
        """Drop all records of this hour and later, for an hour that is done again; return how many went.

        Raises:
            MemoryStoreError: If the store fails; then all are there or none.
        """
        log = self._open_log
        with log.lock:
            before = len(log)
            keep = log.first_at(whole(hour, "the hour to forget from"))
            if keep < before:
                log.cut(keep)
            return before - keep

    def _repr_html_(self) -> str:
        """The stream on a card in a notebook: how much it holds, and the newest of it."""
        if self._log is None:
            return card(self.name, "This memory stream is closed.")
        newest = [[f"day {record.hour // 24}, {record.hour % 24}:00", record.text] for record in self.latest(_SHOWN)]
        return card(self.name, f"A memory stream of {len(self)} records; the newest:", table(["when", "what"], newest))

    def close(self) -> None:
        """Let go of the store, with all on disk; closing twice does no harm.

        Raises:
            MemoryStoreError: If the store fails; it is closed all the same.
        """
        self._let_go(flushed=True)

    def _let_go(self, *, flushed: bool) -> None:
        log, self._log = self._log, None
        if log is None:
            return
        try:
            if flushed and self._store.pid == os.getpid():
                log.flush()
        finally:
            self._store.unshare(self.name)
            self._store.close()

    def __enter__(self) -> Self:
        """Return the stream itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the stream; after an error as a crash would, without a `flush`.

        A disk may be full by then, and Chroma, once refused a write, may wait for ever for the next.
        """
        self._let_go(flushed=error is None)

    @property
    def model(self) -> str:
        """Identity of the embeddings."""
        return identity(self._embeddings)

    @property
    def _open_log(self) -> Log:
        if self._log is None:
            raise MemoryStoreError(f"{self._where} is closed")
        if self._store.pid != os.getpid():
            raise MemoryStoreError(
                f"{self._where} was opened by process {self._store.pid}, before a fork; open it anew"
            )
        self._log.know()
        return self._log

    @property
    def _where(self) -> str:
        return f"{self._store.where}: the memory stream {self.name!r}"

    def _vectors(self, texts: Sequence[str]) -> Vector:
        """Return the texts' unit vectors, shape (n, d)."""
        vectors = unit(as_array(self._embeddings, texts), texts)
        dimension = self._open_log.dimension
        if dimension not in (None, vectors.shape[1]):
            raise MemoryStoreError(f"{self._where} has vectors of {dimension} numbers, not {vectors.shape[1]}")
        return vectors

    def _check_dimension(self) -> None:
        """Refuse embeddings of another dimension; those that do not say theirs are tried."""
        if self._open_log.dimension is None or self._open_log.dimension == getattr(self._embeddings, "dimension", None):
            return
        self._vectors(["dimension"])

    def _checked(self, record: Record) -> Record:
        """Refuse a record that could not be given back as it was."""
        check_text(record.text, "a text to remember")
        if not isinstance(record.metadata, Mapping):
            raise ConfigError(f"{self._where}: metadata must be a mapping, not {record.metadata!r:.80}")
        try:
            json.dumps(dict(record.metadata), allow_nan=False, ensure_ascii=False).encode()
        except (TypeError, ValueError) as err:
            raise ConfigError(f"{self._where}: metadata must be JSON data: {err}") from err
        return Record(record.text, whole(record.hour, "the hour of a memory"), dict(record.metadata))


def extend_together(parts: Sequence[tuple[MemoryStream, Sequence[Record]]]) -> None:
    """Add records to streams of one store and model, as `MemoryStream.extend` does; all new vectors are one write.

    A write takes the store some milliseconds, whatever it is of.

    Raises:
        ConfigError: If a record cannot be taken; nothing is then added to its stream or those after it.
        MemoryStoreError: If the store fails; whole pages of 1000 may then have been added.
    """
    checked = [(stream, [stream._checked(record) for record in records]) for stream, records in parts]
    ready = [(stream, some, stream._vectors([one.text for one in some])) for stream, some in checked if some]
    if len(ready) > 1:
        ready[0][0]._open_log.keep(
            [record.text for _, some, _ in ready for record in some], np.concatenate([vectors for *_, vectors in ready])
        )
    for stream, some, vectors in ready:
        stream._append(some, vectors)
