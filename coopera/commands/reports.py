"""`coopera trace` and `coopera report`: look inside a run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson, RunPath


def trace(
    run: RunPath,
    day: Annotated[int | None, typer.Option(min=0, help="Only this day, counted from 0. [default: all]")] = None,
    hour: Annotated[
        int | None, typer.Option(min=0, max=23, help="Only this hour of day, such as 9 or 14. [default: all]")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print hours of a run as readable trees, from its trace files alone."""
    from coopera.report.tree import print_json, print_trees
    from coopera.rundir.directory import RunDir

    found = RunDir.open(run)
    _warn(run)
    (print_json if as_json else print_trees)(found, day, hour)


def report(run: RunPath, as_json: AsJson = False) -> None:
    """Write RUN/report.html anew, from the run's files alone."""
    import json

    from coopera.report.page import write_report
    from coopera.rundir.directory import RunDir
    from coopera.rundir.private import only_mine

    found = RunDir.open(run)
    _warn(run)
    with only_mine(found.config.private):
        path = write_report(found)
    typer.echo(json.dumps({"report": str(path), "bytes": path.stat().st_size}) if as_json else f"Report: {path}")


def _warn(run: Path) -> None:
    """Say in one line where something of the run is missing or altered, and go on."""
    from coopera.rundir.seals import in_one_line

    if odd := in_one_line(run):
        typer.echo(f"coopera: {odd}", err=True)
