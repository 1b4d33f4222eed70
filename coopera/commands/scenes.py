"""`coopera scenes`: the homes there are, and how to look at, check, make and bring in homes."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import typer

from coopera.commands.listing import show_rows
from coopera.commands.options import AsJson, DataFolder
from coopera.commands.rows import rows_of
from coopera.core.errors import ConfigError
from coopera.core.naming import printable

app = typer.Typer(help="The homes there are.", no_args_is_help=True)
Home = Annotated[str, typer.Argument(metavar="ID-or-FILE", help="A home's id, or the path of its JSON file.")]
Png = Annotated[Path | None, typer.Option(metavar="FILE", help="Write a picture.")]
Force = Annotated[bool, typer.Option("--force", help="Replace homes that are there already.")]


@app.command("list")
def list_homes(as_json: AsJson = False) -> None:
    """List the shipped homes and the imported ones."""
    show_rows(rows_of("homes"), ("id", "rooms", "fixed", "movable"), as_json=as_json)


@app.command()
def show(
    scene: Home,
    png: Png = None,
    room: Annotated[str | None, typer.Option(metavar="NAME", help="Draw this room from inside.")] = None,
    as_json: AsJson = False,
) -> None:
    """Show one home: its rooms and what stands in each; with --png also from above, or a --room from inside."""
    from coopera.core.household import plain
    from coopera.homes.stored import figures, write_picture

    home = _load(scene)
    if png is not None:
        from coopera.simulation.making.overview import inside, overview

        write_picture(png, inside(home, room) if room else overview(home))
    rooms = {room.name: _contents(home, room.name) for room in home.rooms}
    if as_json:
        typer.echo(json.dumps({**figures(home), "contents": rooms, "png": str(png) if png else None}))
        return
    typer.echo("{id}: {rooms} rooms, {fixed} fixed and {movable} movable objects".format(**figures(home)))
    for room, things in rooms.items():
        typer.echo(f"\n{room}")
        for kind, names in things.items():
            counts = Counter(plain(name) for name in names)
            shown = ", ".join(name if count == 1 else f"{count} x {name}" for name, count in counts.items())
            typer.echo(f"  {kind}: {shown or 'nothing'}")
    if png is not None:
        typer.echo(f"\nPicture: {png}")


@app.command()
def check(scene: Home, as_json: AsJson = False) -> None:
    """Say whether everything in a home can be walked up to and taken, and if not, what cannot (exit code 1)."""
    from coopera.homes.stored import figures
    from coopera.simulation.making.proof import prove as problems_of

    home = _load(scene)
    problems = problems_of(home)
    if as_json:
        typer.echo(json.dumps({**figures(home), "problems": problems}))
    else:
        sentence = "{id}: this home can be used ({rooms} rooms, {fixed} fixed and {movable} movable objects)."
        for line in problems or [sentence.format(**figures(home))]:
            typer.echo(printable(line))
    if problems:
        raise typer.Exit(1)


@app.command()
def generate(
    rooms: Annotated[
        int | None, typer.Option(metavar="N", help="How many rooms. [default: 7; of each with --count, 3 to 11]")
    ] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="The same seed gives the same home.")] = 0,
    id: Annotated[
        str | None, typer.Option(metavar="ID", help="Its id. [default: home-<rooms>-<seed>; with --count, home]")
    ] = None,
    things: Annotated[
        int | None, typer.Option(metavar="N", help="How many movable things. [default: 8.5 for each room]")
    ] = None,
    count: Annotated[
        int | None, typer.Option(metavar="N", help="Make so many different homes, <id>-0000 on, and a card of them.")
    ] = None,
    out: DataFolder = None,
    png: Png = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Make a home from a seed, or with --count many that differ, and store them, so that their ids work everywhere."""
    from coopera.homes.generated import Wanted, make_many, make_one
    from coopera.homes.stored import figures

    if count is not None:
        if png is not None:
            raise ConfigError("--png: a picture is drawn of one home; leave --count out, or use `coopera scenes show`.")
        wanted = Wanted(rooms, things)
        made = make_many(count, seed, id or "home", _scenes(out), wanted=wanted, force=force, say=_progress)
        if as_json:
            typer.echo(json.dumps({"card": str(made.card), "homes": [figures(home) for home in made.homes]}))
            return
        typer.echo(f"{len(made.homes)} homes: {made.files[0]} to {made.files[-1].name}")
        typer.echo(f"Card: {made.card}")
        return
    rooms = 7 if rooms is None else rooms
    home, file, problems = make_one(rooms, seed, id or f"home-{rooms}-{seed}", _scenes(out), things=things, force=force)
    if png is not None:
        from coopera.homes.stored import write_picture
        from coopera.simulation.making.overview import overview

        write_picture(png, overview(home))
    if as_json:
        typer.echo(json.dumps({**figures(home), "file": str(file), "problems": problems}))
        return
    typer.echo("{id}: {rooms} rooms, {fixed} fixed and {movable} movable objects".format(**figures(home)))
    for line in problems:
        typer.echo(line)
    typer.echo(f"Stored: {file}")


