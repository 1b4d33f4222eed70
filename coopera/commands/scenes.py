"""`coopera scenes`: the homes there are."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import typer

from coopera.commands.options import AsJson

app = typer.Typer(help="The homes there are.", no_args_is_help=True)


@app.command("list")
def list_homes(as_json: AsJson = False) -> None:
    """List the shipped homes and the imported ones."""
    from coopera.tables import print_table
    from simulation.scene import list_scenes

    found = [_figures(_load(scene)) for scene in list_scenes([_imported()])]
    if as_json:
        typer.echo(json.dumps(found))
        return
    print_table(["id", "rooms", "fixed", "movable"], [[str(value) for value in row.values()] for row in found])


@app.command()
def show(
    scene: Annotated[str, typer.Argument(metavar="ID", help="An id from `coopera scenes list`.")],
    as_json: AsJson = False,
) -> None:
    """Show one home: its rooms and what stands in each."""
    from core.household import plain

    home = _load(scene)
    rooms = {room.name: _contents(home, room.name) for room in home.rooms}
    if as_json:
        typer.echo(json.dumps({**_figures(home), "contents": rooms}))
        return
    typer.echo("{id}: {rooms} rooms, {fixed} fixed and {movable} movable objects".format(**_figures(home)))
    for room, things in rooms.items():
        typer.echo(f"\n{room}")
        for kind, names in things.items():
            counts = Counter(plain(name) for name in names)
            shown = ", ".join(name if count == 1 else f"{count} x {name}" for name, count in counts.items())
            typer.echo(f"  {kind}: {shown or 'nothing'}")


@app.command()
def check(
    scene: Annotated[str, typer.Argument(metavar="ID-or-FILE", help="A home's id, or the path of its JSON file.")],
    as_json: AsJson = False,
) -> None:
    """Say whether a home can be used, and if not, why."""
    figures = _figures(_load(scene))
    sentence = "{id}: this home can be used ({rooms} rooms, {fixed} fixed and {movable} movable objects).".format
    typer.echo(json.dumps(figures) if as_json else sentence(**figures))


def _imported() -> Path:
    from coopera.config import default_data_dir

    return default_data_dir() / "scenes"


def _load(scene: str) -> Any:
    from simulation.scene import load_scene

    return load_scene(scene, [_imported()])


def _figures(home: Any) -> dict[str, Any]:
    return {"id": home.id, "rooms": len(home.rooms), "fixed": len(home.fixed), "movable": len(home.movable)}


def _contents(home: Any, room: str) -> dict[str, list[str]]:
    kinds: tuple[Any, ...] = ("fixed", "movable")
    return {kind: [name for name, (_, where) in home.object_map(kind).items() if where == room] for kind in kinds}
