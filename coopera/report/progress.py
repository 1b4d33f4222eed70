"""What a long run shows while it works, and at its end."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rich import progress as bars
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from coopera.config.prices import in_words
from coopera.core.clock import hour_label
from coopera.evaluation.measuring import all_measures
from coopera.report.console import PlainConsole


class Progress:
    """Shows day, hour, node and running success: one live line on a terminal, else a line per hour.

    Everything goes to standard error, so that standard output stays clean for results.
    """

    def __init__(self, hours: int, console: Console | None = None, *, done: Collection[tuple[int, int]] = ()) -> None:
        """Expect `hours` hours in all, of which those in `done` (day, hour) were lived before."""
        self._console = console or PlainConsole(stderr=True, highlight=False)
        self._hours = hours
        self._done: set[tuple[int, int]] = set(done)
        self._now: tuple[int, int] | None = None
        self._success = "–"
        self._bar: bars.Progress | None = None
        if self._console.is_terminal:
            self._bar = bars.Progress(
                bars.TextColumn("{task.description}"),
                bars.BarColumn(bar_width=28),
                bars.MofNCompleteColumn(),
                bars.TimeElapsedColumn(),
                console=self._console,
            )
            self._task = self._bar.add_task("getting ready", total=hours)

    def __enter__(self) -> Self:
        """Start showing."""
        if self._bar:
            self._bar.start()
        else:
            self._console.print(f"getting ready; {len(self._done)} of {self._hours} hours are done")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Show the last hour as done unless it was broken off."""
        if error is None:
            self._close_hour()
        self.close()

    def close(self) -> None:
        """Leave the terminal as it was."""
        if self._bar:
            self._bar.stop()

    def tell(self, event: Mapping[str, Any]) -> None:
        """Take in that a node has ended: `day`, `hour` (None in the evening), `node`, `success` so far or None."""
        day, hour, node = event["day"], event.get("hour"), event.get("node") or ""
        if self._now is not None and (hour is None or (day, hour) != self._now):
            self._close_hour()
        if hour is not None:
            self._now = (day, hour)
        if event.get("success") is not None:
            self._success = f"{event['success']:.3f}"
        if self._bar:
            when = hour_label(hour) if hour is not None else "evening"
            text = f"day {day} · {when} · {node} · F1 so far {self._success}"
            self._bar.update(self._task, description=text, completed=len(self._done))

    def _close_hour(self) -> None:
        if self._now is None:
            return
        day, hour = self._now
        self._done.add(self._now)
        self._now = None
        if self._bar:
            self._bar.update(self._task, completed=len(self._done))
        else:
            done = f"{len(self._done)} of {self._hours} hours"
            self._console.print(f"day {day}, {hour_label(hour)} done ({done}); predicate F1 so far {self._success}")


def days_table(summary: Mapping[str, Any], folder: Path, console: Console | None = None) -> None:
    """Print the days of a run with their success, and where its report is."""
    console = console or PlainConsole(highlight=False)
    title = f"{summary['method']}, setting {summary['setting']}"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for name in ("day", "person", "home"):
        table.add_column(name)
    shown: list[tuple[str, str, str]] = []
    for spec in (one for one in all_measures() if one.at_end):
        shown += [(spec.short or spec.title, spec.name, spec.headline)]
        shown += [(name, spec.name, name) for name in spec.beside]
    for title, _, _ in shown:
        table.add_column(title, justify="right", overflow="fold")
    for day in summary["days"]:
        figures = (figure(day.get(measure, {}).get(name)) for _, measure, name in shown)
        table.add_row(str(day["day"]), day["person"], day["scene"], *figures)
    console.print(table)
    console.print("need F1, precision, recall: what it did against what the person still had to do;", soft_wrap=True)
    console.print("F1 (by the predicate) and judge: over the robot's own candidates, as in the paper;", soft_wrap=True)
    console.print("people: over these, too, by what the person answers in the evening.", soft_wrap=True)
    if summary.get("failed_hours"):
        console.print(f"{summary['failed_hours']} of {summary['hours']} hours failed and are not in these figures.")
    if summary.get("unscored"):
        console.print(f"{summary['unscored']} candidates could not be scored and are not in these figures.")
    if "money" in summary:
        console.print(in_words(summary["money"]), soft_wrap=True)
    report = folder / "report.html"
    console.print(f"Run: {folder}", soft_wrap=True)
    if report.is_file():
        console.print(f"Report: {report}", soft_wrap=True)


def figure(value: float | None) -> str:
    """A rate with three decimals, or a dash where there is none."""
    return "–" if value is None else f"{value:.3f}"
