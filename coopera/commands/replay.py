"""`coopera replay`: do a run's acts again and see whether the world comes out the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from coopera.commands.options import AsJson, RunPath
from coopera.core.naming import printable


def replay(
    run: RunPath,
    frames: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Render the first act of each hour into this folder.")
    ] = None,
    day: Annotated[int, typer.Option(min=0, help="The day that --html and --mp4 show.")] = 0,
    html: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Show the day in 3D: one page with a time bar, to send.")
    ] = None,
    mp4: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Film the day: what the robot sees, and what a third person.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Do all acts of a run again from its trace, and compare the home after each hour by its hash; or show a day."""
    from coopera.rundir.directory import RunDir

    if html is not None or mp4 is not None:
        _show(RunDir.open(run), day, html, mp4, as_json)
        return
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


def _show(run: Any, day: int, html: Path | None, mp4: Path | None, as_json: bool) -> None:
    made: list[Any] = []
    if html is not None:
        from coopera.web.replay3d.installed import need_viser

        need_viser()
        from coopera.web.replay3d.page import write_page

        made.append(write_page(run, day, html))
    if mp4 is not None:
        from coopera.web.replay3d.film import write_film

        made.append(write_film(run, day, mp4))
    for one in made:
        if not as_json:
            minutes, seconds = divmod(round(one.seconds), 60)
            typer.echo(printable(f"{one.file}: {one.bytes / 1e6:.1f} MB, {minutes}:{seconds:02d} minutes."))
    if as_json:
        typer.echo(json.dumps([{**one._asdict(), "file": str(one.file)} for one in made]))
