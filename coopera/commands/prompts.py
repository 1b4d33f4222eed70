"""`coopera prompts`: the texts that language models are asked with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.listing import show_rows
from coopera.commands.options import AsJson, PromptFolder
from coopera.commands.rows import prompt_rows
from coopera.core.naming import printable

app = typer.Typer(help="The prompts that language models are asked with.", no_args_is_help=True)


@app.command("list")
def list_prompts(prompts: PromptFolder = None, as_json: AsJson = False) -> None:
    """List the prompts: whose model is asked, how warm, and what the reply must be."""
    columns = ("id", "model_role", "temperature", "reply", "version", "paper")
    heads = ("id", "asks", *columns[2:])
    show_rows(prompt_rows(prompts), columns, as_json=as_json, heads=heads)


@app.command()
def show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A prompt's id, such as human/intention.")],
    filled: Annotated[bool, typer.Option("--filled", help="Fill it with an example, as a model would see it.")] = False,
    prompts: PromptFolder = None,
    as_json: AsJson = False,
) -> None:
    """Show one prompt's file, or what becomes of it."""
    from coopera.prompts import PromptLibrary

    library = PromptLibrary(prompts)
    text = library.show(name, filled=filled)
    typer.echo(json.dumps({"id": name, "file": str(library.path(name)), "text": text}) if as_json else printable(text))


@app.command()
def page(prompts: PromptFolder = None) -> None:
    """Print all prompts on one page of Markdown, each filled with an example and with its length in tokens."""
    from coopera.commands import prompt_page
    from coopera.prompts import PromptLibrary

    typer.echo(printable(prompt_page.page(PromptLibrary(prompts))), nl=False)


@app.command()
def check(
    folder: Annotated[Path | None, typer.Argument(metavar="[DIR]", help="A folder of replacing prompt files.")] = None,
    as_json: AsJson = False,
) -> None:
    """Say whether the prompts of a folder (or the shipped ones) can be used, and if not, why."""
    from coopera.core.errors import ConfigError
    from coopera.prompts import PromptLibrary
    from coopera.prompts import check as faults_of

    faults = faults_of(folder) if folder else []
    count = 0 if faults else len(PromptLibrary(folder).names)
    if as_json:
        typer.echo(json.dumps({"faults": faults, "prompts": count}))
    if faults:
        if not as_json:
            for fault in faults[1:]:
                typer.echo(printable(f"coopera: {fault}"), err=True)
        raise ConfigError(faults[0])
    if not as_json:
        typer.echo(f"{count} prompts can be used.")
