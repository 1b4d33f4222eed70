"""What a real person did, as a file: a log hour by hour, or a diary with times.

Both are CSV with a header, or JSONL with one object per line; the columns tell which it is. Days count from 0.
A log has day, hour, intention and perhaps tasks, continues and away. A diary has day, start, end, activity and perhaps
tasks and away (`coopera.people.diary`). In CSV several tasks are parted by semicolons, in JSONL they are a list.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.hour import LoggedHour
from coopera.people.diary import COLUMNS as DIARY
from coopera.people.diary import hours_of, read_episodes
from coopera.people.rows import JSONL, Rows, read_rows, refuse_missing

FIELDS = tuple(LoggedHour.model_fields)
_NEEDED = ("day", "hour", "intention")
_EXPECTED = {
    "day": "a whole number from 0 up",
    "hour": "a whole number from 0 to 23",
    "intention": "a text of 1 to 300 characters",
    "tasks": "at most 8 texts of 1 to 300 characters",
    "continues": "yes or no",
    "away": "yes or no",
}


class Log(NamedTuple):
    """The hours of a person, sorted; in a diary an hour without an episode is open, in a log it is an omission."""

    hours: list[LoggedHour]
    diary: bool


def read_log(path: Path) -> list[LoggedHour]:
    """Read the hours of a log or a diary, sorted by day and hour; errors as in `open_log`."""
    return open_log(path).hours


def open_log(path: Path) -> Log:
    """Read a person's log or diary.

    Raises:
        ConfigError: If the file cannot be read, lacks a field, holds a wrong value, the same hour twice, episodes that
            overlap, or nothing; names the file, the line and what was expected.
    """
    rows = read_rows(path, "log of a person")
    if is_diary(rows):
        hours = hours_of(read_episodes(path, rows))
        if not hours:
            raise ConfigError(
                f"{path}: every episode of the diary is after midnight, on a day without a row of its own."
            )
        return Log(hours, True)
    refuse_missing(path, rows, _NEEDED)
    seen: dict[tuple[int, int], int] = {}
    hours = []
    for line, row in rows.rows:
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
    return Log(sorted(hours, key=lambda hour: (hour.day, hour.hour)), False)


def looks_like_log(path: Path) -> bool:
    """Whether a file is meant to be a log or a diary: JSONL, or CSV with a column day.

    Raises:
        ConfigError: If a CSV cannot be read.
    """
    if path.suffix.lower() == ".csv":
        header = read_text(path, "CSV file").partition("\n")[0]
        return "day" in [name.strip().lower() for name in header.split(",")]
    return path.suffix.lower() in JSONL


def is_diary(rows: Rows) -> bool:
    """Whether the columns are a diary's: start, end or activity, and neither hour nor intention."""
    theirs = set(DIARY) - set(FIELDS)
    return not theirs.isdisjoint(rows.columns) and {"hour", "intention"}.isdisjoint(rows.columns)


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
