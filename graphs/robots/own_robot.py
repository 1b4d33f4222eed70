"""Bring your own robot: two functions, under which any way of helping runs beside ours on the same human days.

A robot is a class with two functions. `help` answers an observation with candidates: intentions, and tasks to help
with. `learn` takes the person's account in the evening. A `Method` with the class in its field `own` runs it in place
of our graph:

    METHOD = Method(name="stubborn", own=Stubborn)

`coopera.check_method(METHOD)` says whether it keeps to the rules below, and an entry point makes it a choice of
`coopera run --method`:

    [project.entry-points."coopera.methods"]
    stubborn = "my_package:METHOD"

The rules: within an hour a robot knows its `RobotView`, and nothing else, so two lives that look alike are the same to
it. Between hours it does not change, since an
interrupted hour is done again, perhaps in another process. Its guesses of earlier today are in `view.guesses`, the
accounts of earlier days in `view.history`. `learn` gives the same result for the same evenings in the same order with
the same seeds. Every draw comes from `coopera.core.randomness`.
"""

from __future__ import annotations

import inspect
import logging
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeAlias, runtime_checkable

from langchain_core.embeddings import Embeddings
from pydantic import ValidationError

from coopera.core.errors import ConfigError, CooperaError, RunError
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import Collab
from coopera.core.people import Persona, PersonId
from coopera.core.protocols import Recorder
from coopera.core.randomness import seed_at
from coopera.graphs.robots.robot_view import RobotView

_LOG = logging.getLogger(__name__)
ACCOUNT = "account.json"
_ACT = {1: "pick_place", 2: "hand_over"}


class Robot(Protocol):
    """A robot of one's own. It is made anew, without arguments, for each episode and after each resumption."""

    def help(self, view: RobotView, /) -> Proposal:
        """Say what the person may be up to and which tasks would help, each with a verdict.

        Args:
            view: All that a robot may know of the hour.

        Raises:
            ModelOutputError: If a model's reply cannot be used; the hour is then unscored, not wrong.
        """
        ...

    def learn(self, account: DayAccount, /, *, seed: int) -> dict[str, Any]:
        """Learn from an evening; returns what was measured in training, as plain numbers and words."""
        ...


MakeRobot: TypeAlias = Callable[[], Robot]
KnowPeople: TypeAlias = Callable[[Mapping[PersonId, str], Mapping[PersonId, Persona], Any, Embeddings], Robot]
"""Makes a ceiling from the texts that people live by, who they are, their household file, and a sentence encoder."""


@runtime_checkable
class Saves(Protocol):
    """A robot that keeps its learned state itself; any other is taught its evenings again when a run is resumed."""

    def save(self, folder: Path) -> None:
        """Write the learned state in open formats (no pickle), whole or not at all."""
        ...

    def load(self, folder: Path) -> None:
        """Read what `save` wrote.

        Raises:
            CooperaError: If the folder holds no such state, or a damaged one; the evenings are then taught again.
        """
        ...


@dataclass(slots=True)
class OwnRobot:
    """A robot of one's own with its evenings on file; stands in the day graph where our `Learner` stands."""

    make: MakeRobot
    recorder: Recorder
    seed: int = 0
    robot: Robot = field(init=False)
    _days: tuple[int, ...] = field(init=False, default=())

    def __post_init__(self) -> None:
        """Start with a robot that has learned nothing.

        Raises:
            ConfigError: If its `help` takes anything but the view.
        """
        self.robot = self.make()
        takes = inspect.signature(self.robot.help)
        try:
            takes.bind(None)
        except TypeError as err:
            name = type(self.robot).__name__
            raise ConfigError(f"{name}.help must take the RobotView alone, help(self, view), not {takes}.") from err

    def be_at(self, learned: Sequence[int]) -> None:
        """Have the robot as it was after the evenings of these days of the run, in order.

        Raises:
            RunError: If an evening's file is damaged.
        """
        days = tuple(learned)
        if days == self._days:
            return
        self.robot, self._days = self.make(), days
        if days and isinstance(self.robot, Saves):
            try:
                self.robot.load(self._folder(days[-1]))
                return
            except CooperaError as err:
                _LOG.warning("%s: its evenings are taught again", err)
                self.robot = self.make()
        for day in days:
            self._teach(day, _read(self._account(day)))

    def learn(self, day: int, earlier: Sequence[int], account: DayAccount) -> dict[str, Any]:
        """Teach an evening, on top of those of the earlier days, and keep it on file."""
        self.be_at(earlier)
        path = self._account(day)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part")
        part.write_text(account.model_dump_json(), encoding="utf-8")
        os.replace(part, path)
        measured = self._teach(day, account)
        if isinstance(self.robot, Saves):
            self._folder(day).mkdir(parents=True, exist_ok=True)
            self.robot.save(self._folder(day))
        self._days = (*earlier, day)
        return measured

    def _teach(self, day: int, account: DayAccount) -> dict[str, Any]:
        return self.robot.learn(account, seed=seed_at(self.seed, "learn", day))

    def _account(self, day: int) -> Path:
        return self.recorder.adapters_folder(day) / ACCOUNT

    def _folder(self, day: int) -> Path:
        return self.recorder.adapters_folder(day) / "robot"


def checked(proposal: Proposal, collab: Collab, method: str) -> Proposal:
    """Return a proposal that keeps to the rules; a task said twice counts once, the first time.

    Raises:
        RunError: Naming the method, the candidate and what was expected.
    """
    if not isinstance(proposal, Proposal):
        raise RunError(
            f"method {method}: help must return a coopera.core.hour.Proposal, not {type(proposal).__name__}."
        )
    once: dict[str, TaskCandidate] = {}
    for task in proposal.tasks:
        if task.act.kind != _ACT[collab]:
            raise RunError(
                f'method {method}: the task "{task.act.describe()}" must be a {_ACT[collab]} in collaboration '
                f"type {collab}, not a {task.act.kind}."
            )
        once.setdefault(task.act.describe(), task.model_copy(update={"correct": None}))
    candidates: list[tuple[str, IntentionCandidate | TaskCandidate]] = [(c.text, c) for c in proposal.intentions]
    for text, candidate in [*candidates, *once.items()]:
        if candidate.accepted is None:
            raise RunError(f'method {method}: "{text}" must be accepted or not, but accepted is None.')
        if candidate.probability is not None and not 0 <= candidate.probability <= 1:
            raise RunError(
                f'method {method}: the probability of "{text}" must lie in [0, 1], not {candidate.probability}.'
            )
    return proposal.model_copy(update={"tasks": list(once.values())})


def _read(path: Path) -> DayAccount:
    try:
        return DayAccount.model_validate_json(path.read_text(encoding="utf-8"))
    except (OSError, ValidationError) as err:
        raise RunError(f"{path}: what the robot was told this evening cannot be read: {err}") from err
