"""Plain tables on standard output."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from coopera.report.console import PlainConsole


def print_table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print rows under their columns, letter by letter; in a pipe, too, nothing is cut off."""
    console = PlainConsole(highlight=False, markup=False)
    if not console.is_terminal:
        console = PlainConsole(highlight=False, markup=False, width=400)
    table = Table(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console.print(table)
