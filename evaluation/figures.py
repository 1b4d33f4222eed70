"""Figures in the paper's layout, as SVG."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Any

from coopera.core.clock import hour_label
from coopera.evaluation.analysis import curve
from coopera.evaluation.measuring import find_measure
from coopera.evaluation.results import Row

COLOURS = ("#c1121f", "#1d70b8", "#222222", "#7a7a7a", "#2a9d8f", "#e9a23b", "#8338ec", "#6a994e", "#bc6c25", "#a2d2ff")
_STYLE: Any = {
    "svg.hashsalt": "coopera",
    "svg.fonttype": "none",
    "font.size": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
}


def all_figures(rows: Sequence[Row], methods: Sequence[str]) -> dict[str, str]:
    """Every figure by name, as SVG text; the same rows give the same bytes."""
    return {
        "need_within_and_across_days": within_and_across(rows, methods, "help"),
        "breakdown_need": breakdown(rows, methods, "help"),
        "within_and_across_days": within_and_across(rows, methods),
        "breakdown_predicate": breakdown(rows, methods, "predicate"),
        "breakdown_judge": breakdown(rows, methods, "judge"),
    }


def within_and_across(rows: Sequence[Row], methods: Sequence[str], measure: str = "predicate") -> str:
    """The paper's figure of change: (a) within a day, by hour; (b) across days; all settings and types together."""
    figure, (left, right) = _axes(1, 2, (9.2, 3.4))
    _lines(left, rows, methods, lambda row: row.hour, measure)
    _lines(right, rows, methods, lambda row: row.round, measure)
    hours = sorted({row.hour for row in rows})
    left.set_xticks(hours[::3], [hour_label(hour) for hour in hours[::3]])
    left.set_title("(a) within a day, all days", loc="left")
    left.set_ylabel(find_measure(measure).title)
    right.set_title("(b) across days with the same person", loc="left")
    right.set_xlabel("day with this person")
    right.set_xticks(sorted({row.round for row in rows}))
    right.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    return _svg(figure)


def breakdown(rows: Sequence[Row], methods: Sequence[str], measure: str) -> str:
    """The paper's breakdown: methods across days, a row per collaboration type and a column per setting."""
    settings, types = sorted({row.setting for row in rows}), sorted({row.collab for row in rows})
    figure, grid = _axes(len(types), len(settings), (2.6 * len(settings) + 1.6, 2.3 * len(types) + 0.5))
    for down, collab in enumerate(types):
        for across, setting in enumerate(settings):
            axes = grid[down * len(settings) + across]
            chosen = [row for row in rows if (row.setting, row.collab) == (setting, collab)]
            _lines(axes, chosen, methods, lambda row: row.day, measure)
            axes.set_title(f"setting {setting}, type {collab}", loc="left")
            axes.set_xticks(sorted({row.day for row in chosen}))
            if down == len(types) - 1:
                axes.set_xlabel("day")
            if across == 0:
                axes.set_ylabel(find_measure(measure).title)
    grid[len(settings) - 1].legend(loc="upper left", bbox_to_anchor=(1.01, 1.05), frameon=False)
    return _svg(figure)


def _axes(down: int, across: int, size: tuple[float, float]) -> tuple[Any, list[Any]]:
    import matplotlib  # noqa: PLC0415 - heavy
    from matplotlib.figure import Figure  # noqa: PLC0415

    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.subplots(down, across, sharey=True, squeeze=False)
    return figure, list(axes.flat)


def _lines(
    axes: Any, rows: Sequence[Row], methods: Sequence[str], at: Callable[[Row], int | str], measure: str
) -> None:
    found = curve(rows, at, measure)
    for place, method in enumerate(methods):
        points = found.get(method, {})
        solid = place < len(COLOURS)
        axes.plot(
            list(points),
            list(points.values()),
            marker="o",
            markersize=3,
            linewidth=2.2 if place == 0 else 1.1,
            linestyle="-" if solid else "--",
            color=COLOURS[place % len(COLOURS)],
            label=method.replace("_", " "),
        )
    axes.set_ylim(0, 1)


def _svg(figure: Any) -> str:
    import matplotlib  # noqa: PLC0415 - heavy

    text = io.StringIO()
    with matplotlib.rc_context(_STYLE):
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return text.getvalue()
