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
    At the end it says where predicate, judge, the person's own answers and similarity differ about the same offers.
    """
    from coopera.core.errors import ConfigError
    from coopera.evaluation.measuring import told_in_the_evening
    from coopera.evaluation.robot.error_budget import pool
    from coopera.report.budget import as_data, day_rows, in_words, of_method, read_budget, write_budget
    from coopera.report.differing import as_data as differences
    from coopera.report.differing import offers_of, pair_rows, pattern_rows
    from coopera.report.tables import print_table
    from coopera.rundir.directory import RunDir

    opened = [RunDir.open(run) for run in runs]
    found = [read_budget(run) for run in opened]
    if not any(one.total.hours for one in found):
        raise ConfigError(f"{runs[0]}: no robot has helped in any hour of these runs, so there is nothing to analyse.")
    if out:
        write_budget(found, out)
    methods = list(dict.fromkeys(one.method for one in found))
    lived = [(run.config.method, told_in_the_evening(run.hours(), run.evenings())) for run in opened]
    offers = {name: offers_of(hour for method, hours in lived if method == name for hour in hours) for name in methods}
    if as_json:
        said = as_data(found) | {"differences": {method: differences(offers[method]) for method in methods}}
        typer.echo(json.dumps(said | ({"out": str(out)} if out else {}), sort_keys=True))
        return
    for method in methods:
        days = of_method(found, method)
        typer.echo(f"{method}: {len(days)} days, {pool(day.budget for day in days).hours} hours with a robot")
        print_table(*in_words(pool(day.budget for day in days)))
        typer.echo("\nBy day, in percent of the missed tasks and in the order above; `false`: acts of no use")
        print_table(*day_rows(days))
        typer.echo("\nWhere the measures differ: offers that help, by two of them at a time")
        print_table(*pair_rows(offers[method]))
        typer.echo("\nWho says that an offer helps, where not all say the same")
        print_table(*pattern_rows(offers[method]))
    if out:
        typer.echo(f"Results: {out}/error-budget.csv, error-budget.json")
