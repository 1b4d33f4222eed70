"""Shares of time use by hour of the day as a picture: simulated people beside those of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coopera.core.time_use import CATEGORIES, DAY_TYPES, Category, DayType
from coopera.evaluation.people.figures import FULL
from coopera.evaluation.people.hours_spent import SpentDay
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.time_use import TimeUse
from coopera.evaluation.people.time_use_distance import tally

COLOURS: dict[Category, str] = {
    "sleeping": "#0072b2",
    "work": "#4d4d4d",
    "food_prep": "#e69f00",
    "laundry": "#56b4e9",
    "tv": "#d55e00",
    "eating": "#f0e442",
    "exercise": "#009e73",
    "travel": "#cc79a7",
    "other": "#e3e3e3",
}
"""Okabe and Ito's colours, which colour-blind people tell apart, with two greys."""
_INK = "#222222"


class _Panel(NamedTuple):
    """One stack of shares, (hours, 9); `shares` None where there is no such day."""

    title: str
    hours: list[int]
    shares: Floats | None


def draw_time_use(variants: Mapping[str, Sequence[SpentDay]], table: TimeUse, path: Path, caption: str) -> None:
    """Draw a PNG file with a row for weekdays and one for weekends, each over the hours that somebody lived.

    Args:
        variants: Days by how the person was simulated; a column each, then one for each stratum of the table.
        table: What they are compared with.
        path: Where the picture goes.
        caption: Stands below it, after the table's source.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - heavy
    from matplotlib.figure import Figure as Picture  # noqa: PLC0415

    rows = [_row(variants, table, kind) for kind in DAY_TYPES]
    columns = len(rows[0])
    picture = Picture(figsize=(1.2 + 3.6 * columns, 6.6), layout="constrained")
    FigureCanvasAgg(picture)
    grid = picture.subplots(len(rows), columns, sharey=True, squeeze=False)
    for axes_row, panels in zip(grid, rows, strict=True):
        for axes, panel in zip(axes_row, panels, strict=True):
            _draw_panel(axes, panel)
        axes_row[0].set_ylabel("share of people, %", fontsize=9, color=_INK)
    handles, labels = next((axes.get_legend_handles_labels() for axes in grid.flat if axes.containers), ([], []))
    picture.legend(handles[::-1], labels[::-1], loc="outside right center", fontsize=9, frameon=False)
    picture.supxlabel(f"Table: {table.source}\n{caption}", fontsize=7, color="#666666", wrap=True)
    picture.savefig(path, dpi=150, metadata={"Software": None})


def _row(variants: Mapping[str, Sequence[SpentDay]], table: TimeUse, kind: DayType) -> list[_Panel]:
    everybody = [day for days in variants.values() for day in days if day.day_type == kind]
    hours = tally(everybody, _person).hours
    panels = []
    for variant, days in variants.items():
        lived = tally([day for day in days if day.day_type == kind], _person)
        name = "simulated" if variant == FULL else f"simulated, {variant.replace('_', ' ')}"
        title = f"{name}:\n{kind}, {lived.days} person-days of {len(lived.units)} people"
        panels.append(_Panel(title, lived.hours, lived.pooled if lived.days else None))
    for stratum in table.strata:
        shares = table.shares.get((stratum, kind))
        group = f"{stratum}, {table.groups[stratum]}" if stratum in table.groups else stratum
        title = f"table, {group}:\n{kind}, the same hours"
        panels.append(_Panel(title, hours, None if shares is None or not hours else shares[hours]))
    return panels


def _draw_panel(axes: Any, panel: _Panel) -> None:
    axes.set_title(panel.title, fontsize=9, color=_INK)
    axes.set_ylim(0, 100)
    axes.tick_params(labelsize=8, colors=_INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    if panel.shares is None:
        axes.text(0.5, 0.5, "no such day", ha="center", va="center", transform=axes.transAxes, color="#666666")
        axes.set_xticks([])
        return
    below = np.zeros(len(panel.hours))
    for place, category in enumerate(CATEGORIES):
        height = 100 * panel.shares[:, place]
        label = category.replace("_", " ")
        colour = COLOURS[category]
        axes.bar(panel.hours, height, 0.92, below, color=colour, edgecolor="white", linewidth=0.4, label=label)
        below = below + height
    axes.set_xticks(panel.hours[:: 1 + len(panel.hours) // 9])
    axes.set_xlabel("hour of day", fontsize=8, color=_INK)


def _person(day: SpentDay) -> str:
    return day.person
