"""Rebuild a damaged store from its texts.

Vectors are in the index's files, texts in a SQLite database. The texts are read from the database directly, since
Chroma may refuse a damaged index or end the process. They are encoded again into a new store beside the damaged one,
and the two change places. The damaged store is kept. `repair` is for the user; `heal` mends the damage of a
crash by itself.
"""

from __future__ import annotations

import json
import logging
import math
import shutil
import sqlite3
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

from langchain_core.embeddings import Embeddings

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory.damage import damage
from coopera.memory.embeddings import as_array, by_identity, identity, unit
from coopera.memory.folder import CHROMA, DamagedMemoryError, begun, locked, repaired
from coopera.memory.log import Log
from coopera.memory.numbering import Numbering, position_of
from coopera.memory.rows import Record, restored
from coopera.memory.store import Store

_LOG = logging.getLogger(__name__)
_PAGE = 500


class Repaired(NamedTuple):
    """What became of one stream.

    Attributes:
        stream: Its name.
        records: How many records it has now.
        missing: Number of lost records: those without a text or an hour.
        altered: Number of changed records: those with a wrong check sum.
    """

    stream: str
    records: int
    missing: int
    altered: int


class _Salvage(NamedTuple):
    """What could be read of one stream: its records by position, and how many are lost or altered."""

    stream: str
    model: str
    records: list[Record]
    missing: int
    altered: int


def repair(folder: Path, embeddings: Embeddings | None = None) -> list[Repaired]:
    """Rebuild a store if anything is wrong with it; return what was done per stream, nothing if all was well.

    Args:
        folder: The store. The damaged one is kept beside it as "<folder>.damaged", "<folder>.damaged-2", ….
        embeddings: Those the streams were written with; None finds them by their name.

    Raises:
        ConfigError: If the folder is no store.
        MemoryStoreError: If it is in use, if the texts cannot be read either, or if the embeddings are others.
    """
    folder = Path(folder).resolve()
    with locked(folder):
        if damage(folder, everything=True) is None:
            return []
        salvages = _salvage(folder)
        models = {s.model: embeddings if embeddings is not None else by_identity(s.model) for s in salvages}
        for model, given in models.items():
            if identity(given) != model:
                raise MemoryStoreError(f"{folder}: was written with the embeddings {model!r}, not {identity(given)!r}")
        _exchange(folder, salvages, models)
    return [Repaired(one.stream, len(one.records), one.missing, one.altered) for one in salvages]


def heal(found: DamagedMemoryError, embeddings: Embeddings) -> None:
    """Rebuild a store after a killed writer, if no record is lost by it.

    Args:
        found: The damage; names the store.
        embeddings: Those of one of its streams; those of other streams are found by their name.

    Raises:
        DamagedMemoryError: The damage, if a record is missing or altered, or if a stream's embeddings are unknown.
        MemoryStoreError: If the store is in use, or the texts cannot be read.
    """
    folder = Path(found.where)
    with locked(folder):
        salvages = _salvage(folder)
        if any(salvage.missing or salvage.altered for salvage in salvages):
            raise found
        models = {identity(embeddings): embeddings}
        try:
            models |= {salvage.model: by_identity(salvage.model) for salvage in salvages if salvage.model not in models}
        except MemoryStoreError as err:
            raise found from err
        kept = _exchange(folder, salvages, models)
    _LOG.warning("%s: %s, after a crash; rebuilt from its texts without loss (kept: %s)", folder, found.what, kept)


def texts(folder: Path) -> dict[str, list[Record]]:
    """Read what a store remembers, by stream, without opening it: neither its vectors nor its index are looked at.

    Raises:
        MemoryStoreError: If a text is missing or altered, or nothing can be read.
    """
    salvages = _salvage(folder)
    for one in salvages:
        if one.missing or one.altered:
            raise MemoryStoreError(f"{folder}: {one.missing + one.altered} texts of {one.stream!r} are not as written")
    return {one.stream: one.records for one in salvages}


def rewrite(folder: Path, streams: Mapping[str, Sequence[Record]], embeddings: Embeddings) -> Path | None:
    """Put a store of these records in the place of whatever is there; return where that is kept, if anything was.

    The caller sees to it that nobody has the store open.
    """
    if not folder.exists():
        folder.mkdir(parents=True)
    found = begun(folder)
    salvages = [_Salvage(name, identity(embeddings), list(records), 0, 0) for name, records in streams.items()]
    kept = _exchange(folder, salvages, {identity(embeddings): embeddings})
    if not found:
        shutil.rmtree(kept)
    return kept if found else None


