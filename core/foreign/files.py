"""The one reader of a foreign file's bytes, text and JSON: no more of it than is bearable, one sentence if wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from coopera.core.errors import ConfigError

MOST_BYTES = 256 * 2**20
"""No file is larger."""
MOST_TEXT = 64 * 2**20
"""No text file is larger, in bytes."""
MOST_VALUES = 5_000_000
"""No JSON text holds more."""
DEEPEST = 64
"""No JSON text is nested deeper."""


def read_limited(path: Path, most_bytes: int = MOST_BYTES, what: str = "file") -> bytes:
    """Read a file of at most so many bytes; `what` names the kind of file in errors.

    Raises:
        ConfigError: If it is missing, unreadable or larger; names the file.
    """
    try:
        with path.open("rb") as file:
            data = file.read(most_bytes + 1)
    except FileNotFoundError:
        raise ConfigError(f"{path}: there is no such {what}.") from None
    except OSError as err:
        raise ConfigError(f"{path}: the {what} cannot be read ({(err.strerror or str(err)).lower()}).") from err
    except ValueError as err:  # a name that no file can have
        raise ConfigError(f"{str(path)!r}: the {what} cannot be read ({err}).") from err
    if len(data) > most_bytes:
        raise ConfigError(f"{path}: the {what} has more than {_in_words(most_bytes)}, and at most that many are read.")
    return data


def read_text(path: Path, what: str = "file", most_bytes: int = MOST_TEXT) -> str:
    """Return a UTF-8 file's text (a byte-order mark is dropped); `what` names the kind of file in errors.

    Raises:
        ConfigError: If the file is missing, unreadable, too large or not UTF-8; names the file, for bytes the line.
    """
    data = read_limited(path, most_bytes, what)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as err:
        line = data[: err.start].count(b"\n") + 1
        raise ConfigError(f"{path}, line {line}: the {what} must be UTF-8 text, but byte {err.start} is not.") from err


def load_json(text: str | bytes) -> Any:
    """Read JSON text of at most `MOST_VALUES` values and `DEEPEST` lists or objects within each other.

    NaN and Infinity are let through: a model refuses them with the field's name.

    Raises:
        ValueError: If it is not valid, or beyond the limits; `json.JSONDecodeError` where the line is known.
    """
    text = text.decode() if isinstance(text, bytes) else text
    if sum(text.count(mark) for mark in "[{,") > MOST_VALUES:
        raise ValueError(f"it holds more than {MOST_VALUES} values")
    try:
        data = json.loads(text)
    except RecursionError as err:
        raise ValueError("it is nested too deeply") from err
    level = [data]
    for _ in range(DEEPEST):
        level = [inner for one in level if isinstance(one, dict | list) for inner in _inside(one)]
        if not level:
            return data
    raise ValueError("it is nested too deeply")


def read_json(path: Path, what: str = "JSON file", most_bytes: int = MOST_TEXT) -> Any:
    """Read a JSON file, of whatever shape.

    Raises:
        ConfigError: If it cannot be read or is no JSON within the limits; names the file, and the line where known.
    """
    text = read_text(path, what, most_bytes)
    try:
        return load_json(text)
    except json.JSONDecodeError as err:
        raise ConfigError(f"{path}, line {err.lineno}: this is not valid JSON ({err.msg}).") from err
    except ValueError as err:
        raise ConfigError(f"{path}: this is not valid JSON ({err}).") from err


def exists(path: Path) -> bool:
    """Whether there is such a file; no error of a name that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _inside(one: dict[str, Any] | list[Any]) -> list[Any]:
    inner = one.values() if isinstance(one, dict) else one
    return [value for value in inner if isinstance(value, dict | list)]


def _in_words(count: int) -> str:
    return f"{count >> 20} MiB" if count % 2**20 == 0 else f"{count} bytes"
