"""`coopera run` and `coopera resume`."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coopera.commands.options import AsJson, BaseUrl, CallBudget, Model, PromptFolder, RunPath, TokenBudget, as_list
from coopera.core.errors import BudgetError

if TYPE_CHECKING:
    from coopera.studies.study import Event

STOPPED = 130  # what shells give a program that Ctrl-C ended


def run(
    study: Annotated[Path | None, typer.Argument(metavar="[STUDY.yaml]", help="A study file; flags win.")] = None,
    setting: Annotated[int | None, typer.Option(help="The paper's setting, 1 to 4. [default: 1]")] = None,
    collab: Annotated[int | None, typer.Option(help="1 watch and help, 2 free-form. [default: 2]")] = None,
    humans: Annotated[str | None, typer.Option(metavar="ID,…", help="People, in the order they take part.")] = None,
    scenes: Annotated[str | None, typer.Option(metavar="ID,…", help="Homes, in the order they are lived in.")] = None,
    days: Annotated[int | None, typer.Option(help="Days of each episode. [default: as the setting has it]")] = None,
    hours: Annotated[int | None, typer.Option(help="Hours of each day, from 9 am. [default: 13]")] = None,
    method: Annotated[str | None, typer.Option(metavar="NAME", help="The robot's method. [default: ours]")] = None,
    seed: Annotated[int | None, typer.Option(help="Every random draw derives from it. [default: 0]")] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="The run directory. [default: the next runs/run-NNN]")
    ] = None,
    model: Model = None,
    human_model: Annotated[str | None, typer.Option(metavar="SPEC", help="Language model of the person.")] = None,
    robot_model: Annotated[str | None, typer.Option(metavar="SPEC", help="Language model of the robot.")] = None,
    judge_model: Annotated[str | None, typer.Option(metavar="SPEC", help="Language model of the judge.")] = None,
    base_url: BaseUrl = None,
    prompts: PromptFolder = None,
    classifier: Annotated[
        str | None, typer.Option(metavar="NAME", help="How the robot judges: kernel, lora, … [default: kernel]")
    ] = None,
    classifier_config: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Recipe of a classifier that takes one, as lora-instruct does.")
    ] = None,
    learning: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="warm or fresh (anew on everything). [default: warm]"),
    ] = None,
    who: Annotated[
        str | None, typer.Option(help="known, or unknown: the robot guesses whom it is with. [default: known]")
    ] = None,
    traits: Annotated[
        str | None, typer.Option(help="When traits are inferred: evening, or hourly too. [default: evening]")
    ] = None,
    human: Annotated[
        str | None, typer.Option(help="simulated, log:FILE (a real person's log) or me. [default: simulated]")
    ] = None,
    feedback: Annotated[str | None, typer.Option(help="yes_no or graded (1 to 5). [default: yes_no]")] = None,
    lived: Annotated[
        Path | None, typer.Option(metavar="RUN", help="A finished run of --method none, whose days are lived again.")
    ] = None,
    person: Annotated[
        str | None, typer.Option(metavar="NAME", help="full, or an ablation: no_extension, single_shot.")
    ] = None,
    search_objects: Annotated[
        int | None, typer.Option(metavar="N", help="Objects the person is offered for an intention. [default: 30]")
    ] = None,
    search_motions: Annotated[
        int | None, typer.Option(metavar="N", help="Motions the person is offered for an intention. [default: 5]")
    ] = None,
    motions: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Motion-X (.npy) or AMASS (.npz) clips the person can do, too.")
    ] = None,
    renderer: Annotated[str | None, typer.Option(help="tiny or egl, which draws large pictures faster.")] = None,
    robot: Annotated[
        str | None, typer.Option(metavar="NAME", help="The robot's body, or its YAML file. [default: fetch]")
    ] = None,
    pictures: Annotated[str | None, typer.Option(help="sampled, none or video. [default: sampled]")] = None,
    budget_calls: CallBudget = None,
    budget_tokens: TokenBudget = None,
    estimate: Annotated[
        bool, typer.Option("--estimate", help="Only say how many calls and tokens the run would take.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Let people live their days while a robot learns to help them."""
    from coopera.config.schema import load_config
    from coopera.studies.catalogues import resolve

    roles = {"human": human_model or model, "robot": robot_model or model, "judge": judge_model or model}
    flags = {
        "setting": setting,
        "collab": collab,
        "humans": as_list(humans),
        "scenes": as_list(scenes),
        "days": days,
        "hours": hours,
        "method": method,
        "seed": seed,
        "out": out,
        "models": {role: spec for role, spec in roles.items() if spec is not None} or None,
        "base_url": base_url,
        "prompts": prompts,
        "classifier": classifier,
        "classifier_config": classifier_config,
        "learning": learning,
        "who": who,
        "traits": traits,
        "human": human,
        "person": person,
        "motions": motions,
        "search": _given(objects=search_objects, motions=search_motions),
        "feedback": feedback,
        "lived": lived,
        "renderer": renderer,
        "robot": robot,
        "pictures": pictures,
        "budget": _given(calls=budget_calls, tokens=budget_tokens),
    }
    config = resolve(load_config(study or _replayed(model), flags))
    assert config.out is not None  # resolve sets it
    if estimate:
        _show_estimate(config, as_json=as_json)
        return

    def work(on_event: Callable[[Event], None]) -> dict[str, Any]:
        from coopera.people.terminal import Terminal
        from coopera.studies.study import run_study

        return run_study(config, on_event=on_event, ask_person=Terminal())

    _carry_out(work, config.out, config, as_json=as_json)


