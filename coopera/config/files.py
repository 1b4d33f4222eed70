"""Files as coopera reads and writes them: YAML with clear errors, canonical JSON, atomic replacement."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import yaml

from coopera.core.errors import ConfigError, RunError
from coopera.core.foreign.files import read_text
from coopera.core.strict_yaml import MOST_BYTES, load_yaml


def read_yaml(path: Path, what: str, most_bytes: int = MOST_BYTES) -> dict[str, Any]:
    """Return the mapping in a YAML file; an empty file is an empty mapping.

    Raises:
        ConfigError: If the file cannot be read or is no YAML mapping; names the file and the line.
    """
    try:
        data = load_yaml(read_text(path, what, most_bytes))
    except yaml.MarkedYAMLError as err:
        line = f", line {err.problem_mark.line + 1}" if err.problem_mark else ""
        raise ConfigError(f"{path}{line}: this is not valid YAML ({err.problem}).") from err
    if data is None:
        return {}
    if not isinstance(data, dict):
        raise ConfigError(f"{path}: the {what} must be a mapping of fields to values, not a {type(data).__name__}.")
    for key in data:
        if not isinstance(key, str):
            raise ConfigError(f"{path}: field names must be words, not {key!r}.")
    return data


def canonical_json(data: Any, *, indent: int | None = 1) -> str:
    """Return data as JSON text with sorted keys, so that equal data are equal bytes.

    Args:
        data: What to write.
        indent: None puts all on one line, which is written ten times as fast: for files that only programs read.

    Raises:
        RunError: If the data hold a number that is not finite, or something that JSON has no word for.
    """
    try:
        return json.dumps(data, sort_keys=True, indent=indent, ensure_ascii=False, allow_nan=False) + "\n"
    except (TypeError, ValueError) as err:
        raise RunError(f"This cannot be written as JSON: {err}.") from err


def write_atomic(path: Path, text: str) -> None:
    """Replace a file's content as a whole: a reader, or a crash, meets the old file or the new one.

    Raises:
        OSError: If the folder cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    half = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with half.open("w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(half, path)
    except BaseException:
        half.unlink(missing_ok=True)
        raise


def write_output(path: Path, text: str) -> None:
    """Write a file that a user has asked for, as a whole.

    Raises:
        ConfigError: If it cannot be written.
    """
    try:
        write_atomic(path, text)
    except OSError as err:
        raise ConfigError(f"{path}: the file cannot be written ({reason(err)}).") from err


def reason(err: OSError) -> str:
    """Say an operating system's refusal in a few words, such as "permission denied"."""
    return (err.strerror or str(err)).lower()
