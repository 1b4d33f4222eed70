"""A results folder as a page shows it: its tables, and figures of need and of the paper's F1."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

from coopera.core.clock import hour_label
from coopera.core.errors import ConfigError, RunError
from coopera.core.foreign.files import read_text
from coopera.evaluation.analysis import curve, endpoint_of, plain
from coopera.evaluation.results import Card, Row, check_card, from_csv
from coopera.evaluation.table import Table
from coopera.evaluation.tables import all_tables
from coopera.report import charts
from coopera.rundir.trace_files import read_json

CARD, TABLE = "results.json", "hours.csv"
_MEASURES = (("help", "Need F1"), ("predicate", "The paper’s F1, by the predicate"))


class Figure(NamedTuple):
    """A chart with a line for each method; `methods` in the order of the lines' colours, with their last figure."""

    title: str
    about: str
    drawing: Markup
    methods: list[tuple[str, float | None]]


def read_results(folder: Path) -> tuple[Card, list[Row]]:
    """Read and check a results folder.

    Raises:
        ConfigError: If a file is missing, of another format, or not what its card describes.
    """
    if not (folder / CARD).is_file():
        raise ConfigError(f"{folder}: this folder holds no results (there is no {CARD} in it).")
    table = read_text(folder / TABLE, "table of results")
    try:
        data = read_json(folder / CARD)
    except RunError as err:
        raise ConfigError(str(err)) from None
    return check_card(data, table, str(folder / CARD)), from_csv(table, str(folder / TABLE))


def shown(card: Card, rows: Sequence[Row], tables: Sequence[Table] | None = None) -> dict[str, Any]:
    """What the page of a benchmark shows of its results."""
    made = all_tables(rows, card.methods, endpoint_of(card)) if tables is None else tables
    return {"card": card, "tables": made, "figures": figures(plain(rows), card.methods)}


def figures(rows: Sequence[Row], methods: Sequence[str]) -> list[Figure]:
    """Need F1 and the paper's F1 across days with a person, and within a day; all settings and types together."""
    found = []
    for measure, title in _MEASURES:
        found += _figures(
            f"{title}, across days", "day with this person", rows, methods, measure, lambda row: row.round
        )
        found += _figures(f"{title}, within a day", "all days together", rows, methods, measure, lambda row: row.hour)
    return found


def _figures(
    title: str, about: str, rows: Sequence[Row], methods: Sequence[str], measure: str, at: Callable[[Row], int]
) -> list[Figure]:
    lines: Mapping[str, Mapping[Any, float]] = curve(rows, at, measure)
    ticks = sorted({tick for points in lines.values() for tick in points})
    known = [method for method in methods if lines.get(method)]
    if not known:
        return []
    series = [
        charts.Series(method.replace("_", " "), f"m{number}", [lines[method].get(tick) for tick in ticks])
        for number, method in enumerate(known)
    ]
    hours = about != "day with this person"
    names = [hour_label(tick).replace(" ", "") if hours else str(tick) for tick in ticks]
    last = [
        (method, next((v for tick in reversed(ticks) if (v := lines[method].get(tick)) is not None), None))
        for method in known
    ]
    return [Figure(title, about, charts.lines(series[::-1], names, label=title), last)]
