"""`coopera humans`: who can take part, and how to bring in more."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from coopera.commands.listing import show_rows
from coopera.commands.options import STOPPED, AsJson, BaseUrl, DataFolder, Model, PromptFolder
from coopera.commands.rows import rows_of
from coopera.core.naming import printable

if TYPE_CHECKING:
    from coopera.core.hour import LoggedHour
    from coopera.models.offline.human.facts import Fact, Facts

_FORMAT = "What the file is. [default: told by its content]"

app = typer.Typer(help="The people who can take part.", no_args_is_help=True)


@app.command("list")
def list_humans(as_json: AsJson = False) -> None:
    """List the shipped people and the imported ones."""
    from coopera.core.people import TRAITS

    people = rows_of("people")
    if not as_json:
        people = [{**one, **{trait[0].upper(): f"{one['big_five'][trait]:.1f}" for trait in TRAITS}} for one in people]
    show_rows(people, ("id", "name", *(trait[0].upper() for trait in TRAITS), "source"), as_json=as_json)


@app.command()
def show(
    person: Annotated[
        str, typer.Argument(metavar="ID-or-FILE", help="An id from `coopera humans list`, or a persona file.")
    ],
    as_json: AsJson = False,
) -> None:
    """Show one person: self-introduction, Big Five, and the facts that the offline person reads out of it."""
    from coopera.config.schema import default_data_dir
    from coopera.models.offline.household.knowledge import shipped
    from coopera.models.offline.human.facts import facts
    from coopera.people.shipped import find, read_persona
    from coopera.studies.own_files import names_file

    found = read_persona(Path(person)) if names_file(person) else find(person, default_data_dir())
    stated = facts(found.profile, shipped())
    if as_json:
        typer.echo(json.dumps({**found.model_dump(mode="json"), "facts": stated.model_dump(mode="json")}))
        return
    typer.echo(printable(f"{found.name} ({found.id}, from {found.source})\n\n{found.profile}\n\n{found.big_five}\n"))
    typer.echo(printable("\n".join(_facts_lines(stated))))


def _facts_lines(stated: Facts) -> Iterator[str]:
    """Say for each sentence what it states and what follows, then what is never done because it is not stated."""
    yield "What is stated, and what follows for the offline person:"
    if not stated.listed:
        yield "  nothing stated"
    for sentence, rows in groupby(stated.listed, key=lambda fact: fact.sentence):
        facts = list(rows)
        yield f"  {sentence}{'' if facts[0].own else '  (added by the import)'}"
        yield from (f"    {fact.kind}: {fact.says}{_follows(fact)}" for fact in facts)
    if stated.unstated:
        yield "Not stated, and therefore:"
        yield from (f"    {fact.kind}: {fact.says}{_follows(fact)}" for fact in stated.unstated)


def _follows(fact: Fact) -> str:
    return f" -> {'; '.join(fact.effects)}" if fact.effects else ""


@app.command("import")
def import_humans(
    file: Annotated[Path, typer.Argument(metavar="FILE.csv", help="Synthetic-Persona-Chat as published.")],
    limit: Annotated[int | None, typer.Option(min=1, help="Take the first rows only. [default: all]")] = None,
    out: DataFolder = None,
    workers: Annotated[int, typer.Option(min=1, max=64, help="Rows worked on at the same time.")] = 4,
    force: Annotated[bool, typer.Option("--force", help="Write anew those who are there already.")] = False,
    model: Model = None,
    base_url: BaseUrl = None,
    prompts: PromptFolder = None,
    as_json: AsJson = False,
) -> None:
    """Make one person of each row, from the column "user 1 personas"; stopped, it goes on where it was."""
    from coopera.config.schema import load_config
    from coopera.people.import_chat import Maker, import_people, read_rows

    models = {"human": model} if model else None
    config = load_config(flags={"models": models, "base_url": base_url, "prompts": prompts, "data_dir": out})
    read_rows(file)  # a file that is wrong is refused before a model is loaded
    from coopera.core.errors import ConfigError
    from coopera.prompts import PromptLibrary
    from coopera.rundir.stopping import ends_soon
    from coopera.studies.assemble import open_ask

    folder = config.data_dir / "humans"
    library = PromptLibrary(config.prompts)
    replies = config.data_dir / "imports"  # a model's replies, so that those of a row that was broken off are not lost
    try:
        replies.mkdir(parents=True, exist_ok=True)
    except OSError as err:
        raise ConfigError(f"{replies}: people cannot be stored here ({err.strerror}).") from err

    def tell(person: str, what: str) -> None:
        typer.echo(printable(f"{person}: {what}"), err=True)

    def farewell() -> None:
        typer.echo("Stopped. The same command goes on where it was.", err=True)

    try:
        with ends_soon(STOPPED, farewell), open_ask(config, prompts=library, root=replies) as ask:
            maker = Maker(ask, config.models.human, library.hashes())
            done = import_people(file, maker, folder, limit=limit, force=force, workers=workers, on_person=tell)
    except KeyboardInterrupt:
        farewell()
        raise typer.Exit(STOPPED) from None
    for person, why in done.failed.items():
        typer.echo(printable(f"{person}: {why}"), err=True)
    if as_json:
        found: dict[str, Any] = {**done._asdict(), "folder": str(folder)}
        typer.echo(json.dumps(found))
    else:
        failed = f", {len(done.failed)} failed" if done.failed else ""
        typer.echo(f"{len(done.written)} written and {len(done.kept)} kept in {folder}{failed}.")
    if done.failed:
        raise typer.Exit(1)


@app.command()
def diary(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="HOMER schedules (JSON), or atusact_YEAR.dat.")],
    kind: Annotated[str | None, typer.Option("--format", metavar="homer|atus", help=_FORMAT)] = None,
    who: Annotated[str | None, typer.Option(metavar="A/train|TUCASEID", help="Only this person.")] = None,
    limit: Annotated[int, typer.Option(min=1, help="Take the first people only.")] = 10,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where the diaries go.")] = Path("diaries"),
    force: Annotated[bool, typer.Option("--force", help="Write anew those that are there already.")] = False,
    as_json: AsJson = False,
) -> None:
    """Make a diary of each person of a published time-use file, to be lived with --played-by log:FILE."""
    from coopera.people.import_diary import read_published, store, summary

    found = read_published(file, kind, who=who, limit=limit)
    kept = store(found.people, out, force=force).kept
    rows = [{**summary(one, out), "kept": out / f"{one.name}.csv" in kept} for one in found.people]
    for note in found.notes:
        typer.echo(printable(note), err=True)
    if as_json:
        typer.echo(json.dumps({"people": rows, "notes": found.notes}))
        return
    for row in rows:
        about = f" ({row['about']})" if row["about"] else ""
        there = ", which was there and is kept" if row["kept"] else ""
        marks = f"{row['continued']} continued, {row['away']} away"
        typer.echo(
            f"{row['file']}{there}: {row['person']}{about}, days: {row['days']}, episodes: {row['episodes']}; "
            f"9 am to 9 pm: {row['hours']} hours ({marks}), {row['open']} open."
        )
    if rows:
        typer.echo(f"To live one: coopera run --played-by log:{rows[0]['file']} --humans ID --days {rows[0]['days']}")


@app.command()
def check(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A persona file, a log or diary, or a CSV to be imported.")
    ],
    as_json: AsJson = False,
) -> None:
    """Say whether a file can be used, and if not, why; of a log or diary, the hours that it is lived in."""
    from coopera.people.log_file import looks_like_log, open_log

    if looks_like_log(file):
        log = open_log(file)
        days = len({hour.day for hour in log.hours})
        kind = "diary" if log.diary else "log"
        hours = [hour.model_dump() for hour in log.hours]
        what: dict[str, Any] = {"file": str(file), "kind": kind, "days": days, "hours": hours}
        sentence = "\n".join([*map(_hour_line, log.hours), f"{file}: a {kind} with {len(hours)} hours (days: {days})."])
    elif file.suffix.lower() == ".csv":
        from coopera.people.import_chat import read_rows

        what = {"file": str(file), "rows": len(read_rows(file))}
        sentence = f"{file}: {what['rows']} people can be imported."
    else:
        from coopera.people.shipped import read_persona

        person = read_persona(file)
        what = {"file": str(file), "id": person.id, "name": person.name}
        sentence = f"{file}: this is {person.name} ({person.id})."
    typer.echo(json.dumps(what) if as_json else sentence)


def _hour_line(hour: LoggedHour) -> str:
    from coopera.core.clock import hour_label

    marks = [f" ({mark})" for mark, yes in (("goes on", hour.continues), ("away", hour.away)) if yes]
    return f"day {hour.day}, {hour_label(hour.hour)}: {hour.intention}{''.join(marks)}"
