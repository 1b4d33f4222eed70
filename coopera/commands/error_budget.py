"""`coopera analyse robot`: where a robot's help is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson


def analyse_robot(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Run directories.")],
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Also write error-budget.csv and error-budget.json there. [default: nothing]"),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say where each task was lost that the robot did not help with, and why its help was of no use.

    From the traces alone, by method and by day. Hours that failed, without a robot, or away from home are left out.
    """
    from coopera.core.errors import ConfigError
    from coopera.evaluation.robot.error_budget import pool
    from coopera.report.budget import as_data, day_rows, in_words, of_method, read_budget, write_budget
    from coopera.report.tables import print_table
    from coopera.rundir.directory import RunDir

    found = [read_budget(RunDir.open(run)) for run in runs]
    if not any(one.total.hours for one in found):
        raise ConfigError(f"{runs[0]}: no robot has helped in any hour of these runs, so there is nothing to analyse.")
    if out:
        write_budget(found, out)
    if as_json:
        typer.echo(json.dumps(as_data(found) | ({"out": str(out)} if out else {}), sort_keys=True))
        return
    for method in dict.fromkeys(one.method for one in found):
        days = of_method(found, method)
        typer.echo(f"{method}: {len(days)} days, {pool(day.budget for day in days).hours} hours with a robot")
        print_table(*in_words(pool(day.budget for day in days)))
        typer.echo("\nBy day, in percent of the missed tasks and in the order above; `false`: acts of no use")
        print_table(*day_rows(days))
    if out:
        typer.echo(f"Results: {out}/error-budget.csv, error-budget.json")
