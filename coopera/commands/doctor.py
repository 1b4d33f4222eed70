"""`coopera doctor`: whether a run is whole, and what can be made again from its trace."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from coopera.commands.options import AsJson, RunPath


def doctor(
    run: RunPath,
    repair: Annotated[
        bool, typer.Option("--repair", help="Make again what follows from the trace; what is right is not touched.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Check a run part by part, by its seals and its trace; the exit code is 1 where something is wrong."""
    from coopera.rundir.seals import is_sealed
    from coopera.studies.doctor import examine

    found = examine(run, repair=repair)
    whole, sealed = all(one.mended for one in found), is_sealed(run)
    if as_json:
        told = [one._asdict() for one in found]
        typer.echo(json.dumps({"run": str(run), "whole": whole, "sealed": sealed, "findings": told}))
    else:
        for one in found:
            ended = " – mended" if one.mended else " – not mended" if repair else ""
            typer.echo(f"{one.file}: {one.what}{ended}{': ' if one.note and ended else ''}{one.note if ended else ''}")
        if whole:
            how = "" if sealed else "; it was written without seals, so that alterations cannot be told"
            typer.echo(f"{run}: whole{how}.")
    if not whole:
        raise typer.Exit(1)
