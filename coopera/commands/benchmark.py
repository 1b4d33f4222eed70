"""`coopera benchmark`: a grid of methods, settings and seeds, and what came of it."""

from __future__ import annotations

import json
import time
from contextlib import closing, nullcontext
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import Annotated, Any

import typer

from coopera.commands.options import STOPPED, AsJson, BaseUrl, Model, PromptFolder, as_list, nested, option
from coopera.core.naming import printable

FLAGS = "--methods, --settings, --collab, --seeds, --humans, --scenes, --episodes, --days, --hours"


def benchmark(
    grid: Annotated[Path | None, typer.Argument(metavar="[GRID.yaml]", help="A grid file; flags win.")] = None,
    methods: Annotated[
        str | None, typer.Option(metavar="NAME,…|all", help="Methods. [see: coopera list methods; default: ours]")
    ] = None,
    settings: Annotated[
        str | None, typer.Option(metavar="1,…", help="1 to 4, 3+1, or those of the grid file. [default: 1]")
    ] = None,
    collab: Annotated[str | None, typer.Option(metavar="1,2", help="Collaboration types. [default: 2]")] = None,
    seeds: Annotated[int | None, typer.Option(help="How many seeds, from 0. [default: 1]")] = None,
    humans: Annotated[
        str | None,
        typer.Option(
            "--humans",
            "--people",
            metavar="ID-or-FILE,…|N",
            help="People, or how many. [see: coopera list people; default: all there are]",
        ),
    ] = None,
    scenes: Annotated[
        str | None,
        typer.Option(
            metavar="ID-or-FILE,…|N", help="Homes, or how many. [see: coopera list homes; default: all there are]"
        ),
    ] = None,
    episodes: Annotated[int | None, typer.Option(help="Episodes of each setting. [default: as the paper]")] = None,
    days: Annotated[int | None, option("days")] = None,
    hours: Annotated[int | None, option("hours")] = None,
    household: Annotated[str | None, option("household")] = None,
    with_shared: Annotated[
        str | None,
        typer.Option(metavar="NAME,…|all|none", help="Run with shared common sense, too. [default: the reference]"),
    ] = None,
    noise: Annotated[
        int | None,
        typer.Option(help="How often the reference meets the same days again, its models sampled anew. [default: 0]"),
    ] = None,
    workers: Annotated[int, typer.Option(min=1, max=256, help="Processes on this machine.")] = 1,
    ray: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Ray cluster; `local` starts one here. [default: none]")
    ] = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="The benchmark's folder; run again, it goes on.")] = Path(
        "runs/benchmark"
    ),
    limit: Annotated[
        float | None, typer.Option(metavar="MINUTES", help="Start no run after so many minutes. [default: no limit]")
    ] = None,
    model: Model = None,
    base_url: BaseUrl = None,
    prompts: PromptFolder = None,
    classifier: Annotated[str | None, option("classifier")] = None,
    power: Annotated[
        bool, typer.Option("--power", help="Run nothing: simulate what this grid would find, and what it would not.")
    ] = False,
    scatter: Annotated[
        Path | None,
        typer.Option(metavar="RESULTS", help="Results whose scatter --power takes. [default: a stated one]"),
    ] = None,
    restate: Annotated[
        bool, typer.Option("--restate", help="Change the endpoint although runs have begun; the results will say so.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Run methods on the same days of the same people, and write tables, figures and statistics.

    Each run has a folder of its own and is picked up where it was left; a run that is done is not done again.
    """
    from coopera.benchmark import grid_runs as bench

    flags = {
        "methods": _methods(methods),
        "settings": as_list(settings),
        "collab": _numbers("--collab", collab),
        "seeds": seeds,
        "humans": _some(humans),
        "scenes": _some(scenes),
        "episodes": episodes,
        "days": days,
        "hours": hours,
        "noise": noise,
        "with_shared": {"all": "all", "none": []}.get(with_shared or "", as_list(with_shared)),
    }
    found = bench.load_grid(grid, flags)
    shared = nested(
        {"models": model, "base_url": base_url, "prompts": prompts, "classifier": classifier, "household": household}
    )
    planned = bench.plan(found, out, bench.shared_config(found, grid, shared))
    if power or scatter:
        _foresee(planned, scatter, as_json=as_json)
        return
    with bench.claimed_folder(planned, restate=restate) as stated:
        typer.echo(f"Endpoint stated {stated.time}, SHA-256 {stated.sha256}.", err=True)
        Thread(target=_load_results, daemon=True).start()  # while the workers begin
        failures = carry_out_in_words(planned, workers=workers, ray=ray, limit=limit)
        from coopera.benchmark.results_files import write_results

        summary = write_results(planned)
    if as_json:
        typer.echo(json.dumps({**summary, "failed": failures, "left": len(planned.left)}, sort_keys=True))
    else:
        typer.echo(f"Results: {summary['page']}")
    if failures:
        raise typer.Exit(1)


def _load_results() -> None:
    """Import what the results are made with: a second that would else come after the last run."""
    for name in ("coopera.benchmark.results_files", "matplotlib.backends.backend_svg"):
        import_module(name)


def _foresee(planned: Any, scatter: Path | None, *, as_json: bool) -> None:
    from coopera.benchmark import foresight
    from coopera.report.tables import print_table

    found = foresight.foresight(planned, scatter)
    if as_json:
        typer.echo(json.dumps(foresight.as_json(found), sort_keys=True))
        return
    print_table(*foresight.as_table(found))
    for line in foresight.in_words(found):
        typer.echo(line)


def carry_out_in_words(planned: Any, *, workers: int, ray: str | None, limit: float | None) -> dict[str, str]:
    """Work through what is left with a line per run; returns the runs that failed, with the reason."""
    from coopera.benchmark.grid_runs import carry_out
    from coopera.rundir.stopping import ends_soon

    def farewell() -> None:
        typer.echo(printable(f"Stopped. Run the same command again to go on: {planned.root}"), err=True)

    total, left = len(planned.jobs), len(planned.left)
    typer.echo(f"{total} runs, {total - left} of them done already.", err=True)
    started, done, failures = time.monotonic(), total - left, dict[str, str]()
    ends = carry_out(planned, workers=workers, ray=ray, deadline=started + 60 * limit if limit else None)
    try:
        # a cluster's processes are to be gone, too, which takes Ray some seconds
        with nullcontext() if ray else ends_soon(STOPPED, farewell), closing(ends):
            for end in ends:
                done += 1
                what = f"failed: {end.error}" if end.error else "done"
                if end.error:
                    failures[end.job.name] = end.error
                said = f"{done} of {total} ({time.monotonic() - started:.0f} s): {end.job.name} {what}"
                typer.echo(printable(said), err=True)
    except KeyboardInterrupt:
        farewell()
        raise typer.Exit(STOPPED) from None
    return failures


def _methods(text: str | None) -> list[str] | None:
    if text != "all":
        return as_list(text)
    from coopera.evaluation import METHODS

    return [name for name, method in METHODS.items() if method.robot and not method.swapped]


def _numbers(flag: str, text: str | None) -> list[int] | None:
    try:
        return None if text is None else [int(part) for part in as_list(text) or []]
    except ValueError:
        raise typer.BadParameter(f"must be numbers such as 1,2, not {text!r}", param_hint=flag) from None


def _some(text: str | None) -> list[str] | int | None:
    return int(text) if text is not None and text.isdigit() else as_list(text)
