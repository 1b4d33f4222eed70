"""Somebody in the browser who plays the person: what they are asked, what they have said so far, and who may say it.

The run's thread asks and waits; the pages' threads show and answer. All of it is behind one lock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple, TypeAlias

from coopera.core.errors import CooperaError
from coopera.core.interview import MOST_STEPS, Answer, Question
from coopera.graphs.players.real_person import read_intention, read_verdict
from coopera.people.answers import Answers, Draft, Sitting, key
from coopera.web.person.chair import Chair, Seat

Status: TypeAlias = Literal["opening", "consent", "question", "living", "over"]
_LOOK = 0.5  # seconds between two looks whether the run was asked to stop


class Refused(CooperaError):  # noqa: N818 - it is told to a page, beside the line
    """What a page wants cannot be done; `overtaken` if that is since something else happened meanwhile."""

    def __init__(self, sentence: str, *, overtaken: bool = False) -> None:
        """Say why."""
        super().__init__(sentence)
        self.overtaken = overtaken


class Now(NamedTuple):
    """How it stands; `version` differs wherever a page would look different."""

    status: Status
    seat: Seat
    question: Question | None
    draft: Draft
    consent: str
    participant: str
    ended: str
    version: str


class WebPerson:
    """Asks on a page; to be given to `run_study` as `ask_person`, and to `make_person_app`."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._turn = threading.Condition()
        self._chair = Chair(clock)
        self._sitting: Sitting | None = None
        self._answers: Answers | None = None
        self._question: Question | None = None
        self._answer: Answer | None = None
        self._waits_for_consent = False
        self._ended = ""
        self._told = threading.Event()

    # The run's side

    def attend(self, sitting: Sitting) -> None:
        """Keep what is said in a run, and check each step there."""
        with self._turn:
            self._sitting, self._answers = sitting, Answers(sitting.root)

    def __call__(self, question: Question) -> Answer:
        """Ask, and wait for the answer, for days if need be.

        Raises:
            StoppedError: If the run was asked to stop meanwhile; what has been said is kept.
        """
        sitting, answers = self._there()
        with self._turn:
            if not answers.participant().id and (sitting.consent() or sitting.config.real_person.participant):
                self._waits_for_consent = True
                self._wait(lambda: not self._waits_for_consent)
            if (given := answers.final(question)) is not None:
                return given
            self._question, self._answer = question, None
            answers.draft(question)
            try:
                said = self._said()
            finally:
                self._question = None
            return answers.give(question, said)

    def end(self, sentence: str, patience: float = 5.0) -> None:
        """Say how the run ended, and wait a moment until the page has shown it."""
        with self._turn:
            self._ended = sentence
            somebody = self._chair.holder and self._chair.away < patience
        if somebody:
            self._told.wait(patience)

    def _said(self) -> Answer:
        while self._answer is None:
            self._turn.wait(_LOOK)
            self._there()[0].go_on()
        return self._answer

    def _wait(self, done: Callable[[], bool]) -> None:
        while not self._turn.wait_for(done, _LOOK):
            self._there()[0].go_on()

    # The page's side

    @property
    def sitting(self) -> Sitting | None:
        """The run, once it has begun."""
        return self._sitting

    def now(self, page: str) -> Now:
        """How it stands for a page, which is noted to be there."""
        with self._turn:
            seat = self._chair.seat(page)
            draft, consent, participant = Draft(question=""), "", ""
            if self._answers is not None and self._sitting is not None:
                participant = self._answers.participant().id
                if self._waits_for_consent:
                    consent = self._sitting.consent()
                elif self._question is not None and self._answer is None:
                    draft = self._answers.draft(self._question)
            status = self._status()
            if status == "over" and seat == "yours":
                self._told.set()
            problem = self._question.problem if self._question else ""
            version = f"{status}.{seat}.{draft.question[:12]}.{draft.revision}.{len(problem)}"
            question = self._question if status == "question" else None
            return Now(status, seat, question, draft, consent, participant, self._ended, version)

    def sit(self, page: str, *, take: bool) -> None:
        """Have a page sit down.

        Raises:
            Refused: If another one sits there, and it is not to take over.
        """
        with self._turn:
            if not self._chair.sit(page, take=take):
                raise Refused("This day is open on another page.", overtaken=True)

    def leave(self, page: str) -> None:
        """Have a page get up; what was said stays."""
        with self._turn:
            self._chair.leave(page)

    def agree(self, page: str, participant: str, agrees: bool) -> None:
        """Take down who is there and that they agree.

        Raises:
            Refused: If they do not, or say no number.
        """
        with self._turn:
            self._must_sit(page)
            sitting, answers = self._there()
            if not self._waits_for_consent:
                raise Refused("This was answered before.", overtaken=True)
            id = sitting.config.real_person.participant or " ".join(participant.split())[:60]
            if not id:
                raise Refused("Please fill in your participant number.")
            if sitting.consent() and not agrees:
                raise Refused("Without your agreement nothing is asked; you may simply close this page.")
            answers.agree(id, sitting.consent())
            self._waits_for_consent = False
            self._turn.notify_all()

    def say(self, page: str, question: str, revision: int, said: Mapping[str, Any]) -> None:
        """Take one thing that the person says to the question that waits.

        Args:
            page: Which page says it.
            question: The question that it shows (`key`).
            revision: The revision of the draft that it shows.
            said: `do` and what goes with it: intention (`text`), step (`text`), remove (`at`), undo, verdict (`at`,
                `text`) or finish.

        Raises:
            Refused: If it cannot be taken; nothing has then changed.
        """
        with self._turn:
            self._must_sit(page)
            _, answers = self._there()
            asked = self._question
            if asked is None or self._answer is not None or key(asked) != question:
                raise Refused("The day has gone on; here is what is asked now.", overtaken=True)
            draft = answers.draft(asked)
            if draft.revision != revision:
                raise Refused("This was changed on another page; here is how it stands.", overtaken=True)
            try:
                self._taken(asked, draft, answers, str(said.get("do", "")), said)
            except (ValueError, TypeError) as err:
                raise Refused(str(err)) from err

    def _taken(self, asked: Question, draft: Draft, answers: Answers, do: str, said: Mapping[str, Any]) -> None:
        text = str(said.get("text", ""))
        if (do, asked.kind) == ("intention", "intention"):
            self._give(read_intention(text))
        elif (do, asked.kind) == ("finish", "tasks"):
            if not draft.lines:
                raise ValueError("Please give at least one step.")
            self._give(draft.lines)
        elif (do, asked.kind) == ("finish", "feedback"):
            if missing := len(asked.items) - sum(map(bool, _slots(draft, asked))):
                raise ValueError(f"{missing} of {len(asked.items)} are still open.")
            self._give(draft.lines)
        elif do in _CHANGES and _CHANGES[do] == asked.kind:
            answers.keep(asked, self._changed(asked, draft, do, text, said))
        else:
            raise ValueError("That does not fit what is asked.")

    def _changed(self, asked: Question, draft: Draft, do: str, text: str, said: Mapping[str, Any]) -> list[str]:
        if do == "step":
            if len(draft.lines) >= MOST_STEPS:
                raise ValueError(f"An hour has at most {MOST_STEPS} steps.")
            return [*draft.lines, self._there()[0].check(asked, text)]
        lines = _slots(draft, asked) if do == "verdict" else list(draft.lines)
        at = int(said.get("at", len(lines) - 1))
        if not 0 <= at < len(lines):
            raise ValueError("There is no such line.")
        if do == "remove":
            return lines[:at] + lines[at + 1 :]
        if text.strip():
            read_verdict(text, at + 1, asked.graded)
        return [*lines[:at], " ".join(text.split())[:420], *lines[at + 1 :]]

    def _give(self, answer: Answer) -> None:
        self._answer = answer
        self._turn.notify_all()

    def _must_sit(self, page: str) -> None:
        if self._chair.seat(page) != "yours" and not self._chair.sit(page):
            raise Refused("This day is open on another page; take over there first.", overtaken=True)

    def _there(self) -> tuple[Sitting, Answers]:
        if self._sitting is None or self._answers is None:
            raise Refused("The home is still being opened.", overtaken=True)
        return self._sitting, self._answers

    def _status(self) -> Status:
        if self._ended:
            return "over"
        if self._sitting is None:
            return "opening"
        if self._waits_for_consent:
            return "consent"
        return "question" if self._question is not None and self._answer is None else "living"


_CHANGES = {"step": "tasks", "remove": "tasks", "verdict": "feedback"}


def _slots(draft: Draft, asked: Question) -> list[str]:
    """The answers so far, one place for each item."""
    return [*draft.lines, *[""] * len(asked.items)][: len(asked.items)]


def said_of(line: str) -> tuple[str, str]:
    """An answer of the evening as its choice (yes, no, a grade, skip or nothing) and its reason."""
    if not line:
        return "", ""
    choice, _, reason = line.partition(",")
    return choice.strip().lower(), reason.strip()
