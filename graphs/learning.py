"""What the robot learns from an evening: examples from feedback, and classifiers trained on all of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from core.clock import Clock
from core.errors import RunError
from core.hour import DayPlan, Example, FeedbackItem, HourRecord, Told, ToldHour
from core.people import PersonId, Picture
from core.protocols import Classifier, Recorder
from core.randomness import seed_at
from graphs.method import Kind

__all__ = ["EXAMPLES", "KINDS", "Kind", "Learner", "example", "labelled", "told_of"]

KINDS: tuple[Kind, Kind] = ("intention", "task")
EXAMPLES = "examples.jsonl"


def example(state: Mapping[str, Any], person: PersonId, *, intention: str, task: str | None = None) -> Example:
    """What a classifier is shown of a candidate in the robot's present state (PAPER App. C.2).

    Args:
        state: With the keys `clock`, `recalled`, `picture` and `intentions` of `RobotState`.
        person: Whom the robot is with.
        intention: The candidate, or the intention that a candidate task belongs to.
        task: The candidate task in words.
    """
    picture: Picture = state["picture"]
    recalled = state["recalled"]
    order = [candidate.text for candidate in state["intentions"]]
    return Example(
        person=person,
        day=state["clock"].day,
        hour=state["clock"].hour,
        candidate=task if task is not None else intention,
        intention=intention if task is not None else "",
        profile=picture.profile or "",
        big_five=picture.big_five,
        intentions=[m.text for m in recalled if m.kind == "intention"],
        tasks=[m.text for m in recalled if m.kind == "task"],
        rank=order.index(intention) if intention in order else None,
    )


def told_of(plan: DayPlan, hours: Iterable[HourRecord], feedback: Iterable[FeedbackItem], picture: Picture) -> Told:
    """What the person tells of a day: the true intentions and tasks, and the answers; failed hours are left out."""
    answers: dict[int, list[FeedbackItem]] = {}
    for item in feedback:
        answers.setdefault(item.hour, []).append(item)
    lived = [
        ToldHour(
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
    return Told(person=plan.person, day=plan.episode_day, hours=lived, picture=picture)


def labelled(told: Told) -> dict[Kind, list[Example]]:
    """Turn a day's candidates and the person's yes and no into examples.

    The true intention, told in the evening, is one more positive (as in the authors' code). An answer that
    could not be read makes no example.
    """
    examples: dict[Kind, list[Example]] = {"intention": [], "task": []}
    for hour in told.hours:
        known = {
            "clock": Clock(day=told.day, hour=hour.hour),
            "recalled": hour.robot.recalled,
            "picture": told.picture,
            "intentions": hour.robot.intentions,
        }
        said: dict[Kind, dict[str, bool]] = {kind: _answers(hour, kind) for kind in KINDS}
        imagined = [c.text for c in hour.robot.intentions if c.text in said["intention"]]
        verdicts = {hour.intention: True, **{text: said["intention"][text] for text in imagined}}
        for text, yes in verdicts.items():
            examples["intention"].append(_label(example(known, told.person, intention=text), yes))
        for task in hour.robot.tasks:
            text = task.act.describe()
            if text in said["task"]:
                shown = example(known, told.person, intention=task.intention, task=text)
                examples["task"].append(_label(shown, said["task"][text]))
    return examples


@dataclass(slots=True)
class Learner:
    """The robot's two classifiers and what they were trained on; the files of a run are the truth.

    Attributes:
        fresh: Makes an untrained classifier of a kind.
        classifiers: The classifiers in use, by kind.
    """

    fresh: Mapping[Kind, Callable[[], Classifier]]
    recorder: Recorder
    seed: int = 0
    classifiers: dict[Kind, Classifier] = field(init=False)
    _day: int | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Start untrained."""
        self.forget()

    def forget(self) -> None:
        """Start a new episode: nothing learned."""
        self.classifiers = {kind: self.fresh[kind]() for kind in KINDS}
        self._day = None

    def be_at(self, learned: Sequence[int]) -> None:
        """Have the classifiers as they were after the evenings of these days of the run, reading them if need be."""
        learned_day = learned[-1] if learned else None
        if learned_day == self._day:
            return
        self.forget()
        if learned_day is not None:
            for kind in KINDS:
                self.classifiers[kind].load(self.recorder.adapters_folder(learned_day) / kind)
            self._day = learned_day

    def learn(self, day: int, earlier: Sequence[int], told: Told) -> dict[str, Any]:
        """Train on the examples of this day and of the episode's earlier days, and save everything.

        In earlier examples of the same person the profile is replaced by the newest, as in the authors' code;
        DEVIATES: other people's examples keep theirs.

        Returns:
            What was measured, by kind.
        """
        learned: dict[str, Any] = {}
        examples = labelled(told)
        newest = {"profile": told.picture.profile or "", "big_five": told.picture.big_five}
        self.forget()
        for kind in KINDS:
            today = examples[kind]
            before = [e for d in earlier for e in _read(self.recorder.adapters_folder(d) / kind / EXAMPLES)]
            known = [e.model_copy(update=newest) if e.person == told.person else e for e in before]
            measured = self.classifiers[kind].train([*known, *today], seed=seed_at(self.seed, "learn", day, kind))
            folder = self.recorder.adapters_folder(day) / kind
            folder.mkdir(parents=True, exist_ok=True)
            _write(folder / EXAMPLES, today)
            self.classifiers[kind].save(folder)
            positives = sum(e.label is True for e in [*known, *today])
            learned[kind] = {"examples": len(known) + len(today), "positives": positives, **measured}
        self._day = day
        return learned


def _answers(hour: ToldHour, kind: Kind) -> dict[str, bool]:
    return {item.text: item.helpful for item in hour.feedback if item.kind == kind and item.helpful is not None}


def _label(unlabelled: Example, yes: bool) -> Example:
    return unlabelled.model_copy(update={"label": yes})


def _write(path: Path, examples: Sequence[Example]) -> None:
    part = path.with_suffix(".part")
    part.write_text("".join(f"{e.model_dump_json()}\n" for e in examples), encoding="utf-8")
    os.replace(part, path)


def _read(path: Path) -> list[Example]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
        return [Example.model_validate_json(line) for line in lines]
    except (OSError, ValidationError) as err:
        raise RunError(f"{path}: the training examples of this day cannot be read: {err}") from err
