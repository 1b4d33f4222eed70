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
    """Check all results below a folder and rank their methods by predicate F1 on people's last days."""
    from coopera.benchmark.leaderboard import entries
    from coopera.report.progress import figure
    from coopera.report.tables import print_table

    found = entries(folder)
    if as_json:
        typer.echo(json.dumps([one._asdict() for one in found], sort_keys=True))
        return
    columns = ["setting", "type", "method", "results", "models", "success", "95 % interval", "help", "people", "n"]
    print_table(
        columns,
        [
            [
                one.setting,
                str(one.collab),
                one.method,
                one.results,
                "offline" if one.offline else "language models",
                figure(one.success),
                f"[{one.low:.3f}, {one.high:.3f}]",
                figure(one.help),
                str(one.people),
                str(one.n),
            ]
            for one in found
        ],
    )


def export(
    run: RunPath,
    out: Annotated[Path, typer.Option(metavar="DIR", help="A new folder.")],
    as_json: AsJson = False,
) -> None:
    """Write a run's days as a Hugging Face data set (DIR/hours) and as LeRobot-style episodes (DIR/episodes)."""
    from coopera.rundir.directory import RunDir
    from coopera.rundir.export import export as write

    made = write(RunDir.open(run), out)
    if as_json:
        typer.echo(json.dumps(made, sort_keys=True))
    else:
        typer.echo(f"{made['hours']} hours and {made['episodes']} episodes of {made['frames']} frames: {made['out']}")
