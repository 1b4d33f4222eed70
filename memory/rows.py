"""A record of a stream, and the row of the store that stands for it, with check sums that tell written from damaged."""

from __future__ import annotations

import json
import sys
import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from coopera.memory.minilm import Vector

FORMAT, FORMATS = 4, (1, 2, 3, 4)
"""How new streams are written, and all that can be read; a stream keeps the format in which it was begun.

A stream of format 1 has its vectors in its own collection, since then in that of all streams of its model.
"""
AS_DOCUMENTS = (1, 2)
"""Formats of streams whose texts are documents of Chroma's, and each check sum an entry.

Chroma keeps an index of all pieces of documents, which nobody asks: a third of the time of a write, and two fifths of
its space.
"""
_DIGITS = 9  # of an hour
_IN_ENTRIES = 3
"""The format of streams whose texts, hours and check sums are three entries.

Chroma keeps an index of entries, too. What is written in its order needs a few of its pages; texts and check sums came
anywhere in it, so that after a hundred days an evening's write took a quarter more of a processor.
"""


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


def row(key: str, record: Record, vector: Vector, format_: int = FORMAT) -> Row:
    """Return the row that stands for a record in a stream of this format, under this id.

    The one entry of a record without metadata begins with the hour, as does the index of such entries.
    """
    own_json = json.dumps(record.metadata, ensure_ascii=False, allow_nan=False) if record.metadata else ""
    text, hour = record.text, record.hour
    of_text, of_vector = _text_sum(text, hour, own_json), _vector_sum(vector, hour)
    entry: dict[str, str | int]
    if format_ in AS_DOCUMENTS:
        entry = {"hour": hour, "text_sum": of_text, "vector_sum": of_vector}
    elif format_ == _IN_ENTRIES:
        entry = {"hour": hour, "text": text, "sums": f"{of_text:x} {of_vector:x}"}
    else:
        entry = {"record": f"{hour:0{_DIGITS}d} {of_text:x} {of_vector:x} {text}"}
    if record.metadata:
        entry["metadata"] = own_json
    return Row(key, text if format_ in AS_DOCUMENTS else None, vector, entry)


def restored(document: str | None, meta: Mapping[str, Any]) -> tuple[Record | None, bool]:
    """Return the record that a stored document and its metadata stand for, and whether it is what was written.

    The record is None where there is none to be made out.
    """
    text, hour, of_text, _ = _parts(document, meta)
    own_json = meta.get("metadata", "")
    if not isinstance(text, str) or not text or not isinstance(hour, int) or not isinstance(own_json, str):
        return None, False
    try:
        own = json.loads(own_json or "{}")
    except ValueError:
        own = {}
    whole = of_text == _text_sum(text, hour, own_json)
    return Record(sys.intern(text), hour, own if isinstance(own, dict) else {}), whole  # said again, held once


def hour_of(meta: Mapping[str, Any], vector: Vector) -> int | None:
    """The hour of the record whose metadata these are, if this is its vector; None where either is not as written."""
    said = _parts(None, meta)
    return said.hour if isinstance(said.hour, int) and said.of_vector == _vector_sum(vector, said.hour) else None


class _Parts(NamedTuple):
    """What a stored record says, unchecked; None where it does not say it."""

    text: Any = None
    hour: Any = None
    of_text: Any = None
    of_vector: Any = None


def _parts(document: str | None, meta: Mapping[str, Any]) -> _Parts:
    if "record" in meta:
        try:
            hour, *sums, text = str(meta["record"]).split(" ", 3)
            return _Parts(text, int(hour), *_numbers(sums))
        except ValueError:
            return _Parts()
    said = _Parts(meta.get("text", document), meta.get("hour"), meta.get("text_sum"), meta.get("vector_sum"))
    return said if "sums" not in meta else _Parts(said.text, said.hour, *_numbers(str(meta["sums"]).split()))


def _numbers(sums: Sequence[str]) -> Sequence[int | None]:
    """The two check sums that are written as hexadecimal numbers; neither where one is not."""
    try:
        of_text, of_vector = (int(part, 16) for part in sums)
    except ValueError:
        return None, None
    return of_text, of_vector


def _text_sum(text: str, hour: int, own_json: str) -> int:
    """Return a check sum of all but the vector, which tells written from damaged."""
    return zlib.crc32(f"{hour} {len(text)} {text}{own_json}".encode())


def _vector_sum(vector: Vector, hour: int) -> int:
    """Return a check sum of a record's vector and hour."""
    return zlib.crc32(f"{hour} ".encode() + np.ascontiguousarray(vector, "<f4").tobytes())
