"""The one reader of comma-separated text: rows with their lines, within limits."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from coopera.core.errors import ConfigError

MOST_CELLS = 5_000_000
MOST_LINES = 500_000
LONGEST_CELL = 131_072
"""Characters of a cell, as Python's own reader has it."""


class Line(NamedTuple):
    """A row: the line (from 1) where it ends in the file, and its cells."""

    number: int
    cells: list[str]


def read_table(path: Path, text: str) -> Iterator[Line]:
    """The rows of CSV text, the header first and even if it is empty; blank rows are left out.

    Raises:
        ConfigError: At the row where the text is no CSV, or at the first one where it is beyond the limits.
    """
    if text.count("\n") > MOST_LINES or text.count("\r") > MOST_LINES or text.count(",") > MOST_CELLS:
        raise ConfigError(f"{path}: at most {MOST_LINES} lines and {MOST_CELLS} cells are read, and this has more.")
    return rows_of(path, io.StringIO(text, newline=""))


def rows_of(path: Path, lines: Iterable[str]) -> Iterator[Line]:
    """The rows of lines of CSV; as `read_table`, but for text of any length.

    Raises:
        ConfigError: At the row where the text is no CSV.
    """
    reader = csv.reader(lines, strict=True)
    try:
        yield Line(1, next(reader, []))
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield Line(reader.line_num, cells)
    except csv.Error as err:
        raise ConfigError(f"{path}, line {reader.line_num}: this is not valid CSV ({err}).") from err
