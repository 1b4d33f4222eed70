"""What the robot learns from an evening: examples from feedback, and classifiers trained on them."""

from __future__ import annotations

import json
import logging
import os
import shutil
import sys
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from gzip import GzipFile
from io import TextIOWrapper
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias

from coopera.core.clock import Clock
from coopera.core.errors import CooperaError, LearningError, RunError
from coopera.core.hour import (
    CandidateKind,
    DayAccount,
    DayPlan,
    Example,
    FeedbackItem,
    HourAccount,
    HourRecord,
    IntentionCandidate,
    Recalled,
)
from coopera.core.household import use_of
from coopera.core.people import Belief, PersonId
from coopera.core.protocols import Classifier, Recorder
from coopera.core.randomness import seed_at
from coopera.graphs.robots.rehearsal import REHEARSED, keep
from coopera.graphs.robots.turns import still_counts, things_of

__all__ = ["EXAMPLES", "KEPT", "KINDS", "Known", "Learner", "Mode", "example", "labelled", "account_of"]

KINDS: tuple[CandidateKind, CandidateKind] = ("intention", "task")
EXAMPLES, KEPT, TOLD = "examples.jsonl", "kept.jsonl.gz", "told.json"
KEPT_PLAIN = "kept.jsonl"
"""The same in runs of earlier versions, which did not pack it."""
Mode: TypeAlias = Literal["warm", "fresh"]
_LOG = logging.getLogger(__name__)


class Known(NamedTuple):
    """What the robot knows in an hour of which it judges a candidate; `intentions` are its own, in its order."""

    person: PersonId
    clock: Clock
    belief: Belief
    recalled: Sequence[Recalled]
    intentions: Sequence[IntentionCandidate]


def example(
    known: Known, *, intention: str, task: str | None = None, evidence: Mapping[str, float] | None = None
) -> Example:
    """What a classifier is shown of a candidate (PAPER App. C.2).

    Args:
        known: What the robot knows now.
        intention: The candidate, or the intention that a candidate task belongs to.
        task: The candidate task in words.
        evidence: What speaks for the candidate, where the method counts that.
    """
    order = [candidate.text for candidate in known.intentions]
    return Example(
        person=known.person,
        day=known.clock.day,
        hour=known.clock.hour,
        candidate=task if task is not None else intention,
        intention=intention if task is not None else "",
        profile=known.belief.profile or "",
        big_five=known.belief.big_five,
        intentions=[m.text for m in known.recalled if m.kind == "intention"],
        tasks=[m.text for m in known.recalled if m.kind == "task"],
        rank=order.index(intention) if intention in order else None,
        evidence=dict(evidence or {}),
    )


def account_of(
    plan: DayPlan, hours: Iterable[HourRecord], feedback: Iterable[FeedbackItem], belief: Belief
) -> DayAccount:
    """The person's account of a day: the true intentions and tasks, and the feedback; failed hours are left out."""
    answers: dict[int, list[FeedbackItem]] = {}
    for item in feedback:
        answers.setdefault(item.hour, []).append(item.model_copy(update={"slip": False}))
    lived = [
        HourAccount(
            hour=hour.hour,
            intention=hour.human.intention.text,
            tasks=[task.act for task in hour.human.tasks],
            robot=hour.robot.model_copy(
                update={"tasks": [task.model_copy(update={"correct": None}) for task in hour.robot.tasks]}
            ),
            feedback=answers.get(hour.hour, []),
        )
        for hour in hours
        if hour.human is not None and hour.robot is not None
    ]
    return DayAccount(person=plan.person, day=plan.episode_day, hours=lived, belief=belief)


def labelled(account: DayAccount) -> dict[CandidateKind, list[Example]]:
    """Turn a day's candidates and the person's yes and no into examples.

    The true intention of the account is one more positive (as in the authors' code). An unreadable answer makes no
    example.
    """
    examples: dict[CandidateKind, list[Example]] = {"intention": [], "task": []}
    for hour in account.hours:
        clock = Clock(day=account.day, hour=hour.hour)
        known = Known(account.person, clock, account.belief, hour.robot.recalled, hour.robot.intentions)
        said: dict[CandidateKind, dict[str, bool]] = {kind: _answers(hour, kind) for kind in KINDS}
        imagined = [c.text for c in hour.robot.intentions if c.text in said["intention"]]
        verdicts = {hour.intention: True, **{text: said["intention"][text] for text in imagined}}
        evidence = {c.text: c.evidence for c in hour.robot.intentions}
        for text, yes in verdicts.items():
            examples["intention"].append(_label(example(known, intention=text, evidence=evidence.get(text)), yes))
        for task in hour.robot.tasks:
            text = task.act.describe()
            if text in said["task"]:
                shown = example(known, intention=task.intention, task=text, evidence=task.evidence)
                examples["task"].append(_label(shown, said["task"][text]))
    return examples


