"""What a real person did, hour by hour, as a file: CSV or JSONL with day, hour, intention and, where known, tasks.

CSV has a header with the columns day, hour, intention and perhaps tasks, of which several are parted by semicolons.
JSONL has one object with these fields per line, tasks being a list of texts. Days count from 0.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from coopera.config.files import read_text
from coopera.core.errors import ConfigError
from coopera.core.hour import LoggedHour

FIELDS = tuple(LoggedHour.model_fields)
_NEEDED = ("day", "hour", "intention")
_EXPECTED = {
    "day": "a whole number from 0 up",
    "hour": "a whole number from 0 to 23",
    "intention": "a text of 1 to 300 characters",
    "tasks": "at most 8 texts of 1 to 300 characters",
}


def read_log(path: Path) -> list[LoggedHour]:
    """Read a person's log, sorted by day and hour.

    Raises:
        ConfigError: If the file cannot be read, lacks a field, holds a wrong value, the same hour twice, or nothing;
            names the file, the line and what was expected.
    """
    text = read_text(path, "log of a person")
    rows = _jsonl(path, text) if path.suffix.lower() in (".jsonl", ".ndjson") else _csv(path, text)
    seen: dict[tuple[int, int], int] = {}
    hours = []
    for line, row in rows:
        hour = _hour(path, line, row)
        key = (hour.day, hour.hour)
        if key in seen:
            raise ConfigError(
                f"{path}, line {line}: day {hour.day}, hour {hour.hour} stands already in line {seen[key]}; "
                "an hour has one intention."
            )
        seen[key] = line
        hours.append(hour)
    if not hours:
        raise ConfigError(f"{path}: the log holds no hour.")
    return sorted(hours, key=lambda hour: (hour.day, hour.hour))


def _csv(path: Path, text: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        header = [name.strip().lower() for name in next(reader, [])]
        for field in _NEEDED:
            if field not in header:
                found = ", ".join(header) or "an empty line"
                raise ConfigError(f"{path}, line 1: the column {field} is missing; the header has {found}.")
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                raise ConfigError(
                    f"{path}, line {reader.line_num}: expected {len(header)} cells as in the header, found "
                    f"{len(cells)} (a text with a comma in it stands in quotes)."
                )
            row: dict[str, Any] = {name: cell.strip() for name, cell in zip(header, cells, strict=True)}
            row["tasks"] = [task.strip() for task in row.get("tasks", "").split(";") if task.strip()]
            yield reader.line_num, row
    except csv.Error as err:
        raise ConfigError(f"{path}, line {reader.line_num}: this is not valid CSV ({err}).") from err


def _jsonl(path: Path, text: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    for line, part in enumerate(text.splitlines(), 1):
        if not part.strip():
            continue
        try:
            row = json.loads(part)
        except (ValueError, RecursionError) as err:
            raise ConfigError(f"{path}, line {line}: this is not valid JSON ({err}).") from err
        if not isinstance(row, dict):
            raise ConfigError(f"{path}, line {line}: expected an object with {', '.join(_NEEDED)}.")
        yield line, row


def _hour(path: Path, line: int, row: Mapping[str, Any]) -> LoggedHour:
    unknown = [name for name in row if name not in FIELDS]
    if unknown:
        raise ConfigError(f"{path}, line {line}: there is no field {unknown[0]!r} (known are {', '.join(FIELDS)}).")
    try:
        return LoggedHour.model_validate(dict(row))
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = str(first["loc"][0])
        if first["type"] == "missing":
            raise ConfigError(f"{path}, line {line}: the field {field} is missing.") from None
        shown = str(row[field])[:60]
        raise ConfigError(f"{path}, line {line}: {field} must be {_EXPECTED[field]}, not {shown!r}.") from None
