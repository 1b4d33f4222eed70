"""A record of a stream, and the row of the store that stands for it, with check sums that tell written from damaged."""

from __future__ import annotations

import json
import sys
import zlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from coopera.memory.minilm import Vector


class Record(NamedTuple):
    """What was added: a text, the global hour index it belongs to, and the caller's own data."""

    text: str
    hour: int
    metadata: Mapping[str, Any]


class Row(NamedTuple):
    """A record as the store has it."""

    key: str
    text: str
    vector: Vector
    entry: dict[str, str | int]


def row(key: str, record: Record, vector: Vector) -> Row:
    """Return the row that stands for a record, under this id."""
    own_json = json.dumps(record.metadata, ensure_ascii=False, allow_nan=False) if record.metadata else ""
    entry: dict[str, str | int] = {
        "hour": record.hour,
        "text_sum": _text_sum(record.text, record.hour, own_json),
        "vector_sum": vector_sum(vector, record.hour),
    }
    if record.metadata:
        entry["metadata"] = own_json
    return Row(key, record.text, vector, entry)


def restored(text: str | None, meta: Mapping[str, Any]) -> tuple[Record | None, bool]:
    """Return the record that a stored text and its metadata stand for, and whether it is what was written.

    The record is None where there is none to be made out.
    """
    hour, own_json = meta.get("hour"), meta.get("metadata", "")
    if not text or not isinstance(hour, int) or not isinstance(own_json, str):
        return None, False
    try:
        own = json.loads(own_json or "{}")
    except ValueError:
        own = {}
    whole = meta.get("text_sum") == _text_sum(text, hour, own_json)
    return Record(sys.intern(text), hour, own if isinstance(own, dict) else {}), whole  # said again, held once


def _text_sum(text: str, hour: int, own_json: str) -> int:
    """Return a check sum of all but the vector, which tells written from damaged."""
    return zlib.crc32(f"{hour} {len(text)} {text}{own_json}".encode())


def vector_sum(vector: Vector, hour: int) -> int:
    """Return a check sum of a record's vector and hour."""
    return zlib.crc32(f"{hour} ".encode() + np.ascontiguousarray(vector, "<f4").tobytes())