@dataclass(slots=True)
class Learner:
    """The robot's two classifiers and what they were trained on; the files of a run are the truth.

    Attributes:
        fresh: Makes an untrained classifier of a kind.
        mode: "warm" goes on from the evening before, with the day's examples and a fixed number of earlier ones, so
            that no evening takes longer than another. "fresh" starts anew on all examples, as the authors' code does.
        replay: That number, by kind.
        turns: Whether examples from before a turn in their person's life count less (`graphs.robots.turns`).
        classifiers: The classifiers in use, by kind.
    """

    fresh: Mapping[CandidateKind, Callable[[], Classifier]]
    recorder: Recorder
    seed: int = 0
    mode: Mode = "warm"
    replay: Mapping[CandidateKind, int] = field(default_factory=lambda: dict.fromkeys(KINDS, REHEARSED))
    turns: bool = False
    classifiers: dict[CandidateKind, Classifier] = field(init=False)
    _days: tuple[int, ...] | None = field(init=False, default=None)  # None: in no state that is on file

    def __post_init__(self) -> None:
        """Start untrained."""
        self._forget()

    def be_at(self, learned: Sequence[int]) -> None:
        """Have the classifiers as they were after the evenings of these days of the run, reading them if need be.

        An unreadable one (damaged, cut short, of another base) is trained again from the records, with the same result.
        The training starts from the last day with a whole classifier.

        Raises:
            RunError: If the records of the examples cannot be read either.
        """
        days = tuple(learned)
        if days == self._days:
            return
        self._forget()
        for kind in KINDS:
            self._recover(kind, days)
        self._days = days

    def learn(self, day: int, earlier: Sequence[int], account: DayAccount) -> dict[str, Any]:
        """Train on an evening, on top of those of the episode's earlier days, and save everything.

        A classifier that cannot learn from it stays as it was, and `failed` says why.

        Returns:
            What was measured, by kind.

        Raises:
            CooperaError: If something cannot be saved; nothing is then learned, and the evening can be done again.
        """
        self.be_at(earlier)
        self._days = None
        examples = labelled(account)
        if self.turns:
            _write_told(self.recorder.adapters_folder(day) / TOLD, account)
        learned: dict[str, Any] = {}
        for kind in KINDS:
            _write(self._folder(day, kind) / EXAMPLES, examples[kind])
            learned[kind] = self._train(kind, day, earlier)
        self._days = (*earlier, day)
        return learned

    def _forget(self) -> None:
        self.classifiers = {kind: self.fresh[kind]() for kind in KINDS}
        self._days = ()

    def _recover(self, kind: CandidateKind, days: Sequence[int]) -> None:
        """Load the last classifier that is whole and train those after it again."""
        for done in range(len(days), 0, -1):
            try:
                self.classifiers[kind].load(self._folder(days[done - 1], kind))
                break
            except CooperaError as err:
                _LOG.warning("%s; it is trained again", err)
                self.classifiers[kind] = self.fresh[kind]()
        else:
            done = 0
        for position in range(done, len(days)):
            self._train(kind, days[position], days[:position])

    def _train(self, kind: CandidateKind, day: int, earlier: Sequence[int]) -> dict[str, Any]:
        """Train one classifier on an evening whose examples are on file, and save it."""
        folder = self._folder(day, kind)
        today = _read(folder / EXAMPLES)
        known = _renewed(self._before(kind, earlier), today)
        if self.mode == "fresh":
            self.classifiers[kind] = self.fresh[kind]()
        else:
            _write(folder / KEPT, keep(known, self.replay[kind]))
        if self.turns:
            self._weigh(known, [*earlier, day])
        measured: dict[str, Any] = {"examples": len(known), "positives": sum(e.label is True for e in known)}
        try:
            measured |= self.classifiers[kind].train(known, seed=seed_at(self.seed, "learn", day, kind))
        except LearningError as err:
            measured["failed"] = str(err)
        self.classifiers[kind].save(folder)
        return measured

    def _before(self, kind: CandidateKind, earlier: Sequence[int]) -> list[Example]:
        """The earlier examples to learn from again: all of them, or those that were kept."""
        if self.mode == "warm" and earlier:
            try:
                return _read(_kept_file(self._folder(earlier[-1], kind)))
            except RunError as err:
                _LOG.warning("%s; they are chosen again", err)
        every: list[Example] = []
        for day in earlier:
            today = _read(self._folder(day, kind) / EXAMPLES)
            every = _renewed(every, today)
        return every if self.mode == "fresh" else keep(every, self.replay[kind])

    def _weigh(self, examples: Sequence[Example], days: Sequence[int]) -> None:
        """Have each example, just read, count what its day still counts for its person."""
        told: dict[PersonId, dict[int, tuple[str, ...]]] = {}
        for day in days:
            person, hours = _read_told(self.recorder.adapters_folder(day) / TOLD)
            told.setdefault(person, {}).update(hours)
        counts = {person: still_counts(tuple(sorted(hours.items()))) for person, hours in told.items()}
        for one in examples:
            _put(one, counts=counts.get(one.person, {}).get(one.day, 1.0))

    def _folder(self, day: int, kind: CandidateKind) -> Path:
        return self.recorder.adapters_folder(day) / kind


