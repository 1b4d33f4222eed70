"""`coopera view`: runs and benchmarks of a folder in the browser."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson


def view(
    folder: Annotated[
        Path, typer.Argument(metavar="[DIR]", help="A folder of runs and benchmarks, or one of either.")
    ] = Path("runs"),
    port: Annotated[int, typer.Option(help="The port to listen on; 0 takes any that is free.")] = 8765,
    host: Annotated[
        str, typer.Option(help="The address to listen on; on another than this machine's own, a token is needed.")
    ] = "127.0.0.1",
    static: Annotated[
        Path | None, typer.Option(metavar="OUT", help="Write the pages as files into this folder, and serve nothing.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Look into runs in the browser: every hour with its pictures, prompts and replies, and two runs side by side."""
    if static is not None:
        from coopera.web.view.export import export

        made = export(folder, static)
        told = {"index": str(made.start), "pages": made.pages, "bytes": made.size}
        typer.echo(json.dumps(told) if as_json else f"{made.pages} pages, {made.size / 1e6:.1f} MB: {made.start}")
        return
    from functools import partial

    from coopera.web.common import Door, serve
    from coopera.web.view.app import viewer
    from coopera.web.view.shelf import Shelf

    Shelf(folder)  # a folder that is none is told before the server starts

    def say(address: str) -> None:
        typer.echo(json.dumps({"address": address}) if as_json else f"{address} shows {folder} (Ctrl-C ends it).")

    serve(partial(viewer, folder), Door.opened(host, port), say)
