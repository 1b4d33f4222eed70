"""Rows of a person's log, from CSV or JSONL, each with the line where it stands."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from coopera.config.files import read_text, reason
from coopera.core.errors import ConfigError

JSONL = (".jsonl", ".ndjson")
LARGEST = 64 * 1024**2  # bytes; ten years of diary have a hundredth of it
_FLAGS = {"": None, "yes": True, "true": True, "1": True, "no": False, "false": False, "0": False}


class Row(NamedTuple):
    """One row: the line (from 1) where it ends in the file, and its cells by column."""

    line: int
    cells: Mapping[str, Any]


class Rows(NamedTuple):
    """The rows of a file, and the columns of its header (JSONL: of its first object)."""

    columns: list[str]
    header: bool
    rows: list[Row]


def read_rows(path: Path, what: str) -> Rows:
    """Read CSV with a header, or JSONL where the name ends on .jsonl or .ndjson.

    In CSV the cell `tasks` becomes a list, parted by semicolons, and `away` and `continues` become booleans.

    Raises:
        ConfigError: If the file cannot be read or is too large, or a line is neither; names the file and the line.
    """
    text = read_limited(path, what)
    if path.suffix.lower() in JSONL:
        rows = list(_jsonl(path, text))
        return Rows(list(rows[0].cells) if rows else [], False, rows)
    return _csv(path, text)


def read_limited(path: Path, what: str) -> str:
    """Read a text file of at most 64 MiB.

    Raises:
        ConfigError: If it cannot be read, or is larger.
    """
    try:
        size = path.stat().st_size
    except FileNotFoundError:
        size = 0  # reading it says so
    except OSError as err:
        raise ConfigError(f"{path}: the {what} cannot be read ({reason(err)}).") from err
    if size > LARGEST:
        raise ConfigError(f"{path}: the {what} has {size} bytes, and at most {LARGEST} are read.")
    return read_text(path, what)


def refuse_missing(path: Path, rows: Rows, needed: tuple[str, ...]) -> None:
    """Refuse a CSV whose header lacks a column.

    Raises:
        ConfigError: If one is missing.
    """
    for column in needed if rows.header else ():
        if column not in rows.columns:
            found = ", ".join(rows.columns) or "an empty line"
            raise ConfigError(f"{path}, line 1: the column {column} is missing; the header has {found}.")


def _csv(path: Path, text: str) -> Rows:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    rows = []
    try:
        header = [name.strip().lower() for name in next(reader, [])]
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                raise ConfigError(
                    f"{path}, line {reader.line_num}: expected {len(header)} cells as in the header, found "
                    f"{len(cells)} (a text with a comma in it stands in quotes)."
                )
            rows.append(Row(reader.line_num, _plain(dict(zip(header, cells, strict=True)))))
    except csv.Error as err:
        raise ConfigError(f"{path}, line {reader.line_num}: this is not valid CSV ({err}).") from err
    return Rows(header, True, rows)


def _plain(cells: Mapping[str, str]) -> dict[str, Any]:
    row: dict[str, Any] = {name: cell.strip() for name, cell in cells.items()}
    row["tasks"] = [task.strip() for task in row.get("tasks", "").split(";") if task.strip()]
    for name in row.keys() & {"away", "continues"}:
        row[name] = _FLAGS.get(row[name].lower(), row[name])
    return {name: cell for name, cell in row.items() if cell is not None}


def _jsonl(path: Path, text: str) -> Iterator[Row]:
    for line, part in enumerate(text.splitlines(), 1):
        if not part.strip():
            continue
        try:
            row = json.loads(part)
        except (ValueError, RecursionError) as err:
            raise ConfigError(f"{path}, line {line}: this is not valid JSON ({err}).") from err
        if not isinstance(row, dict):
            raise ConfigError(f"{path}, line {line}: expected an object with a field for each column.")
        yield Row(line, row)
