"""Tables of how people spend their time: which share of them is at what, at each hour of a weekday and of a weekend.

A table is a CSV file with the columns hour, category, weighted_pct, stratum and day_type. One comes with the package.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.foreign.tables import read_table
from coopera.core.time_use import CATEGORIES, DAY_TYPES, Category, DayType
from coopera.evaluation.people.learners import Floats

COLUMNS = ("hour", "category", "weighted_pct", "stratum", "day_type")
SHIPPED = Path(__file__).parent / "time_use_atus_2022_23.csv"
SHIPPED_NAMES = ("shipped", "atus")
"""The shipped table's names on the command line."""
SOURCE = (
    "American Time Use Survey 2022-23, U.S. Bureau of Labor Statistics (public domain); "
    "table derived by BuildOcc (W. Jung 2026, Apache-2.0)"
)
"""Of the shipped table; to be named wherever its numbers are shown."""
STRATA = {"O1": "employed singles, 25-44", "O2": "retired couples, 65+"}
"""Who the shipped table's groups of people are."""

_MOST_BYTES = 2 * 2**20  # some eighty times the shipped table
_STRATUM = re.compile(r"[\w+. -]{1,40}", re.ASCII)
_HOUR = re.compile(r"[0-9]{1,2}", re.ASCII)
_SUM_WITHIN = 1.0  # percent by which an hour's shares may miss 100, for rounding


@dataclass(frozen=True, slots=True)
class TimeUse:
    """A table of time use.

    Attributes:
        shares: By stratum and day type: the share of people in each category at each hour of the day, shape (24, 9) in
            the order of `CATEGORIES`; every row sums to 1.
        source: Where the numbers come from, in one line.
        groups: Who the strata are, in words, where that is known.
    """

    shares: Mapping[tuple[str, DayType], Floats]
    source: str
    groups: Mapping[str, str] = field(default_factory=dict)

    @property
    def strata(self) -> list[str]:
        """The groups of people in the table, in the file's order."""
        return list(dict.fromkeys(stratum for stratum, _ in self.shares))

    def only(self, stratum: str) -> TimeUse:
        """The table of one stratum.

        Raises:
            ConfigError: If the table has no such stratum.
        """
        if stratum not in self.strata:
            raise ConfigError(f"--stratum: {stratum!r} is not in the table, which has {', '.join(self.strata)}.")
        return replace(self, shares={key: shares for key, shares in self.shares.items() if key[0] == stratum})


class _Cell(NamedTuple):
    stratum: str
    day_type: DayType
    hour: int
    category: Category


def named_time_use(name: str) -> TimeUse:
    """Return the shipped table ("shipped" or "atus"), or the one in a file.

    Raises:
        ConfigError: As `read_time_use`.
    """
    return read_time_use(SHIPPED if name in SHIPPED_NAMES else Path(name))


def read_time_use(path: Path) -> TimeUse:
    """Read a table of time use, and check it.

    Each stratum and day type of the table needs all 24 hours with all nine categories, with shares in percent that sum
    to 100 within 1; they are then divided by their sum.

    Raises:
        ConfigError: If the file cannot be read or breaks one of these rules; names the file, the line or the hour, the
            field and what was expected.
    """
    found: dict[_Cell, float] = {}
    lines: dict[_Cell, int] = {}
    for line, row in _rows(path):
        where = f"{path}, line {line}"
        cell = _cell(where, row)
        if cell in found:
            raise ConfigError(f"{where}: {_said(cell)} stands already in line {lines[cell]}; each may stand once only.")
        found[cell], lines[cell] = _share(where, row["weighted_pct"]), line
    if not found:
        raise ConfigError(f"{path}: the table of time use has no row below its header.")
    groups = dict.fromkeys((cell.stratum, cell.day_type) for cell in found)
    shares = {(stratum, kind): _whole(path, stratum, kind, found) for stratum, kind in groups}
    return TimeUse(shares, SOURCE, STRATA) if path == SHIPPED else TimeUse(shares, str(path))