def _exchange(folder: Path, salvages: list[_Salvage], models: Mapping[str, Embeddings]) -> Path:
    """Put a new store of the salvaged records in the place of the damaged one; return where that now is."""
    fresh, kept = repaired(folder), _unused(folder.with_name(f"{folder.name}.damaged"))
    shutil.rmtree(fresh, ignore_errors=True)  # of a repair that was interrupted
    for salvage in salvages:
        _rebuild(fresh, salvage, models[salvage.model])
    fresh.mkdir(exist_ok=True)  # where there was no stream at all
    folder.rename(kept)
    fresh.rename(folder)  # if this is not reached, the next opening does it
    return kept


def _rebuild(folder: Path, salvage: _Salvage, embeddings: Embeddings) -> None:
    """Write one stream into a new store."""
    store = Store.open(folder)
    try:
        store.collection(salvage.stream, salvage.model)
        where, vectors_of = f"{folder}: {salvage.stream!r}", store.vectors(salvage.stream)
        log = Log(lambda: store.raw(salvage.stream), where, vectors_of, exclusive=True)
        for start in range(0, len(salvage.records), _PAGE):
            page = salvage.records[start : start + _PAGE]
            texts = [record.text for record in page]
            vectors = unit(as_array(embeddings, texts), texts)
            log.append(texts, vectors, [record.hour for record in page], [record.metadata for record in page])
    finally:
        store.close()


def _salvage(folder: Path) -> list[_Salvage]:
    """Read all that is left of the streams.

    Raises:
        MemoryStoreError: If the database cannot be read.
    """
    try:
        with closing(sqlite3.connect(f"file:{folder / CHROMA}?mode=rw", uri=True)) as database:
            about: dict[str, dict[str, Any]] = {}
            if not database.execute("SELECT 1 FROM sqlite_master WHERE name = 'collection_metadata'").fetchone():
                return []  # its process died before Chroma had made its tables
            rows = database.execute(
                "SELECT collection_id, key, coalesce(str_value, int_value) FROM collection_metadata"
            )
            for collection, key, value in rows:
                about.setdefault(collection, {})[key] = value
            named = sorted((entry["stream"], entry["model"], key) for key, entry in about.items() if "stream" in entry)
            return [
                _sorted_out(name, model, _stored(database, key, Numbering.of(about[key]))) for name, model, key in named
            ]
    except (sqlite3.Error, ValueError, KeyError, UnicodeDecodeError) as err:
        raise MemoryStoreError(
            f"{folder}: the texts of the memory cannot be read either ({err}); `coopera doctor --repair` rebuilds them "
            f"from the trace of their run"
        ) from err


def _stored(database: sqlite3.Connection, collection: str, numbering: Numbering) -> dict[int, dict[str, Any]]:
    """Return a stream's metadata by position, the text being under "chroma:document"."""
    found: dict[str, dict[str, Any]] = {}
    rows = database.execute(
        "SELECT e.embedding_id, m.key, m.string_value, m.int_value FROM embeddings e "
        "JOIN segments s ON s.id = e.segment_id LEFT JOIN embedding_metadata m ON m.id = e.id "
        "WHERE s.collection = ? AND s.scope = 'METADATA'",
        (collection,),
    )
    for key, field, text, number in rows:
        found.setdefault(key, {})[field] = text if text is not None else number
    waiting = database.execute(  # written, but perhaps not yet part of the tables above
        "SELECT id, metadata FROM embeddings_queue WHERE topic LIKE ? ORDER BY seq_id", (f"%/{collection}",)
    )
    for key, metadata in waiting:
        if metadata is not None:
            found.setdefault(key, json.loads(metadata))
    return {position_of(key): meta for key, meta in found.items() if key == numbering.id(position_of(key))}


def _sorted_out(name: str, model: str, stored: dict[int, dict[str, Any]]) -> _Salvage:
    """Tell whole records from altered and missing ones, and put altered hours between those around them."""
    found = [restored(stored[place].get("chroma:document"), stored[place]) for place in sorted(stored)]
    kept = [(record, whole) for record, whole in found if record is not None]
    ceilings: list[float] = []  # the hour of the next record that is whole
    ceiling = math.inf
    for record, whole in reversed(kept):
        ceilings.append(ceiling)
        ceiling = record.hour if whole else ceiling
    records: list[Record] = []
    for (record, whole), ceiling in zip(kept, reversed(ceilings), strict=True):
        hour = record.hour if whole else min(record.hour, ceiling)
        records.append(record._replace(hour=int(max(hour, records[-1].hour if records else hour))))
    missing = max(stored, default=-1) + 1 - len(records)
    return _Salvage(name, model, records, missing, sum(not whole for _, whole in kept))


def _unused(path: Path) -> Path:
    """Return the path, or with a number after it, so that nothing is there."""
    candidates: Iterable[Path] = (path.with_name(f"{path.name}-{number}") for number in range(2, 1000))
    for candidate in (path, *candidates):
        if not candidate.exists():
            return candidate
    raise ConfigError(f"{path}: there are too many damaged stores beside it")
