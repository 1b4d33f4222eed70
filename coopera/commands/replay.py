"""`coopera replay`: do a run's acts again and see whether the world comes out the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson, RunPath
from coopera.core.naming import printable


def replay(
    run: RunPath,
    frames: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Render the first act of each hour into this folder.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Do all acts of a run again from its trace, and compare the home after each hour by its hash."""
    from coopera.rundir.directory import RunDir
    from coopera.studies.replay import film_into
    from coopera.studies.replay import replay as replay_run

    found = RunDir.open(run)
    look = film_into(frames, found.config.frames) if frames is not None else None
    hours = list(replay_run(found, look))
    different = [hour for hour in hours if hour.difference]
    if not as_json:
        for hour in different:
            typer.echo(printable(f"Day {hour.day}, {hour.hour}:00: {hour.difference}."))
        acts = sum(hour.acts for hour in hours)
        typer.echo(f"{len(hours) - len(different)} of {len(hours)} hours ({acts} acts) ended in the same world.")
    else:
        differences = [{"day": h.day, "hour": h.hour, "difference": h.difference} for h in different]
        typer.echo(json.dumps({"hours": len(hours), "same": len(hours) - len(different), "differences": differences}))
    if different:
        raise typer.Exit(1)