def _rows(path: Path) -> Iterator[tuple[int, Mapping[str, str]]]:
    """The rows with their line numbers; empty lines are passed over."""
    lines = read_table(path, _text(path))
    header = [name.strip() for name in next(lines).cells]
    _check_header(path, header)
    for number, cells in lines:
        if len(cells) != len(header):
            raise ConfigError(f"{path}, line {number}: expected {len(header)} cells, found {len(cells)}.")
        yield number, {name: cell.strip() for name, cell in zip(header, cells, strict=True)}


def _text(path: Path) -> str:
    if not path.exists():
        names = " or ".join(repr(name) for name in SHIPPED_NAMES)
        raise ConfigError(f"{path}: there is no such table of time use (the shipped one is named {names}).")
    if not path.is_file():
        raise ConfigError(f"{path}: a table of time use must be a file.")
    return read_text(path, "table of time use", _MOST_BYTES)


def _check_header(path: Path, header: list[str]) -> None:
    expected = f"expected are {', '.join(COLUMNS)}"
    for name in header:
        if name not in COLUMNS or header.count(name) > 1:
            what = "stands twice" if name in COLUMNS else "is unknown"
            raise ConfigError(f"{path}, line 1: the column {name[:40]!r} {what}; {expected}.")
    for name in COLUMNS:
        if name not in header:
            raise ConfigError(f"{path}, line 1: the column {name} is missing; {expected}.")


def _cell(where: str, row: Mapping[str, str]) -> _Cell:
    hour, category, stratum, kind = row["hour"], row["category"], row["stratum"], row["day_type"]
    if not _HOUR.fullmatch(hour) or int(hour) > 23:
        raise ConfigError(f"{where}: hour must be a whole number from 0 to 23, not {hour[:40]!r}.")
    if category not in CATEGORIES:
        raise ConfigError(f"{where}: category must be one of {', '.join(CATEGORIES)}, not {category[:40]!r}.")
    if not _STRATUM.fullmatch(stratum):
        raise ConfigError(f"{where}: stratum must be a name of 1 to 40 letters and digits, not {stratum[:40]!r}.")
    if kind not in DAY_TYPES:
        raise ConfigError(f"{where}: day_type must be weekday or weekend, not {kind[:40]!r}.")
    return _Cell(stratum, kind, int(hour), category)


def _share(where: str, text: str) -> float:
    try:
        share = float(text) if "_" not in text else float("nan")
    except ValueError:
        share = float("nan")
    if not 0 <= share <= 100:
        raise ConfigError(f"{where}: weighted_pct must be a number from 0 to 100, not {text[:40]!r}.")
    return share


def _whole(path: Path, stratum: str, kind: DayType, found: Mapping[_Cell, float]) -> Floats:
    """The shares of a stratum and day type, shape (24, 9)."""
    for hour in range(24):
        where = f"{path}, stratum {stratum}, {kind}, hour {hour}"
        given = [found.get(_Cell(stratum, kind, hour, category)) for category in CATEGORIES]
        missing = [category for category, share in zip(CATEGORIES, given, strict=True) if share is None]
        if len(missing) == len(CATEGORIES):
            raise ConfigError(f"{where}: the hour is missing; expected are all hours from 0 to 23.")
        if missing:
            raise ConfigError(f"{where}: the category {missing[0]} is missing; expected are all nine.")
        total = sum(share for share in given if share is not None)
        if abs(total - 100) > _SUM_WITHIN:
            raise ConfigError(f"{where}: weighted_pct sums to {total:.4g}; expected is 100 within {_SUM_WITHIN:g}.")
    percent = np.array([[found[_Cell(stratum, kind, hour, name)] for name in CATEGORIES] for hour in range(24)])
    return np.asarray(percent / percent.sum(axis=1, keepdims=True), dtype=np.float64)


def _said(cell: _Cell) -> str:
    return f"stratum {cell.stratum}, {cell.day_type}, hour {cell.hour}, {cell.category}"
