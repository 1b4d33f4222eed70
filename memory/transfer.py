"""Streams as JSON lines: to look at, to keep, to move to another store or another embedding model.

The first line tells what the file is; each further line is a record, oldest first: `{"text", "hour", "metadata"}`.
Vectors are not part of it: they follow from the texts.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import Field, StrictInt, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.people import Frozen
from coopera.memory.questions import MAX_TEXT
from coopera.memory.rows import Record
from coopera.memory.stream import MemoryStream

_KIND = "coopera memory stream"
_VERSION = 1


class _Header(Frozen):
    kind: str
    version: int
    stream: str
    model: str


class _Line(Frozen):
    text: str = Field(min_length=1, max_length=MAX_TEXT)
    hour: StrictInt
    metadata: dict[str, Any] = {}


def export_jsonl(stream: MemoryStream, path: Path) -> int:
    """Write a stream to a file, which appears whole or not at all; return the number of records.

    Raises:
        ConfigError: If the file cannot be written.
        MemoryStoreError: If the stream cannot be read.
    """
    header = _Header(kind=_KIND, version=_VERSION, stream=stream.name, model=stream.model)
    unfinished = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        with unfinished.open("w", encoding="utf-8") as file:
            file.write(header.model_dump_json() + "\n")
            count = 0
            for record in stream.records():
                file.write(json.dumps(record._asdict(), ensure_ascii=False) + "\n")
                count += 1
        unfinished.replace(path)
    except OSError as err:
        raise ConfigError(f"{path}: cannot be written: {err}") from err
    finally:
        unfinished.unlink(missing_ok=True)
    return count


def import_jsonl(stream: MemoryStream, path: Path) -> int:
    """Add a file's records to a stream, encoding them with the stream's embeddings; return their number.

    The whole file is checked first. A stream of another name or embedding model may be read: only texts are taken.

    Raises:
        ConfigError: Naming the file and the line that cannot be used; nothing is then added.
        MemoryStoreError: If the stream cannot be written.
    """
    records = list(_read(path))
    stream.extend(records)
    return len(records)


def _read(path: Path) -> Iterator[Record]:
    """Yield the records of a file.

    Raises:
        ConfigError: Naming the file and the line.
    """
    newest: int | None = None
    number = 0
    try:
        with path.open(encoding="utf-8") as file:
            for number, line in enumerate(file, 1):
                if number == 1:
                    _check_header(path, line)
                    continue
                record = _Line.model_validate_json(line)
                if newest is not None and record.hour < newest:
                    raise ConfigError(f"{path}, line {number}: hour {record.hour} comes after hour {newest}")
                newest = record.hour
                yield Record(record.text, record.hour, record.metadata)
    except ValidationError as err:
        first = err.errors()[0]
        field = ".".join(map(str, first["loc"])) or "the line"
        raise ConfigError(f"{path}, line {number}: {field}: {first['msg']}") from err
    except (OSError, UnicodeDecodeError) as err:
        raise ConfigError(f"{path}: cannot be read: {err}") from err
    if number == 0:
        raise ConfigError(f"{path}: is empty, where a {_KIND} was expected")


def _check_header(path: Path, line: str) -> None:
    try:
        header = _Header.model_validate_json(line)
    except ValidationError as err:
        raise ConfigError(f"{path}, line 1: is not the first line of a {_KIND}") from err
    if (header.kind, header.version) != (_KIND, _VERSION):
        raise ConfigError(f"{path}, line 1: is a {header.kind!r} of version {header.version}, not a {_KIND!r} of 1")
