"""Bring in people from Synthetic-Persona-Chat, as published: one person per row, from "user 1 personas"."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple

from coopera.core.big_five_test import ITEMS, TRIALS, score, vote
from coopera.core.errors import ConfigError, ModelOutputError
from coopera.core.foreign.files import read_text
from coopera.core.foreign.tables import read_table
from coopera.core.people import Persona, PersonId, Provenance, Trial
from coopera.core.protocols import Ask, Reply
from coopera.core.randomness import Address, rng_at
from coopera.core.replies import BigFiveReply, BigFiveTestReply, ProfileReply
from coopera.people.shipped import write_persona

COLUMNS = ("user 1 personas", "user 2 personas", "Best Generated Conversation")
_PROMPTS = ("persona/profile", "persona/big_five", "persona/big_five_test")
_LONGEST = 20_000  # characters of a persona; the published ones have a few hundred

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


class ConversationRow(NamedTuple):
    """One row of the file: `number` counts conversations from 1, `line` is where the row ends in the file."""

    number: int
    line: int
    profile_1: str
    profile_2: str
    conversation: str


class Maker(NamedTuple):
    """What makes the personas, for their provenance: the model's name and the SHA of each prompt by name."""

    ask: Ask
    model: str
    prompts: Mapping[str, str]


class Imported(NamedTuple):
    """What an import did, by id, in the order of the file; `failed` has the reason in one sentence."""

    written: list[PersonId]
    kept: list[PersonId]
    failed: dict[PersonId, str]


def read_rows(path: Path) -> list[ConversationRow]:
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


def _rows(text: str, path: Path) -> Iterator[ConversationRow]:
    lines = read_table(path, text)
    header = next(lines).cells
    at = _positions(header, path)
    for number, (line, cells) in enumerate(lines, 1):
        where = f"{path}, line {line} (row {number})"
        if len(cells) != len(header):
            raise ConfigError(f"{where}: expected {len(header)} columns as in the header, found {len(cells)}.")
        row = ConversationRow(number, line, *(cells[index].strip() for index in at))
        if not row.profile_1:
            raise ConfigError(f"{where}: the column {COLUMNS[0]!r} must hold a persona, and it is empty.")
        if len(row.profile_1) > _LONGEST:
            size = len(row.profile_1)
            raise ConfigError(f"{where}: a persona has at most {_LONGEST} characters, and this one has {size}.")
        yield row


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
    maker: Maker,
    folder: Path,
    *,
    limit: int | None = None,
    force: bool = False,
    workers: int = 1,
    on_person: Callable[[PersonId, str], None] = lambda person, what: None,
) -> Imported:
    """Make a persona of each row and store it as <folder>/<id>.yaml; existing ones are kept unless forced.

    The language model summarises and extends profile 1 into a self-introduction, then reads the Big Five from it
    (PAPER §3.2 and App. B). `workers` threads work on the rows. Each person is written when complete, so a stopped
    import goes on where it was. A row with unusable replies is skipped and reported. `on_person` gets each id with
    "written", "kept" or "failed", in the calling thread.

    Raises:
        ConfigError: If the file or the folder cannot be used.
        ModelCallError: If the model cannot be reached.
    """
    rows = {person_id(path, row.number): row for row in read_rows(path)[:limit]}
    kept = [person for person in rows if (folder / f"{person}.yaml").is_file() and not force]
    for person in kept:
        on_person(person, "kept")
    stop = threading.Event()
    failed: dict[PersonId, str] = {}
    pool = ThreadPoolExecutor(max_workers=workers, thread_name_prefix="import")
    try:
        new = [person for person in rows if person not in kept]
        waiting = {pool.submit(_make, person, rows[person], path, maker, stop): person for person in new}
        for done in as_completed(waiting):
            person = waiting[done]
            try:
                write_persona(done.result(), folder)
            except ModelOutputError as err:
                failed[person] = str(err)
            maker.ask.take_calls()  # the votes are kept in the persona file; nothing else of the calls is
            on_person(person, "failed" if person in failed else "written")
    finally:
        stop.set()
        pool.shutdown(cancel_futures=True)
    written = [person for person in rows if person not in kept and person not in failed]
    return Imported(written, kept, {person: failed[person] for person in rows if person in failed})


def _make(person: PersonId, row: ConversationRow, path: Path, maker: Maker, stop: threading.Event) -> Persona:
    """Ask for the profile and the Big Five of one row."""

    def ask(prompt: str, reply: type[Reply], draw: int, **variables: Any) -> Reply:
        if stop.is_set():
            raise CancelledError
        at = Address(person, 0, 0, prompt.partition("/")[2], draw)
        return maker.ask(prompt, reply, at=at, variables=variables)

    own = _OWN_NAME.search(row.profile_1)
    name = own.group(1) if own else str(rng_at(0, person, "name").choice(_NAMES))
    extended = ask(
        "persona/profile",
        ProfileReply,
        0,
        name=name,
        profile_1=row.profile_1,
        profile_2=row.profile_2,
        conversation=row.conversation,
    ).profile
    statements = [item.says for item in ITEMS]
    trials = []
    for draw in range(TRIALS):
        direct = ask("persona/big_five", BigFiveReply, draw, profile=extended).big_five
        answers = ask("persona/big_five_test", BigFiveTestReply, draw, profile=extended, statements=statements).answers
        trials.append(Trial(direct=direct, test=score(answers), answers=answers))
    return Persona(
        id=person,
        name=name,
        profile=extended,
        # PAPER App. B: a majority vote over five trials; both readings of each trial have a vote
        big_five=vote([reading for trial in trials for reading in (trial.direct, trial.test)]),
        source=f"{path.name}, row {row.number}",
        notes=" ".join(row.profile_1.split()),
        provenance=Provenance(
            file=path.name,
            row=row.number,
            model=maker.model,
            prompts={prompt: maker.prompts[prompt] for prompt in _PROMPTS},
            trials=trials,
        ),
    )
