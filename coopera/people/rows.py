"""Rows of a person's log, from CSV or JSONL, each with the line where it stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import load_json, read_text
from coopera.core.foreign.tables import read_table

JSONL = (".jsonl", ".ndjson")
MOST_ROWS = 200_000
"""Of a log or diary; ten years of hours are 87,600."""
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
    text = read_text(path, what)
    if path.suffix.lower() in JSONL:
        rows = list(_jsonl(path, text))
        return Rows(list(rows[0].cells) if rows else [], False, rows)
    return _csv(path, text)


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
    lines = read_table(path, text)
    header = [name.strip().lower() for name in next(lines).cells]
    rows: list[Row] = []
    for number, cells in lines:
        if len(cells) != len(header):
            raise ConfigError(
                f"{path}, line {number}: expected {len(header)} cells as in the header, found "
                f"{len(cells)} (a text with a comma in it stands in quotes)."
            )
        if len(rows) == MOST_ROWS:
            raise _too_many(path)
        rows.append(Row(number, _plain(dict(zip(header, cells, strict=True)))))
    return Rows(header, True, rows)


def _too_many(path: Path) -> ConfigError:
    return ConfigError(f"{path}: at most {MOST_ROWS} rows of a log are read, and this has more.")


def _plain(cells: Mapping[str, str]) -> dict[str, Any]:
    row: dict[str, Any] = {name: cell.strip() for name, cell in cells.items()}
    row["tasks"] = [task.strip() for task in row.get("tasks", "").split(";") if task.strip()]
    for name in row.keys() & {"away", "continues"}:
        row[name] = _FLAGS.get(row[name].lower(), row[name])
    return {name: cell for name, cell in row.items() if cell is not None}


def _jsonl(path: Path, text: str) -> Iterator[Row]:
    lines = text.splitlines()
    if len(lines) > MOST_ROWS:
        raise _too_many(path)
    for line, part in enumerate(lines, 1):
        if not part.strip():
            continue
        try:
            row = load_json(part)
        except ValueError as err:
            raise ConfigError(f"{path}, line {line}: this is not valid JSON ({err}).") from err
        if not isinstance(row, dict):
            raise ConfigError(f"{path}, line {line}: expected an object with a field for each column.")
        yield Row(line, row)
