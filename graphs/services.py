"""What the graphs' nodes work with: connections, processes and weights, passed as LangGraph's runtime context.

Nothing here is ever stored in state. Each graph has a context of its own, so that a node cannot reach what
its agent must not know: `RobotContext` holds neither the persona nor the person's memories.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Intention, LoggedHour, SearchSizes, Success, Task, TaskCandidate
from coopera.core.household import HUMAN, ROBOT, AgentId, Collab, Outcome, SceneId
from coopera.core.people import Persona, PersonId
from coopera.core.protocols import Ask, Home, Recorder
from coopera.core.randomness import Address, rng_at
from coopera.graphs.earlier_life import Lived
from coopera.graphs.learning import Learner
from coopera.graphs.method import Method
from coopera.graphs.own_robot import OwnRobot, Robot
from coopera.graphs.person import FULL, PersonModel
from coopera.graphs.real_person import Interview
from coopera.memory import MemoryStream, Record, Search


class Memories(NamedTuple):
    """The two streams an agent keeps of a person: one of intentions, one of tasks."""

    intentions: MemoryStream
    tasks: MemoryStream

    def forget_from(self, now: int) -> None:
        """Drop what is of this hour or later, before an hour is done (again)."""
        self.intentions.forget_from(now)
        self.tasks.forget_from(now)

    def add(self, intention: str, tasks: Sequence[str], now: int) -> None:
        """Append one hour."""
        self.extend([(now, intention, tasks)])

    def extend(self, hours: Iterable[tuple[int, str, Sequence[str]]]) -> None:
        """Append hours, each with its intention and tasks, at once: a write takes the store as long as an hour's do."""
        added = list(hours)
        self.intentions.extend([Record(intention, now, {}) for now, intention, _ in added])
        self.tasks.extend([Record(task, now, {}) for now, _, tasks in added for task in tasks])


@dataclass(frozen=True, slots=True)
class HumanContext:
    """The person's services for a day in a home."""

    ask: Ask
    persona: Persona
    collab: Collab
    home: Home
    memories: Memories
    embeddings: Embeddings
    model: PersonModel = FULL
    sizes: SearchSizes = SearchSizes()
    logged: LoggedHour | None = None
    """What a real person wrote down of this hour."""
    interview: Interview | None = None
    """How a real person in the loop is asked."""

    def search(self, texts: Sequence[str]) -> Search:
        """Search over a fixed list of texts (object names, motion captions)."""
        return Search(self.embeddings, list(texts))


@dataclass(frozen=True, slots=True)
class RobotContext:
    """The robot's services for a day: no persona, no memory of the person's own.

    `history` holds what the person told in the evenings; `guesses` what the robot itself inferred, of
    which only today's count, since the evening replaces them by the truth.
    """

    ask: Ask
    person: PersonId
    collab: Collab
    method: Method
    home: Home
    history: Memories
    guesses: Memories
    learner: Learner
    own: Robot | None
    """A robot of one's own, as it is after its last evening; None where our graph helps."""
    images: Path
    """The folder to which the observation's frames are relative."""
    agent: AgentId = ROBOT
    """Whose body in the home the robot has."""


def nothing_was_logged(_plan: DayPlan, _clock: Clock) -> None:
    """Nobody wrote anything down: the person is simulated."""


class Score(Protocol):
    """The measure of an hour; `coopera.evaluation.success` has the real one."""

    def __call__(
        self,
        home: Home,
        at: Address,
        intention: Intention,
        remaining: Sequence[Task],
        candidates: Sequence[TaskCandidate],
        outcomes: Sequence[Outcome] = (),
    ) -> tuple[list[TaskCandidate], Success]:
        """Judge candidates, and what came of those that were done, against the true intention and remaining tasks."""
        ...


@dataclass(frozen=True, slots=True)
class Services:
    """Everything a run works with; the day and study graphs derive each agent's context from it.

    `home` opens a scene once and keeps it. `stream` opens a memory stream by name. `images` is the root
    against which frames are relative.
    """

    ask: Ask
    method: Method
    people: Mapping[PersonId, Persona]
    home: Callable[[SceneId], Home]
    stream: Callable[[str], MemoryStream]
    embeddings: Embeddings
    learner: Learner
    recorder: Recorder
    score: Score
    seed: int
    frames: int
    """Sampled moments per hour and viewpoint; 0 renders nothing."""
    video: bool = False
    """Whether the first task of each hour is filmed, too."""
    person: PersonModel = FULL
    """How people are simulated."""
    sizes: SearchSizes = SearchSizes()
    """How much Search finds for an intention."""
    lived: Lived | None = None
    """Days that were lived before, which the people live again; by default they live new ones."""
    logged: Callable[[DayPlan, Clock], LoggedHour | None] = nothing_was_logged
    """What a real person wrote down of an hour."""
    in_the_loop: bool = False
    """Whether a real person is asked, by interrupts."""
    graded: bool = False
    """Whether the evening's feedback is grades from 1 to 5 instead of yes or no."""
    interview: Interview | None = None
    """How the node that runs now asks the person; set by the day graph."""
    identity_known: bool = True
    """Whether the robot is told whom it is with, or guesses it (`coopera.graphs.identity`)."""
    hourly_traits: bool = False
    """Whether the robot revises its belief about the person each hour, from its own guesses, or each evening."""
    own: OwnRobot | None = None
    """A robot of one's own with its evenings, where the method names one."""
    human_agent: AgentId = HUMAN
    """Whose body in the homes the person has."""
    robot_agent: AgentId = ROBOT
    """Whose body in the homes the robot has."""

    @property
    def pupil(self) -> Learner | OwnRobot:
        """Who learns in the evening."""
        return self.own or self.learner

    def rng(self, address: Address) -> np.random.Generator:
        """The generator of an address in this run."""
        return rng_at(self.seed, *address)

    def memories(self, owner: str, episode: int, person: PersonId) -> Memories:
        """The streams of one owner ("human", "history" or "guesses") about a person in an episode."""
        stem = f"{owner}/{episode}/{person}"
        return Memories(self.stream(f"{stem}/intentions"), self.stream(f"{stem}/tasks"))

    def relative(self, path: Path) -> str:
        """A file's name as the trace gives it."""
        return path.relative_to(self.recorder.root).as_posix()
