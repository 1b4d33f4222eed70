"""Bring in people from Synthetic-Persona-Chat, as published: one person per row, from "user 1 personas"."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from coopera.files import read_text
from coopera.humans import write_persona
from core.errors import ConfigError
from core.people import Persona, PersonId
from core.protocols import Ask
from core.randomness import Address, rng_at
from core.replies import BigFiveReply, ProfileReply

COLUMNS = ("user 1 personas", "user 2 personas", "Best Generated Conversation")
_FIELD_LIMIT = 1_000_000  # characters; the published file's longest field has under 10,000

# Used where a persona does not say its own name; drawn by id, so the same row has the same name everywhere.
# fmt: off
_NAMES = [
    "Alex", "Andy", "Ari", "Ash", "Avery", "Bailey", "Blair", "Cameron", "Casey", "Charlie", "Dana", "Devon",
    "Drew", "Eden", "Ellis", "Emery", "Finley", "Frankie", "Gray", "Harper", "Hayden", "Jamie", "Jesse",
    "Jordan", "Jules", "Kai", "Kit", "Lee", "Logan", "Lou", "Marlowe", "Micah", "Morgan", "Nico", "Noel",
    "Parker", "Quinn", "Reese", "Remy", "Riley", "River", "Robin", "Rowan", "Sage", "Sam", "Sasha", "Shay",
    "Sidney", "Skyler", "Toni",
]
# fmt: on
_OWN_NAME = re.compile(r"\b[Mm]y name is ([A-Z][a-z]{1,20})\b")


class Row(NamedTuple):
    """One row of the file: `number` counts conversations from 1, `line` is where the row ends in the file."""

    number: int
    line: int
    profile_1: str
    profile_2: str
    conversation: str


class Imported(NamedTuple):
    """What an import did, by id, in the order of the file."""

    written: list[PersonId]
    kept: list[PersonId]


def read_rows(path: Path) -> list[Row]:
    """Read the published CSV; blank rows are skipped, a byte-order mark and quoted line breaks are understood.

    Raises:
        ConfigError: If the file is unreadable, not UTF-8, lacks a column, has a broken row or no row at all;
            names the file and the line.
    """
    text = read_text(path, "CSV file")
    rows = list(_rows(text, path))
    if not rows:
        raise ConfigError(f"{path}: the file has a header but no row with a persona.")
    return rows


def _rows(text: str, path: Path) -> Iterator[Row]:
    csv.field_size_limit(_FIELD_LIMIT)
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    number = 0
    try:
        header = next(reader, [])
        at = _positions(header, path)
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            number += 1
            where = f"{path}, line {reader.line_num} (row {number})"
            if len(cells) != len(header):
                raise ConfigError(f"{where}: expected {len(header)} columns as in the header, found {len(cells)}.")
            row = Row(number, reader.line_num, *(cells[index].strip() for index in at))
            if not row.profile_1:
                raise ConfigError(f"{where}: the column {COLUMNS[0]!r} must hold a persona, and it is empty.")
            yield row
    except csv.Error as err:
        raise ConfigError(f"{path}, line {reader.line_num} (row {number + 1}): this is not valid CSV ({err}).") from err


def _positions(header: list[str], path: Path) -> list[int]:
    """Where the three columns stand; case and surrounding spaces do not matter, further columns neither."""
    names = [name.strip().lower() for name in header]
    for column in COLUMNS:
        if column.lower() not in names:
            found = ", ".join(repr(name) for name in header[:6]) or "an empty line"
            raise ConfigError(f"{path}, line 1: the column {column!r} is missing; the header has {found}.")
    return [names.index(column.lower()) for column in COLUMNS]


def person_id(path: Path, number: int) -> PersonId:
    """The id of a row, such as spc-valid-0001 for the first row of synthetic_persona_chat_valid.csv."""
    stem = re.sub(r"[^a-z0-9]+", "-", path.stem.lower()).strip("-")
    stem = re.sub(r"^(new-)?synthetic-persona-chat", "spc", stem)[:48].strip("-") or "person"
    return PersonId(f"{stem}-{number:04d}")


def import_people(
    path: Path,
    ask: Ask,
    folder: Path,
    *,
    limit: int | None = None,
    force: bool = False,
    on_person: Callable[[PersonId, str], None] = lambda person, what: None,
) -> Imported:
    """Make a persona of each row and store it as <folder>/<id>.yaml; existing ones are kept unless forced.

    The language model summarises and extends profile 1 into a self-introduction (PAPER §3.1), then reads the
    Big Five from it. `on_person` is told each id with "written" or "kept". What is written before an error stays.

    Raises:
        ConfigError: If the file or the folder cannot be used.
        ModelOutputError: If a reply cannot be used.
        ModelCallError: If the model cannot be reached.
    """
    done = Imported([], [])
    for row in read_rows(path)[:limit]:
        person = person_id(path, row.number)
        kept = (folder / f"{person}.yaml").is_file() and not force
        if not kept:
            write_persona(_persona(person, row, path, ask), folder)
        (done.kept if kept else done.written).append(person)
        on_person(person, "kept" if kept else "written")
    return done


def _persona(person: PersonId, row: Row, path: Path, ask: Ask) -> Persona:
    """Ask for the profile and the Big Five of one row."""
    extended = ask(
        "persona/profile",
        ProfileReply,
        at=Address(person, 0, 0, "profile"),
        variables={"profile_1": row.profile_1, "profile_2": row.profile_2, "conversation": row.conversation},
    )
    # DEVIATES: one reading by the model; the paper takes a majority over five trials of it and of a 50-item test.
    read = ask(
        "persona/big_five",
        BigFiveReply,
        at=Address(person, 0, 0, "big_five"),
        variables={"profile": extended.profile},
    )
    own = _OWN_NAME.search(row.profile_1)
    name = own.group(1) if own else str(rng_at(0, person, "name").choice(_NAMES))
    return Persona(
        id=person, name=name, profile=extended.profile, big_five=read.big_five, source=f"{path.name}, row {row.number}"
    )
