"""`coopera leaderboard` and `coopera export`: what groups give to each other."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson, RunPath


def leaderboard(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder with results folders, at any depth.")],
    as_json: AsJson = False,
) -> None:
    """Check all results below a folder and rank their methods by need F1, mean of the late days."""
    from coopera.benchmark.leaderboard import entries
    from coopera.report.progress import figure
    from coopera.report.tables import print_table

    found = entries(folder)
    if as_json:
        typer.echo(json.dumps([one._asdict() for one in found], sort_keys=True))
        return
    columns = ["setting", "type", "method", "results", "models", "need F1", "95 % interval"]
    columns += ["F1, last day", "95 % interval", "people", "n"]
    print_table(
        columns,
        [
            [
                one.setting,
                str(one.collab),
                one.method,
                one.results,
                "offline" if one.offline else "language models",
                figure(one.need),
                _interval(one.need_low, one.need_high),
                figure(one.success),
                _interval(one.low, one.high),
                str(one.people),
                str(one.n),
            ]
            for one in found
        ],
    )


def _interval(low: float | None, high: float | None) -> str:
    from coopera.evaluation.statistics import TOO_SMALL

    return TOO_SMALL if low is None or high is None else f"[{low:.3f}, {high:.3f}]"


def export(
    run: RunPath,
    out: Annotated[Path, typer.Option(metavar="DIR", help="A new folder.")],
    views: Annotated[
        str,
        typer.Option(
            metavar="depth,instances,classes",
            help="What to write of each picture besides its colours (DIR/views): the acts are done again for it.",
        ),
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Write a run's days as a Hugging Face data set (DIR/hours) and as LeRobot-style episodes (DIR/episodes)."""
    from coopera.rundir.directory import RunDir
    from coopera.rundir.export import export as write
    from coopera.studies.seen import export_views, kinds_of

    kinds, source = kinds_of(views), RunDir.open(run)
    made = write(source, out)
    if kinds:
        made["views"] = export_views(source, out / "views", kinds)
    if as_json:
        typer.echo(json.dumps(made, sort_keys=True))
    else:
        typer.echo(f"{made['hours']} hours and {made['episodes']} episodes of {made['frames']} frames: {made['out']}")
        if kinds:
            typer.echo(f"{made['views']} views ({', '.join(kinds)}): {out / 'views'}")
