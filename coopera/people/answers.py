"""What a real person has said, in the run's folder: each word is on file when it is given, so that none is lost.

`person/participant.json` says who it is and what they agreed to, `person/draft.json` what they have said to the
question that waits, and `person/answers/…json` each answer, with its question and its two moments.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Protocol, TypeAlias, TypeVar, runtime_checkable

from pydantic import Field, ValidationError

from coopera.config.files import canonical_json, write_atomic
from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.interview import Answer, Question
from coopera.core.naming import sha256
from coopera.core.people import Frozen

FOLDER = "person"
Check: TypeAlias = Callable[[Question, str], str]
"""Reads one step of a person's and returns it with names for numbers; ValueError says what is wrong with it."""
_LONGEST_CONSENT = 200_000
Now: TypeAlias = Callable[[], datetime]
Kept = TypeVar("Kept", bound=Frozen)


@dataclass(frozen=True, slots=True)
class Sitting:
    """The run that somebody is asked for.

    Attributes:
        root: Its folder.
        config: What it was told.
        check: Checks a step in the home that the person lives in.
        go_on: Raises `StoppedError` once the run was asked to stop; called while an answer is waited for.
    """

    root: Path
    config: Config
    check: Check
    go_on: Callable[[], None]

    def consent(self) -> str:
        """What is to be agreed to: the run's own copy, where somebody has agreed, so that it may go on elsewhere."""
        kept = self.root / FOLDER / "consent.txt"
        return kept.read_text(encoding="utf-8").strip() if kept.is_file() else consent_text(self.config)


@runtime_checkable
class Attended(Protocol):
    """One who asks a real person and wants to know the run: to keep what is said there, and to check it at once."""

    def attend(self, sitting: Sitting) -> None:
        """Be told of the run, before its first question."""
        ...


class Participant(Frozen):
    """Who plays the person, and what they agreed to; `agreed` is when, in UTC."""

    id: str = ""
    agreed: str = ""
    consent_sha256: str = ""


class Draft(Frozen):
    """What has been said so far to a question: steps, or answers by their place ("" for none yet).

    Attributes:
        question: Which question (`key`).
        lines: What was said.
        revision: Counts the changes, so that of two pages that show it one notices the other.
        since: When the question was first shown, in UTC.
    """

    question: str
    lines: Annotated[list[str], Field(max_length=10_000)] = []
    revision: int = 0
    since: str = ""


class Given(Frozen):
    """An answer, with what it answers."""

    question: Question
    answer: Answer
    asked: str
    answered: str


class Answers:
    """What a person has said in one run."""

    def __init__(self, run: Path, now: Now = lambda: datetime.now(UTC)) -> None:
        self.folder = run / FOLDER
        self._now = now

    def participant(self) -> Participant:
        """Who is there; nobody yet is one without an id."""
        return _read(self.folder / "participant.json", Participant) or Participant()

    def agree(self, id: str, consent: str) -> None:
        """Keep who is there, and that they agreed to a text."""
        sha = sha256(consent) if consent else ""
        if consent:
            write_atomic(self.folder / "consent.txt", consent + "\n")
        agreed = self._moment() if consent else ""
        self._write("participant.json", Participant(id=id, agreed=agreed, consent_sha256=sha))

    def draft(self, question: Question) -> Draft:
        """What has been said to a question so far."""
        found = _read(self.folder / "draft.json", Draft)
        if found is None or found.question != key(question):
            found = Draft(question=key(question), since=self._moment())
            self._write("draft.json", found)
        return found

    def keep(self, question: Question, lines: list[str]) -> Draft:
        """Keep what has been said to a question so far."""
        before = self.draft(question)
        draft = before.model_copy(update={"lines": lines, "revision": before.revision + 1})
        self._write("draft.json", draft)
        return draft

    def final(self, question: Question) -> Answer | None:
        """The answer that was given to a question before the run was stopped; None if it is to be asked.

        An answer that could not be read is asked for again.
        """
        found = None if question.problem else _read(self._file(question), Given)
        return found.answer if found else None

    def give(self, question: Question, answer: Answer) -> Answer:
        """Keep the answer to a question and return it."""
        given = Given(question=question, answer=answer, asked=self.draft(question).since, answered=self._moment())
        self._write(str(self._file(question).relative_to(self.folder)), given)
        return answer

    def _file(self, question: Question) -> Path:
        name = f"day-{question.day:02d}-hour-{question.hour:02d}-{question.kind}-{key(question)[:8]}.json"
        return self.folder / "answers" / name

    def _write(self, name: str, what: Frozen) -> None:
        write_atomic(self.folder / name, canonical_json(what.model_dump(mode="json")))

    def _moment(self) -> str:
        return self._now().isoformat(timespec="seconds")


def key(question: Question) -> str:
    """What tells a question from all others, whatever was wrong with an answer to it."""
    text = canonical_json(question.model_dump(mode="json", exclude={"problem"}))
    return sha256(text)


def consent_text(config: Config) -> str:
    """What a participant must agree to; empty where that is nothing.

    Raises:
        ConfigError: If the file cannot be read, is empty, or nobody is there to agree.
    """
    given = config.real_person
    for field, value in (("consent", given.consent), ("participant", given.participant)):
        if value is not None and not config.attended:
            raise ConfigError(f"real_person.{field}: nobody is asked unless played_by is me or web.")
    if given.consent is None:
        return ""
    text = read_text(given.consent.expanduser(), "consent text", _LONGEST_CONSENT).strip()
    if not text:
        raise ConfigError(f"{given.consent}: the consent text is empty.")
    return text


def _read(path: Path, kind: type[Kept]) -> Kept | None:
    try:
        return kind.model_validate(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, ValidationError):
        return None
