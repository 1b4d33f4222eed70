"""`coopera leaderboard`, `coopera recheck` and `coopera export`: what groups give to each other."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from coopera.commands.options import AsJson, BaseUrl, PromptFolder, RunPath, nested
from coopera.core.errors import RunError

Secret = Annotated[
    Path | None, typer.Option("--secret", metavar="FILE", help="The board keeper's secret, 16 bytes or more.")
]


def leaderboard(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder with results folders, at any depth.")],
    secret: Secret = None,
    as_json: AsJson = False,
) -> None:
    """Check all results below a folder and rank their methods, among the same person, judge, household and model."""
    from itertools import groupby

    from coopera.benchmark.checked import read_secret
    from coopera.benchmark.leaderboard import entries
    from coopera.report.progress import figure
    from coopera.report.tables import print_table

    found = entries(folder, read_secret(secret) if secret else None)
    if as_json:
        typer.echo(json.dumps([{**one._asdict(), "terms": one.terms._asdict()} for one in found], sort_keys=True))
        return
    columns = ["method", "results", "endpoint", "95 % interval", "noise", "stated", "hidden seeds"]
    columns += ["F1, last day", "95 % interval", "people", "n", "code", "prompts"]
    for terms, group in groupby(found, key=lambda one: one.terms):
        typer.echo(f"{terms}:")
        print_table(
            columns,
            [
                [
                    f"{one.method}{' (tied)' if one.tied else ''}",
                    one.results,
                    figure(one.score),
                    _interval(one.low, one.high),
                    figure(one.noise),
                    {True: "kept", False: "CHANGED", None: "not noted"}[one.kept],
                    one.hidden if secret or one.hidden == "not checked" else f"{one.hidden} (claimed)",
                    figure(one.success),
                    _interval(one.success_low, one.success_high),
                    str(one.people),
                    str(one.n),
                    f"{one.code}{' MIXED' if 'code' in one.mixed else ''}",
                    f"{one.prompts}{' MIXED' if 'prompts' in one.mixed else ''}",
                ]
                for one in group
            ],
        )
        typer.echo()


def recheck(
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="The results folder of a submission.")],
    secret: Annotated[Path, typer.Option(metavar="FILE", help="The board keeper's secret, 16 bytes or more.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="The keeper's folder for the runs; run again, it goes on.")],
    seeds: Annotated[int, typer.Option(min=2, max=100, help="How many hidden seeds.")] = 2,
    workers: Annotated[int, typer.Option(min=1, max=256, help="Processes on this machine.")] = 1,
    base_url: BaseUrl = None,
    prompts: PromptFolder = None,
    as_json: AsJson = False,
) -> None:
    """Run a submission again on seeds that only the board's keeper can know, and compare within the noise."""
    from coopera.benchmark.checked import read_secret, write_check
    from coopera.benchmark.grid_runs import claimed_folder
    from coopera.benchmark.recheck import check_again, plan_again
    from coopera.benchmark.results_page import read_results
    from coopera.commands.benchmark import carry_out_in_words
    from coopera.report.tables import print_table

    key = read_secret(secret)
    card, rows = read_results(results)
    planned = plan_again(card, rows, out, key, seeds=seeds, flags=nested({"base_url": base_url, "prompts": prompts}))
    with claimed_folder(planned):
        if failures := carry_out_in_words(planned, workers=workers, ray=None, limit=None):
            raise RunError(f"{out}: {len(failures)} runs failed, so nothing can be compared.")
        check = check_again(card, rows, planned)
    path = write_check(results, check, key)
    if as_json:
        said = [{**one.model_dump(), "agrees": one.agrees} for one in check.compared]
        typer.echo(json.dumps({"agrees": check.agrees, "differ": check.differ, "compared": said, "check": str(path)}))
    else:
        columns = ["setting", "type", "method", "submitted", "hidden seeds", "may differ by", "verdict"]
        figures = [[f"{value:.3f}" for value in (one.submitted, one.hidden, one.floor)] for one in check.compared]
        print_table(
            columns,
            [
                [one.setting, str(one.collab), one.method, *each, "agrees" if one.agrees else "DIFFERS"]
                for one, each in zip(check.compared, figures, strict=True)
            ],
        )
        for name in check.differ:
            typer.echo(f"The keeper's {name} is another than the submission's.")
        typer.echo(f"Check: {path}")
    if not check.agrees:
        raise typer.Exit(1)


def _interval(low: float | None, high: float | None) -> str:
    from coopera.evaluation.statistics import TOO_SMALL

    return TOO_SMALL if low is None or high is None else f"[{low:.3f}, {high:.3f}]"


def export(
    run: RunPath,
    out: Annotated[Path, typer.Option(metavar="DIR", help="A new folder.")],
    views: Annotated[
        str,
        typer.Option(
            metavar="depth,instances,classes",
            help="What to write of each picture besides its colours (DIR/views): the acts are done again for it.",
        ),
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Write a run's days as Hugging Face data set (DIR/hours), LeRobot-style episodes (DIR/episodes) and Croissant."""
    from coopera.rundir.directory import RunDir
    from coopera.rundir.export import export as write
    from coopera.studies.seen import export_views, kinds_of

    kinds, source = kinds_of(views), RunDir.open(run)
    made = write(source, out)
    if kinds:
        made["views"] = export_views(source, out / "views", kinds)
    if as_json:
        typer.echo(json.dumps(made, sort_keys=True))
    else:
        typer.echo(f"{made['hours']} hours and {made['episodes']} episodes of {made['frames']} frames: {made['out']}")
        if kinds:
            typer.echo(f"{made['views']} views ({', '.join(kinds)}): {out / 'views'}")
