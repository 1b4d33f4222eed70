"""`coopera list`: what there is to choose from, as a table or as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Annotated

import typer

from coopera.commands.options import AsJson
from coopera.commands.rows import Kind, Rows, rows_of
from coopera.core.naming import printable


def list_what(
    kind: Annotated[Kind, typer.Argument(metavar="WHAT", help="What to list.")],
    as_json: AsJson = False,
) -> None:
    """List what there is to choose from, with a line about each."""
    show_rows(rows_of(kind), ("id", "about"), as_json=as_json)


def show_rows(rows: Rows, columns: Sequence[str], *, as_json: bool, heads: Sequence[str] = ()) -> None:
    """Print rows as a table of some columns, under their names or other `heads`, or all of them as one line of JSON."""
    if as_json:
        typer.echo(printable(json.dumps(rows, ensure_ascii=False)))
        return
    from coopera.report.tables import print_table

    print_table(heads or columns, [[str(row[column]) for column in columns] for row in rows])
