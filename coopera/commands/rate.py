"""`coopera rate`: people verify runs, blind to the method."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coopera.commands.options import HOST, PORT, AsJson, PageHost, PageName, PagePort

if TYPE_CHECKING:
    from coopera.web.common import Door
    from coopera.web.rating.store import Rating

app = typer.Typer(
    help="Human verification: raters say yes or no to what robots proposed, not knowing which robot it was.",
    no_args_is_help=True,
)
Folder = Annotated[Path, typer.Argument(metavar="DIR", help="The folder of a rating.")]


@app.command("begin")
def begin(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="The runs to be rated.")],
    raters: Annotated[int, typer.Option(min=1, max=500, help="How many raters.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder of the rating.")],
    share: Annotated[int, typer.Option(min=1, help="Raters of each hour; two or more tell how far they agree.")] = 2,
    hours: Annotated[int | None, typer.Option(min=1, help="Hours of each run, drawn at random. [default: all]")] = None,
    checks: Annotated[int, typer.Option(min=0, help="An attention check in every so many hours; 0 for none.")] = 3,
    seed: Annotated[int, typer.Option(min=0, help="Hours, raters and orders are drawn from it.")] = 0,
) -> None:
    """Plan a rating: which hours, which rater, which order; `coopera rate open DIR` then shows it."""
    from coopera.evaluation.rating.planning import Sizes
    from coopera.web.rating.store import Rating

    rating = Rating.begin(out, runs, Sizes(raters, min(share, raters), hours, checks), seed)
    tasks = [rating.progress(rater)[1] for rater in rating.plan.order]
    units = len(rating.plan.units)
    typer.echo(f"{units} hours of {len(runs)} runs for {raters} raters, {min(tasks)} to {max(tasks)} tasks each.")
    typer.echo(f"Show it: coopera rate open {out}")


@app.command("open")
def open_rating(folder: Folder, host: PageHost = HOST, port: PagePort = PORT, name: PageName = None) -> None:
    """Show a rating until Ctrl-C: each rater has an address, at which they may stop and go on."""
    from coopera.web.common import Door, serve
    from coopera.web.rating.app import make_rating_app
    from coopera.web.rating.store import Rating

    rating = Rating.open(folder)
    doors: list[Door] = []

    def make(door: Door) -> Any:
        doors.append(door)
        return make_rating_app(rating, door)

    serve(make, Door.opened(host, port, (name,) if name else ()), lambda _: _say_addresses(rating, doors[-1]))
    typer.echo(f"Stopped; nothing is lost. Go on with: coopera rate open {folder}", err=True)


@app.command("results")
def results(
    folder: Folder,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Also write ratings.csv and human_verification.json there.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say what raters found: success by people, its distance from the automatic measures, and their agreement."""
    from coopera.config.files import canonical_json, write_output
    from coopera.evaluation.rating.verified import rows, verified
    from coopera.web.rating.store import Rating

    rating = Rating.open(folder)
    records = rating.records()
    answers = rating.answers()

    def record(run: int, day: int, hour: int) -> Any:
        return records.get((run, day, hour))

    found = verified(rating.plan, record, answers)
    if out is not None:
        write_output(out / "human_verification.json", canonical_json(found))
        write_output(out / "ratings.csv", _as_csv(rows(rating.plan, record, answers)))
    if as_json:
        typer.echo(json.dumps(found, sort_keys=True))
        return
    _show(found)


def _say_addresses(rating: Rating, door: Door) -> None:
    for rater, token in rating.plan.tokens.items():
        answered, of = rating.progress(rater)
        typer.echo(f"{rater} ({answered} of {of}): {door.address(f'/r/{token}')}", err=True)


def _as_csv(found: list[dict[str, Any]]) -> str:
    text = io.StringIO()
    if found:
        table = csv.DictWriter(text, list(found[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(found)
    return text.getvalue()


def _show(found: dict[str, Any]) -> None:
    from coopera.report.progress import figure
    from coopera.report.tables import print_table

    print_table(
        ["run", "method", "hours", "people F1", "precision", "recall"],
        [
            [Path(one["folder"]).name, one["method"], str(one["hours"])]
            + [figure(one["people"][name]) for name in ("f1", "precision", "recall")]
            for one in found["runs"]
        ],
    )
    typer.echo("")
    table = [[one[name] for name in ("measure", "method", "setting", "hours", "l1", "paper")] for one in found["l1"]]
    print_table(
        ["L1 to people", "method", "setting", "hours", "here", "paper"],
        [[*map(str, row[:4]), *map(figure, row[4:])] for row in table],
    )
    typer.echo("")
    print_table(
        ["rater", "answered", "skipped", "attention checks"],
        [
            [
                rater,
                f"{of['answered']} of {of['items']}",
                str(of["skipped"]),
                f"{of['checks_passed']} of {of['checks']}",
            ]
            for rater, of in found["raters"].items()
        ],
    )
    agreed = found["agreement"]
    fleiss, kappa = figure(agreed["fleiss"]), figure(agreed["cohen_mean"])
    typer.echo(
        f"\nAgreement over {agreed['items']} tasks: Krippendorff's alpha {figure(agreed['krippendorff'])}, "
        f"Fleiss' kappa {fleiss} ({agreed['fleiss_items']} tasks), mean of Cohen's kappas {kappa}."
    )
