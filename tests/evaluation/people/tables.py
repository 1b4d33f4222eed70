"""Small tables of time use, written as files, and hours that are spent as their intention says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from coopera.core.time_use import CATEGORIES, Category
from coopera.evaluation.people.time_use import COLUMNS

Shares = Mapping[Category, float]


def rows(stratum: str, day_type: str, shares: Callable[[int], Shares]) -> list[list[str]]:
    """A whole day of a table: by hour the shares in percent; what is not named is 0."""
    return [
        [str(hour), category, str(shares(hour).get(category, 0.0)), stratum, day_type]
        for hour in range(24)
        for category in CATEGORIES
    ]


def write(path: Path, *groups: list[list[str]], header: tuple[str, ...] = COLUMNS) -> Path:
    lines = [list(header), *(row for group in groups for row in group)]
    path.write_text("".join(",".join(cells) + "\n" for cells in lines), encoding="utf-8")
    return path


def says(text: str) -> Mapping[Category, int]:
    """The intention "tv" takes an hour of television, "eating 35" takes 35 minutes."""
    name, _, minutes = text.partition(" ")
    (category,) = (one for one in CATEGORIES if one == name)
    return {category: int(minutes or 60)}
