"""A record of a stream, and the row of the store that stands for it, with check sums that tell written from damaged."""

from __future__ import annotations

import json
import sys
import zlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from coopera.memory.minilm import Vector

AS_DOCUMENTS = (1, 2)
"""Formats of streams whose texts are documents of Chroma's."""


class Record(NamedTuple):
    """What was added: a text, the global hour index it belongs to, and the caller's own data."""

    text: str
    hour: int
    metadata: Mapping[str, Any]


class Row(NamedTuple):
    """A record as the store has it."""

    key: str
    document: str | None
    vector: Vector
    entry: dict[str, str | int]


def row(key: str, record: Record, vector: Vector, *, as_document: bool) -> Row:
    """Return the row that stands for a record, under this id.

    `as_document`: whether the text is a document of Chroma's, as in older streams, and each check sum an entry. Chroma
    keeps an index of all pieces of documents, and of each entry, which nobody asks: a third of the time of a write, and
    two fifths of its space.
    """
    own_json = json.dumps(record.metadata, ensure_ascii=False, allow_nan=False) if record.metadata else ""
    of_text, of_vector = _text_sum(record.text, record.hour, own_json), _vector_sum(vector, record.hour)
    entry: dict[str, str | int] = {"hour": record.hour}
    if as_document:
        entry |= {"text_sum": of_text, "vector_sum": of_vector}
    else:
        entry |= {"text": record.text, "sums": f"{of_text:x} {of_vector:x}"}
    if record.metadata:
        entry["metadata"] = own_json
    return Row(key, record.text if as_document else None, vector, entry)


def restored(document: str | None, meta: Mapping[str, Any]) -> tuple[Record | None, bool]:
    """Return the record that a stored document and its metadata stand for, and whether it is what was written.

    The record is None where there is none to be made out.
    """
    text, hour, own_json = meta.get("text", document), meta.get("hour"), meta.get("metadata", "")
    if not isinstance(text, str) or not text or not isinstance(hour, int) or not isinstance(own_json, str):
        return None, False
    try:
        own = json.loads(own_json or "{}")
    except ValueError:
        own = {}
    whole = _sums(meta)[0] == _text_sum(text, hour, own_json)
    return Record(sys.intern(text), hour, own if isinstance(own, dict) else {}), whole  # said again, held once


def has_vector(meta: Mapping[str, Any], vector: Vector, hour: int) -> bool:
    """Whether this is the vector, and the hour, of the record whose metadata these are."""
    return _sums(meta)[1] == _vector_sum(vector, hour)


def _sums(meta: Mapping[str, Any]) -> tuple[int | None, int | None]:
    """The check sums of a record: of all but the vector, and of vector and hour; None where there is none."""
    if "sums" not in meta:
        return meta.get("text_sum"), meta.get("vector_sum")
    try:
        text, vector = (int(part, 16) for part in str(meta["sums"]).split())
    except ValueError:
        return None, None
    return text, vector


def _text_sum(text: str, hour: int, own_json: str) -> int:
    """Return a check sum of all but the vector, which tells written from damaged."""
    return zlib.crc32(f"{hour} {len(text)} {text}{own_json}".encode())


def _vector_sum(vector: Vector, hour: int) -> int:
    """Return a check sum of a record's vector and hour."""
    return zlib.crc32(f"{hour} ".encode() + np.ascontiguousarray(vector, "<f4").tobytes())
