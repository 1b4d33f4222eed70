"""`coopera memory`: care of a run's memory."""

from __future__ import annotations

import json

import typer

from coopera.commands.options import AsJson, RunPath

app = typer.Typer(help="Care of a run's memory.", no_args_is_help=True)


@app.callback()
def _group() -> None:
    """Keep `repair` a sub-command though it is the only one."""


@app.command()
def repair(run: RunPath, as_json: AsJson = False) -> None:
    """Check a run's memory and rebuild it from its texts where its index is damaged."""
    from coopera.memory import repair as rebuild
    from coopera.rundir.directory import RunDir
    from coopera.rundir.private import only_mine
    from coopera.studies.assemble import open_embeddings

    folder = run / "memory"
    config = RunDir.open(run).config
    with only_mine(config.private), open_embeddings(config) as embeddings:
        done = rebuild(folder, embeddings)
    if as_json:
        typer.echo(json.dumps({"run": str(run), "repaired": [one._asdict() for one in done]}))
        return
    for one in done:
        lost = f", {one.missing} lost" if one.missing else ""
        changed = f", {one.altered} altered since they were written" if one.altered else ""
        typer.echo(f"{one.stream}: {one.records} records rebuilt{lost}{changed}")
    typer.echo(f"{folder}: rebuilt; the damaged store is kept beside it." if done else f"{folder}: nothing is damaged.")