def _progress(line: str) -> None:
    typer.echo(line, err=True)


@app.command("import")
def import_homes(
    path: Annotated[
        Path,
        typer.Argument(
            metavar="PATH",
            help="A folder of HSSD or in Habitat's layout, one *.scene_instance.json, a house of ProcTHOR, or a home.",
        ),
    ],
    scene: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="A scene of the folder; may be repeated. [default: all]")
    ] = None,
    out: DataFolder = None,
    skip_missing: Annotated[
        bool, typer.Option("--skip-missing", help="Leave out what refers to a missing file.")
    ] = False,
    assets: Annotated[
        Path | None, typer.Option(metavar="FILE", help="ProcTHOR's asset-database.json: how large its objects are.")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Bring in homes of Habitat or ProcTHOR, or one that you wrote (docs/scenes.md); say what was guessed, left out."""
    from coopera.homes.stored import bring_in, figures

    found = bring_in(path, _scenes(out), scenes=scene or (), skip_missing=skip_missing, force=force, assets=assets)
    if as_json:
        rows = [{**figures(one.scene), "file": str(one.file), **one.told._asdict()} for one in found]
        typer.echo(json.dumps(rows))
        return
    for one in found:
        typer.echo("{id}: {rooms} rooms, {fixed} fixed and {movable} movable objects".format(**figures(one.scene)))
        for line in one.told.lines():
            typer.echo(printable(f"  {line}"))
        typer.echo(f"  Stored: {one.file}")


@app.command()
def statistics(
    scenes: Annotated[list[str] | None, typer.Argument(metavar="[ID]…", help="Homes. [default: the shipped]")] = None,
    png: Png = None,
    as_json: AsJson = False,
) -> None:
    """Count rooms, and objects by super-category, as the paper shows its scenes."""
    from coopera.homes.statistics import draw
    from coopera.homes.stored import figures
    from coopera.report.tables import print_table
    from coopera.simulation.homes.scene import list_scenes

    homes = [_load(scene) for scene in scenes or list_scenes()]
    found = [figures(home) for home in homes]
    if png is not None:
        draw(homes, png)
    if as_json:
        typer.echo(json.dumps(found))
        return
    kinds = sorted({kind for row in found for kind in row["categories"]})
    table = [[name, *(str(row[name]) for row in found)] for name in ("rooms", "square_metres", "fixed", "movable")]
    table += [[kind, *(str(row["categories"].get(kind, 0)) for row in found)] for kind in kinds]
    print_table(["", *(row["id"] for row in found)], [[line[0].replace("_", " "), *line[1:]] for line in table])


@app.command()
def schema() -> None:
    """Print the JSON schema of a home's file, for those who write one by hand."""
    from coopera.simulation.homes.scene import Scene

    typer.echo(json.dumps(Scene.model_json_schema(), indent=2))


def _imported() -> Path:
    return _scenes(None)


def _scenes(folder: Path | None) -> Path:
    from coopera.config.schema import default_data_dir

    return (folder or default_data_dir()) / "scenes"


def _load(scene: str) -> Any:
    from coopera.simulation.homes.scene import load_scene

    return load_scene(scene, [_imported()])


def _contents(home: Any, room: str) -> dict[str, list[str]]:
    kinds: tuple[Any, ...] = ("fixed", "movable")
    return {kind: [name for name, (_, where) in home.object_map(kind).items() if where == room] for kind in kinds}
