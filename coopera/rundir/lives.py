"""From run directories to the lives that the checks on people take, and back to files: JSON, CSV and a picture."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.config.files import canonical_json, write_output
from coopera.core.errors import ConfigError
from coopera.core.hour import HourRecord, LoggedHour
from coopera.core.people import Persona, PersonId
from coopera.evaluation.people.figures import FULL, Figure
from coopera.evaluation.people.lives import InferredTraits, LivedDay, Lives
from coopera.people.log_file import read_log
from coopera.rundir.directory import RunDir

COLUMNS = tuple(Figure.model_fields)


class Source(NamedTuple):
    """What is recorded of a run that was analysed."""

    path: str
    variant: str
    seed: int
    method: str
    days: int
    failed_hours: int


class FoundLives(NamedTuple):
    """The lives in some runs, by how the person was simulated, and where they come from."""

    variants: dict[str, Lives]
    sources: list[Source]
    model: str
    collab: int


def read_lives(paths: Sequence[Path]) -> FoundLives:
    """Read what people did in some runs. A day that stands in two runs, as it may with two methods, counts once.

    Raises:
        ConfigError: If there is no run, or a run without an hour. If the runs do not go together: they differ in the
            person's language model, in the collaboration type, or in the person of an id. If they hold one person only.
        RunError: If a run's files are damaged or newer than this version.
    """
    if not paths:
        raise ConfigError("RUN: name at least one run directory.")
    variants: dict[str, Lives] = {}
    sources: list[Source] = []
    kinds: dict[Path, _Kind] = {}
    for path in dict.fromkeys(paths):
        run = RunDir.open(path)
        kinds[path] = _Kind.of(run)
        _same_kind(kinds, path)
        variant = run.config.person_model
        lives = variants.setdefault(variant, Lives([], {}, []))
        hours = run.hours()
        days = _days(run, hours)
        if not days:
            raise ConfigError(f"{path}: this run holds no hour that a person has lived.")
        known = {_key(day) for day in lives.days}
        lives.days.extend(day for day in days if _key(day) not in known)
        _meet(lives.personas, run, path)
        lives.beliefs.extend(_beliefs(run))
        failed = sum(record.human is None for record in hours)
        sources.append(Source(str(path), variant, run.config.seed, run.config.method, len(days), failed))
    kind = kinds[next(iter(kinds))]
    for lives in variants.values():
        if len(lives.people) < 2:
            raise ConfigError(
                f"RUN: these runs hold one person only ({lives.people[0]}); the checks compare at least two people."
            )
    return FoundLives(
        dict(sorted(variants.items(), key=lambda item: (item[0] != FULL, item[0]))),
        sources,
        kind.human_model,
        kind.collaboration_type,
    )


def read_recorded(paths: Sequence[Path], people: Sequence[PersonId]) -> dict[PersonId, list[LoggedHour]]:
    """Read the logs of real people; the file's name without ending is the id of the person who is them in the runs.

    Raises:
        ConfigError: If a log cannot be used, or is of nobody in the runs.
    """
    recorded = {}
    for path in paths:
        if path.stem not in people:
            raise ConfigError(
                f"--recorded: {path} must be named after a person in these runs ({', '.join(people)}), "
                f"such as {people[0]}.csv."
            )
        recorded[PersonId(path.stem)] = read_log(path)
    return recorded


def write_results(folder: Path, figures: Sequence[Figure], about: Mapping[str, Any]) -> None:
    """Write people.json, people.csv and people.md.

    Raises:
        ConfigError: If the folder cannot be written.
    """
    data = {**about, "figures": [figure.model_dump() for figure in figures]}
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(figure.model_dump() for figure in figures)
    write_output(folder / "people.json", canonical_json(data))
    write_output(folder / "people.csv", text.getvalue())
    head, *rows = table(figures)
    lines = [head, ["---"] * len(head), *rows]
    write_output(folder / "people.md", "".join(f"| {' | '.join(cells)} |\n" for cells in lines))


def write_rows(path: Path, rows: Sequence[NamedTuple], columns: Sequence[str]) -> None:
    """Write a CSV file with a header.

    Raises:
        ConfigError: If it cannot be written.
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([columns, *rows])
    write_output(path, text.getvalue())


def table(figures: Sequence[Figure]) -> list[list[str]]:
    """The figures as people read them: a row of headings, then one row each."""

    def number(value: float | None) -> str:
        return "–" if value is None else f"{value:.3f}"

    rows = [["check", "measure", "person", "ours", "95 % interval", "control", "paper", "n", "note"]]
    for one in figures:
        interval = "" if one.low is None else f"{number(one.low)} to {number(one.high)}"
        control = "" if one.control is None else f"{number(one.control)} ({one.control_is})"
        n = f"{one.n} {one.unit}" if one.n else ""
        numbers = [number(one.value), interval, control, number(one.paper), n]
        rows.append([one.check, one.measure, one.variant.replace("_", " "), *numbers, one.note])
    return rows


class _Kind(NamedTuple):
    """What runs must have in common to be analysed together, by the names that people know."""

    human_model: str
    collaboration_type: int
    intentions: str
    absence: str
    person_memory: str
    changes: str

    @classmethod
    def of(cls, run: RunDir) -> _Kind:
        """Of a run."""
        config = run.config
        model = str(run.info.get("models", {}).get("human", config.models.human))
        return cls(model, config.collab, config.intentions, config.absence, config.person_memory, config.changes)


def _same_kind(kinds: Mapping[Path, _Kind], path: Path) -> None:
    first = next(iter(kinds))
    for name, here, there in zip(_Kind._fields, kinds[path], kinds[first], strict=True):
        if here != there:
            what = name.replace("_", " ")
            raise ConfigError(f"{path}: {what} is {here} here, but {there} in {first}; analyse them apart.")


def _days(run: RunDir, hours: Sequence[HourRecord]) -> list[LivedDay]:
    by_day: dict[int, list[HourRecord]] = {}
    for record in hours:
        if record.human is not None:
            by_day.setdefault(record.day, []).append(record)
    return [_day(run.config.seed, records) for _, records in sorted(by_day.items())]


def _day(seed: int, records: Sequence[HourRecord]) -> LivedDay:
    first = records[0]
    lived = [(record.hour, record.human) for record in records if record.human is not None]
    return LivedDay(
        person=first.person,
        scene=first.scene,
        seed=seed,
        number=first.episode_day,
        hours=[hour for hour, _ in lived],
        intentions=[human.intention.text for _, human in lived],
        tasks=[[task.act.describe() for task in human.tasks] for _, human in lived],
    )


def _key(day: LivedDay) -> tuple[str, str, int, int]:
    return day.person, day.scene, day.seed, day.number


def _meet(known: dict[PersonId, Persona], run: RunDir, path: Path) -> None:
    for person, persona in run.people().items():
        before = known.setdefault(PersonId(person), persona)
        if (before.profile, before.big_five) != (persona.profile, persona.big_five):
            raise ConfigError(f"{path}: {person} is somebody else here than in the runs before; analyse them apart.")


def _beliefs(run: RunDir) -> list[InferredTraits]:
    """The last belief about each person, of each robot (an episode has one)."""
    last = {(one.episode, one.person): one.belief.big_five for one in run.evenings() if one.belief.big_five}
    return [InferredTraits(person, big_five) for (_, person), big_five in sorted(last.items()) if big_five]
