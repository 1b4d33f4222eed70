"""`coopera models`: whether a language model can do what is asked of it, and what a run has asked of its models."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson, BaseUrl, RunPath
from coopera.core.naming import printable

app = typer.Typer(help="The language models that play the person, the robot and the judge.", no_args_is_help=True)


@app.callback()
def models() -> None:
    """The language models that play the person, the robot and the judge."""


@app.command()
def check(
    spec: Annotated[
        str,
        typer.Argument(
            metavar="SPEC",
            help="Such as offline, offline:HOUSEHOLD.yaml, smol, openai:MODEL or huggingface:REPO-OR-FOLDER.",
        ),
    ],
    base_url: BaseUrl = None,
    study: Annotated[
        Path | None, typer.Option(metavar="STUDY.yaml", help="A study file whose `calls` and `household` to use.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Make real calls to a model and report what works: structured replies, names of objects, pictures.

    Keys are taken from the environment (OPENAI_API_KEY, …) and are neither shown nor kept.
    """
    from coopera.checks.model import check_model, in_words
    from coopera.config.schema import load_config
    from coopera.studies.assemble import open_embeddings

    config = load_config(study, {"base_url": base_url})
    with open_embeddings(config) as embeddings:
        backend, tried = check_model(
            spec,
            base_url=config.base_url,
            settings=config.calls,
            embeddings=embeddings,
            homes=[config.data_dir / "scenes"],
            household=config.household,
        )
    works = all(one.ok for one in tried)
    if as_json:
        told = {"model": spec, "base_url": config.base_url, "structure": backend.structure, "ok": works}
        typer.echo(json.dumps({**told, "checks": [one.data() for one in tried]}))
    else:
        typer.echo(printable(str(backend)))
        for one in tried:
            typer.echo(printable(in_words(backend, one)))
    if not works:
        raise typer.Exit(1)


@app.command()
def cost(
    run: RunPath,
    prices: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Prices, if not those that the run was told.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say what a run asked of its models: calls, round trips, tokens, seconds waited, and money where prices are known.

    It goes by the run's trace, so a run that is not finished can be asked, too.
    """
    from coopera.config.prices import in_words, read_prices
    from coopera.report.costs import costs_of
    from coopera.report.costs import in_words as as_table
    from coopera.report.tables import print_table
    from coopera.rundir.directory import RunDir

    found = costs_of(RunDir.open(run), read_prices(prices) if prices else None)
    if as_json:
        typer.echo(json.dumps(found, sort_keys=True))
        return
    print_table(*as_table(found))
    if "money" in found:
        typer.echo(in_words(found["money"]))
