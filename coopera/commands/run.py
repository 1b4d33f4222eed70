"""`coopera run` and `coopera resume`."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coopera.commands.options import (
    HOST,
    PORT,
    STOPPED,
    AsJson,
    CallBudget,
    MoneyBudget,
    PageHost,
    PageName,
    PagePort,
    RunPath,
    TokenBudget,
    nested,
    takes_settings,
)
from coopera.core.errors import BudgetError, CooperaError, StoppedError
from coopera.core.naming import printable

if TYPE_CHECKING:
    from coopera.config.schema import Config
    from coopera.graphs.players.real_person import Interview
    from coopera.studies.events import Event


@takes_settings
def run(
    study: Annotated[Path | None, typer.Argument(metavar="[STUDY.yaml]", help="A study file; flags win.")] = None,
    *,
    flags: dict[str, Any],
    estimate: Annotated[
        bool, typer.Option("--estimate", help="Only say how many calls and tokens the run would take.")
    ] = False,
    host: PageHost = HOST,
    port: PagePort = PORT,
    name: PageName = None,
    as_json: AsJson = False,
) -> None:
    """Let people live their days while a robot learns to help them."""
    from coopera.config.schema import load_config
    from coopera.studies.catalogues import resolve

    chosen = load_config(study or _recorded(flags.get("models", {})), flags)
    config = resolve(chosen)
    assert config.out is not None  # resolve sets it
    if chosen.renderer == "auto" and config.renderer == "tiny":
        from coopera.simulation.drawing.context import problem

        typer.echo(printable(f"Pictures are drawn by tiny, without shadows: {problem()}."), err=True)
    if estimate:
        _show_estimate(config, as_json=as_json)
        return

    def work(on_event: Callable[[Event], None]) -> dict[str, Any]:
        from coopera.studies.study import run_study

        with asked(config, host, port, name) as ask_person:
            return run_study(config, on_event=on_event, ask_person=ask_person)

    with _getting_ready(config):
        _carry_out(work, config.out, config, as_json=as_json)


def resume(
    run: RunPath,
    budget_calls: CallBudget = None,
    budget_tokens: TokenBudget = None,
    budget_money: MoneyBudget = None,
    host: PageHost = HOST,
    port: PagePort = PORT,
    name: PageName = None,
    as_json: AsJson = False,
) -> None:
    """Continue a run that was stopped, failed or killed; the result is that of an uninterrupted one."""
    from coopera.config.schema import load_config
    from coopera.rundir.directory import RunDir

    found = RunDir.open(run)
    given = nested({"budget.calls": budget_calls, "budget.tokens": budget_tokens, "budget.money": budget_money})
    raised = load_config(run / "config.yaml", given).budget

    def work(on_event: Callable[[Event], None]) -> dict[str, Any]:
        from coopera.studies.study import resume_study

        with asked(found.config, host, port, name) as ask_person:
            return resume_study(run, on_event=on_event, budget=raised, ask_person=ask_person)

    _carry_out(work, run, found.config, as_json=as_json, done=found.hours_done())


@contextmanager
def asked(config: Config, host: str, port: int, name: str | None) -> Iterator[Interview]:
    """What puts a run's questions to the person; with `played_by: web` a page, whose address is told.

    Raises:
        ConfigError: If the page cannot have its address.
    """
    if config.played_by != "web":
        from coopera.people.terminal import Terminal

        yield Terminal()
        return
    from coopera.web.common import Door, served
    from coopera.web.person.app import make_person_app
    from coopera.web.person.person import WebPerson

    person = WebPerson()
    with served(lambda door: make_person_app(person, door), Door.opened(host, port, (name,) if name else ())) as server:
        typer.echo(f"The day is lived at {server.address}", err=True)
        try:
            yield person
        except (KeyboardInterrupt, StoppedError):
            person.end("The run was stopped; it goes on with the same page when it is resumed.")
            raise
        except CooperaError as err:
            person.end(f"The run has stopped: {err}")
            raise
        person.end("The study is over.")


def _recorded(models: Mapping[str, str]) -> Path | None:
    """The study file of the run whose record is to answer, so that it need not be described again."""
    from coopera.config.schema import Models
    from coopera.models.recorded import recorded_run
    from coopera.rundir.directory import RunDir

    every = models.values() if len(models) == len(Models.model_fields) else ()
    folder = next((found for spec in every if (found := recorded_run(spec))), None)
    return RunDir.open(folder).root / "config.yaml" if folder else None


def _show_estimate(config: Any, *, as_json: bool) -> None:
    from coopera.checks.estimate import estimate, in_words
    from coopera.config.prices import in_words as bill_in_words
    from coopera.report.tables import print_table

    found = estimate(config)
    if as_json:
        typer.echo(json.dumps(found, sort_keys=True))
        return
    print_table(*in_words(found))
    typer.echo(found["note"])
    if "money" in found:
        typer.echo(bill_in_words(found["money"]))


def _hours_of(config: Any) -> int:
    """How many hours the whole run has."""
    from coopera.studies.study import plan_days

    return sum(len(plan.hours) for plan in plan_days(config))


def _carry_out(
    work: Callable[[Callable[[Event], None]], dict[str, Any]],
    folder: Path,
    config: Any,
    *,
    as_json: bool,
    done: Collection[tuple[int, int]] = (),
) -> None:
    """Do the work with progress on standard error, then show what came of it."""
    from coopera.core.errors import WaitingError
    from coopera.report.console import PlainConsole
    from coopera.report.progress import Progress, days_table
    from coopera.rundir.stopping import ends_soon

    try:
        # a live line and a person's typing would get in each other's way
        console = PlainConsole(stderr=True, highlight=False, force_terminal=False) if config.attended else None
        with Progress(_hours_of(config), console, done=done) as progress:

            def farewell() -> None:
                progress.close()
                typer.echo(printable(_how_to_go_on(folder)), err=True)

            with ends_soon(STOPPED, farewell):
                summary = work(progress.tell)
    except WaitingError as err:
        typer.echo(printable(f"{err} Continue with: coopera resume {folder}"), err=True)
        raise typer.Exit(STOPPED) from None
    except (KeyboardInterrupt, StoppedError):
        typer.echo(printable(_how_to_go_on(folder)), err=True)
        raise typer.Exit(STOPPED) from None
    except BudgetError:
        typer.echo(printable(_how_to_go_on(folder)), err=True)
        raise
    if as_json:
        typer.echo(json.dumps({**summary, "run": str(folder)}, sort_keys=True))
        return
    days_table(summary, folder)


@contextmanager
def _getting_ready(config: Config) -> Iterator[None]:
    """Have the processes that take pictures begin while this one loads its libraries: either takes a second.

    A robot that looks at pictures has none; only of the offline one is it known already that it does not.
    """
    if not config.takes_pictures or config.models.robot != "offline":
        yield
        return
    from coopera.simulation.sight.studio import ready
    from coopera.studies.catalogues import find_person

    with ready(config.renderer, [find_person(config, person) for person in config.humans or []]):
        yield


def _how_to_go_on(folder: Path) -> str:
    if (folder / "run.json").is_file():
        return f"Stopped. Continue with: coopera resume {folder}"
    return "Stopped before the run began; nothing was written."