def resume(
    run: RunPath, budget_calls: CallBudget = None, budget_tokens: TokenBudget = None, as_json: AsJson = False
) -> None:
    """Continue a run that was stopped, failed or killed; the result is that of an uninterrupted one."""
    from coopera.config.schema import load_config
    from coopera.rundir.directory import RunDir

    found = RunDir.open(run)
    raised = load_config(run / "config.yaml", {"budget": _given(calls=budget_calls, tokens=budget_tokens)}).budget

    def work(on_event: Callable[[Event], None]) -> dict[str, Any]:
        from coopera.people.terminal import Terminal
        from coopera.studies.study import resume_study

        return resume_study(run, on_event=on_event, budget=raised, ask_person=Terminal())

    _carry_out(work, run, found.config, as_json=as_json, done=found.hours_done())


def _given(**numbers: int | None) -> dict[str, int] | None:
    """The numbers that flags give."""
    return {name: number for name, number in numbers.items() if number is not None} or None


def _replayed(model: str | None) -> Path | None:
    """The study file of the run that is to be replayed, so that it need not be described again."""
    from coopera.rundir.directory import RunDir

    kind, _, folder = (model or "").partition(":")
    return RunDir.open(Path(folder)).root / "config.yaml" if kind == "replay" else None


def _show_estimate(config: Any, *, as_json: bool) -> None:
    from coopera.checks.estimate import estimate, in_words
    from coopera.report.tables import print_table

    found = estimate(config)
    if as_json:
        typer.echo(json.dumps(found, sort_keys=True))
        return
    print_table(*in_words(found))
    typer.echo(found["note"])


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
    from rich.console import Console

    from coopera.core.errors import StoppedError, WaitingError
    from coopera.report.progress import Progress, days_table

    try:
        # a live line and a person's typing would get in each other's way
        console = Console(stderr=True, highlight=False, force_terminal=False) if config.human == "me" else None
        with Progress(_hours_of(config), console, done=done) as progress:
            summary = work(progress.tell)
    except WaitingError as err:
        typer.echo(f"{err} Continue with: coopera resume {folder}", err=True)
        raise typer.Exit(STOPPED) from None
    except (KeyboardInterrupt, StoppedError):
        typer.echo(_how_to_go_on(folder), err=True)
        raise typer.Exit(STOPPED) from None
    except BudgetError:
        typer.echo(_how_to_go_on(folder), err=True)
        raise
    if as_json:
        typer.echo(json.dumps({**summary, "run": str(folder)}, sort_keys=True))
        return
    days_table(summary, folder)


def _how_to_go_on(folder: Path) -> str:
    if (folder / "run.json").is_file():
        return f"Stopped. Continue with: coopera resume {folder}"
    return "Stopped before the run began; nothing was written."
