"""What the robot learns from an evening: examples from feedback, and classifiers trained on all of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, TypeAlias

from pydantic import ValidationError

from core.clock import Clock
from core.errors import RunError
from core.hour import Example, FeedbackItem, HourRecord
from core.people import PersonId, Picture
from core.protocols import Classifier, Recorder
from core.randomness import seed_at

Kind: TypeAlias = Literal["intention", "task"]
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


def labelled(
    hours: Iterable[HourRecord], feedback: Sequence[FeedbackItem], picture: Picture
) -> dict[Kind, list[Example]]:
    """Turn a day's candidates and the person's yes and no into examples.

    The true intention, told in the evening, is one more positive (as in the authors' code). An answer that
    could not be read makes no example.
    """
    said: dict[tuple[int, Kind, str], bool | None] = {(f.hour, f.kind, f.text): f.helpful for f in feedback}
    examples: dict[Kind, list[Example]] = {"intention": [], "task": []}
    for hour in hours:
        if hour.robot is None or hour.human is None:
            continue
        known = {
            "clock": Clock(day=hour.episode_day, hour=hour.hour),
            "recalled": hour.robot.recalled,
            "picture": picture,
            "intentions": hour.robot.intentions,
        }
        truth = hour.human.intention.text
        for text, yes in {truth: True, **_verdicts(hour, said, "intention")}.items():
            examples["intention"].append(_label(example(known, hour.person, intention=text), yes))
        of = {task.act.describe(): task.intention for task in hour.robot.tasks}
        for text, yes in _verdicts(hour, said, "task").items():
            examples["task"].append(_label(example(known, hour.person, intention=of[text], task=text), yes))
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
    classifiers: dict[Kind, Classifier] = field(init=False)
    _day: int | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Start untrained."""
        self.forget()

    def forget(self) -> None:
        """Start a new episode: nothing learned."""
        self.classifiers = {kind: self.fresh[kind]() for kind in KINDS}
        self._day = None

    def be_at(self, learned_day: int | None) -> None:
        """Have the classifiers as they were after the evening of a day (None: untrained), reading them if need be."""
        if learned_day == self._day:
            return
        self.forget()
        if learned_day is not None:
            for kind in KINDS:
                self.classifiers[kind].load(self.recorder.adapters_folder(learned_day) / kind)
            self._day = learned_day

    def learn(
        self, day: int, earlier: Iterable[int], examples: Mapping[Kind, Sequence[Example]], picture: Picture, seed: int
    ) -> dict[str, Any]:
        """Train on the examples of this day and of the episode's earlier days, and save everything.

        In earlier examples of the same person the profile is replaced by the newest, as in the authors' code;
        DEVIATES: other people's examples keep theirs.

        Returns:
            What was measured, by kind.
        """
        learned: dict[str, Any] = {}
        self.forget()
        for kind in KINDS:
            today = list(examples[kind])
            before = [e for d in earlier for e in _read(self.recorder.adapters_folder(d) / kind / EXAMPLES)]
            people = {e.person for e in today}
            newest = {"profile": picture.profile or "", "big_five": picture.big_five}
            known = [e.model_copy(update=newest) if e.person in people else e for e in before]
            measured = self.classifiers[kind].train([*known, *today], seed=seed_at(seed, "learn", day, kind))
            folder = self.recorder.adapters_folder(day) / kind
            folder.mkdir(parents=True, exist_ok=True)
            _write(folder / EXAMPLES, today)
            self.classifiers[kind].save(folder)
            positives = sum(e.label is True for e in [*known, *today])
            learned[kind] = {"examples": len(known) + len(today), "positives": positives, **measured}
        self._day = day
        return learned


def _verdicts(hour: HourRecord, said: Mapping[tuple[int, Kind, str], bool | None], kind: Kind) -> dict[str, bool]:
    robot = hour.robot
    if robot is None:
        return {}
    texts = [c.text for c in robot.intentions] if kind == "intention" else [t.act.describe() for t in robot.tasks]
    answers = {text: said.get((hour.hour, kind, text)) for text in texts}
    return {text: answer for text, answer in answers.items() if answer is not None}


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
