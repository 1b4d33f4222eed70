"""What the benchmarks on other people's data share: reading a file with care, and one sentence for wrong input."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from coopera.core.errors import ConfigError, CooperaError

LARGEST = 64_000_000
"""Bytes of the largest file that is read."""
LONGEST = 300
"""Characters of the longest name or request."""


def read_text(path: Path) -> str:
    """Return the text of a file.

    Raises:
        ConfigError: If it cannot be read, is too large, or is not UTF-8.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise ConfigError(f"{path}: has {path.stat().st_size} bytes, expected at most {LARGEST}")
        return path.read_text(encoding="utf-8")
    except OSError as err:
        raise ConfigError(f"{path}: cannot be read ({err.strerror})") from err
    except UnicodeDecodeError as err:
        raise ConfigError(f"{path}: is not UTF-8 text (byte {err.start})") from err


def read_json(path: Path) -> Any:
    """Return what a JSON file holds; a key that stands twice is an error.

    Raises:
        ConfigError: If it cannot be read or is not JSON.
    """
    try:
        return json.loads(read_text(path), object_pairs_hook=_once, parse_constant=_no_number)
    except json.JSONDecodeError as err:
        raise ConfigError(f"{path}: line {err.lineno}: is not JSON ({err.msg})") from err
    except (ValueError, RecursionError) as err:
        raise ConfigError(f"{path}: is not JSON that can be read ({err})") from err


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"{next(name for name in names if names.count(name) > 1)!r} stands twice")
    return found


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")


def is_name(value: object) -> bool:
    """Whether a value is a text of some, and not too many, characters."""
    return isinstance(value, str) and bool(value.strip()) and len(value) <= LONGEST


def run(
    measure: Callable[[argparse.Namespace], dict[str, Any]],
    parser: argparse.ArgumentParser,
    given: Sequence[str] | None,
) -> int:
    """Measure and print; returns the exit code: 0, 1 if the work failed, 2 if the input is wrong."""
    parser.add_argument("--json", action="store_true", help="end with one line of JSON")
    asked = parser.parse_args(given)
    try:
        found = measure(asked)
    except CooperaError as err:
        print(f"error: {err}", file=sys.stderr)
        return 2 if isinstance(err, ConfigError) else 1
    if asked.json:
        print(json.dumps(found, allow_nan=False))
    return 0