def _renewed(before: Sequence[Example], today: Sequence[Example]) -> list[Example]:
    """Earlier examples, just read, and today's; those of today's person get the newest profile (the authors' code).

    DEVIATES: other people's examples keep theirs.
    """
    newest = {e.person: e for e in today}
    for one in before:
        if (now := newest.get(one.person)) is not None:
            _put(one, profile=now.profile, big_five=now.big_five)
    return [*before, *today]


def _put(own: Example, **values: Any) -> None:
    """Change an example that was just read, which nobody else has yet: to copy thousands each evening costs more."""
    own.__dict__.update(values)


def _answers(hour: HourAccount, kind: CandidateKind) -> dict[str, bool]:
    return {item.text: item.helpful for item in hour.feedback if item.kind == kind and item.helpful is not None}


def _label(unlabelled: Example, yes: bool) -> Example:
    return unlabelled.model_copy(update={"label": yes})


def _write_told(path: Path, account: DayAccount) -> None:
    hours = [
        (Clock(day=account.day, hour=hour.hour).now, [use for act in hour.tasks if (use := use_of(act.describe()))])
        for hour in account.hours
    ]
    _save(path, [json.dumps({"person": account.person, "things": dict(things_of(hours))})])


def _read_told(path: Path) -> tuple[PersonId, dict[int, tuple[str, ...]]]:
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
        return said["person"], {
            int(now): tuple(sorted({sys.intern(str(thing)) for thing in used})) for now, used in said["things"].items()
        }
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as err:
        raise RunError(f"{path}: what was told on this day cannot be read: {err}") from err


def _write(path: Path, examples: Iterable[Example]) -> None:
    _save(path, (f"{e.model_dump_json()}\n" for e in examples))


def _save(path: Path, lines: Iterable[str]) -> None:
    part = path.with_suffix(".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with _packed(part, "wb") if path.name == KEPT else part.open("w", encoding="utf-8") as file:
            file.writelines(lines)
        os.replace(part, path)
    except OSError as err:
        raise RunError(f"{path}: the training examples of this day cannot be saved: {err}") from err


def _read(path: Path) -> list[Example]:
    try:
        shared: dict[Any, Any] = {}
        packed = path.name == KEPT
        with _packed(path, "rb") if packed else path.open(encoding="utf-8", newline="\n") as lines:
            return [_sharing(Example.model_validate_json(line), shared) for line in lines]
    except (OSError, EOFError, zlib.error, ValueError) as err:
        raise RunError(f"{path}: the training examples of this day cannot be read: {err}") from err


@contextmanager
def _packed(path: Path, mode: Literal["rb", "wb"]) -> Iterator[TextIOWrapper]:
    """Open a gzip file of lines; what is written depends on the lines alone, not on the time."""
    with (
        path.open(mode) as file,
        GzipFile("", mode, 6, file, mtime=0) as bare,
        TextIOWrapper(bare, encoding="utf-8", newline="\n") as text,  # a text may hold other ends of lines
    ):
        yield text


def _kept_file(folder: Path) -> Path:
    """The file of the examples kept; in a run of an earlier version it may be a plain one."""
    plain = folder / KEPT_PLAIN
    return plain if plain.is_file() and not (folder / KEPT).is_file() else folder / KEPT


def unpack_kept(folder: Path) -> None:
    """Write the examples kept as earlier versions did, for a run of one that has lost them."""
    with _packed(folder / KEPT, "rb") as lines, (folder / KEPT_PLAIN).open("w", encoding="utf-8", newline="\n") as file:
        shutil.copyfileobj(lines, file)


def _sharing(read: Example, shared: dict[Any, Any]) -> Example:
    """Have an example just read share what equals a part of one before: thousands then take half of their memory."""
    parts = read.__dict__
    for name in ("person", "candidate", "intention", "profile", "big_five"):
        parts[name] = shared.setdefault(parts[name], parts[name])
    for name in ("intentions", "tasks"):
        parts[name] = shared.setdefault(tuple(parts[name]), parts[name])
    given = read.__pydantic_fields_set__  # a third of what an example takes
    object.__setattr__(read, "__pydantic_fields_set__", shared.setdefault(frozenset(given), given))
    return read
