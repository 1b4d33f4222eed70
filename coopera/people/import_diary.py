"""Bring in diaries: tell what a file is, read it, and write a diary per person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.config.files import reason, write_output
from coopera.core.clock import FIRST_HOUR, HOURS_PER_DAY
from coopera.core.errors import ConfigError
from coopera.people.atus import read_atus
from coopera.people.diary import as_csv, hours_of
from coopera.people.homer import read_homer
from coopera.people.published import Format, PersonDiary, Published

_PEEK = 65_536  # bytes that tell what a file is
_IMPORTERS: dict[str, Callable[[Path, str | None, int | None], Published]] = {"homer": read_homer, "atus": read_atus}


class Stored(NamedTuple):
    """The files of an import: those written, and those that were there already and are kept."""

    written: list[Path]
    kept: list[Path]


def recognise(path: Path) -> Format:
    """What a file is, by its first bytes.

    Raises:
        ConfigError: If it cannot be read, is empty or is neither.
    """
    try:
        with path.open("rb") as file:
            start = file.read(_PEEK).decode("utf-8-sig", "replace").lstrip()
    except FileNotFoundError:
        raise ConfigError(f"{path}: there is no such file.") from None
    except OSError as err:
        raise ConfigError(f"{path}: the file cannot be read ({reason(err)}).") from err
    if not start:
        raise ConfigError(f"{path}: the file is empty.")
    columns = [name.strip().lower() for name in start.splitlines()[0].split(",")]
    if "tucaseid" in columns:
        return "atus"
    if {"day", "activity"} <= set(columns) or {"day", "intention"} <= set(columns):
        raise ConfigError(f"{path}: this is a diary or log already; live it with coopera run --played-by log:{path}.")
    if start.startswith(("{", "[")):
        return "homer"
    raise ConfigError(
        f"{path}: this is neither HOMER schedules (JSON) nor an activity file of the American Time Use Survey (with a "
        "header that has TUCASEID); --format says which one it is meant to be."
    )


def read_published(
    path: Path, kind: str | None = None, *, who: str | None = None, limit: int | None = None
) -> Published:
    """Read the diaries of a file.

    Args:
        path: The file.
        kind: A `Format`; None lets the content tell.
        who: Only this person: A/train of HOMER, a TUCASEID of the survey.
        limit: Only so many, in the order of the file.

    Raises:
        ConfigError: If the file is not of its kind, holds nobody, or not the one asked for; names file and place.
    """
    if kind is not None and kind not in _IMPORTERS:
        raise ConfigError(f"--format must be {' or '.join(_IMPORTERS)}, not {kind!r}.")
    return _IMPORTERS[kind or recognise(path)](path, who, limit)


def summary(one: PersonDiary, folder: Path) -> dict[str, Any]:
    """What a person's diary gives a run of 9 am to 9 pm: its file, days and episodes, and how many hours are which."""
    lived = range(FIRST_HOUR, FIRST_HOUR + HOURS_PER_DAY)
    hours = [hour for hour in hours_of(one.episodes) if hour.hour in lived]
    days = len({episode.day for episode in one.episodes})
    return {
        "person": one.who,
        "about": one.about,
        "file": str(folder / f"{one.name}.csv"),
        "days": days,
        "episodes": len(one.episodes),
        "hours": len(hours),
        "continued": sum(hour.continues for hour in hours),
        "away": sum(hour.away for hour in hours),
        "open": days * HOURS_PER_DAY - len(hours),
    }


def store(people: Sequence[PersonDiary], folder: Path, *, force: bool = False) -> Stored:
    """Write <folder>/<name>.csv of each person; files that are there are kept, unless forced.

    Raises:
        ConfigError: If two people have the same file name, or a file cannot be written.
    """
    names: dict[str, str] = {}
    for one in people:
        if other := names.get(one.name):
            raise ConfigError(f"{other} and {one.who} would both be {one.name}.csv; name one of them with --who.")
        names[one.name] = one.who
    stored = Stored([], [])
    for one in people:
        path = folder / f"{one.name}.csv"
        if path.exists() and not force:
            stored.kept.append(path)
        else:
            write_output(path, as_csv(one.episodes))
            stored.written.append(path)
    return stored
