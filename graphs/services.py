"""What the graphs' nodes work with: connections, processes and weights, passed as LangGraph's runtime context.

Nothing here is ever stored in state. Each graph has a context of its own, so a node cannot reach another agent's
secrets: a robot's holds neither the persona nor the person's memories (`coopera.graphs.robots.robot_view`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.clock import Clock
from coopera.core.hour import (
    DayPlan,
    HourRecord,
    HumanHour,
    Intention,
    Observation,
    SearchSizes,
    Task,
    TaskCandidate,
)
from coopera.core.household import HUMAN, ROBOT, AgentId, Outcome, SceneId
from coopera.core.people import Persona, PersonId
from coopera.core.protocols import Ask, Home, Recorder
from coopera.core.randomness import Address, rng_at
from coopera.core.success import Success
from coopera.graphs.players.answering import Answering
from coopera.graphs.players.contexts import GivenByCode
from coopera.graphs.players.living import Living
from coopera.graphs.players.person_models import FULL, PersonModel
from coopera.graphs.players.player import HumanContext, Player
from coopera.graphs.robots.learning import Learner
from coopera.graphs.robots.method import Method
from coopera.graphs.robots.own_robot import OwnRobot
from coopera.graphs.robots.robot_view import Memories
from coopera.memory import MemoryStream


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
        """Judge candidates, and what came of those that were done, against the true intention and remaining tasks.

        Measures for which somebody would have to wait are left out, to be taken by `complete`.
        """
        ...

    def misses(self, success: Success) -> bool:
        """Whether measures of an hour are still to be taken."""
        ...

    def complete(self, home: Home, at: Address, hour: HourRecord) -> Success:
        """Take the measures that a measured hour still misses, once its day is over."""
        ...


class Life(Protocol):
    """How a person's hour comes about: lived now, or on an earlier day that is met again."""

    def decide(self, services: Services, plan: DayPlan, clock: Clock) -> HumanHour:
        """What the person is up to this hour.

        Raises:
            HourError: If that could not be found out; the hour is then failed.
        """
        ...

    def show(self, services: Services, plan: DayPlan, clock: Clock, first: Task) -> tuple[Observation, Outcome]:
        """The person does the first task: what a robot sees of it, and what came of it."""
        ...

    def finish(self, services: Services, plan: DayPlan, clock: Clock, left: Sequence[Task]) -> list[Outcome]:
        """The person does what is left: what came of each task."""
        ...

    def end(self, services: Services, plan: DayPlan, clock: Clock, human: HumanHour | None) -> None:
        """Leave the home, and the person's memory, as they are after the hour; `human` is None if it failed early."""
        ...


@dataclass(frozen=True, slots=True)
class Services(GivenByCode):
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
    player: Player
    """Who plays the people."""
    life: Life
    """How their hours come about."""
    help_frames: int = 0
    """Pictures of each of the robot's acts, where any are taken."""
    video: bool = False
    """Whether the first task of each hour is filmed, too."""
    person: PersonModel = FULL
    """How people are simulated."""
    living: Living = Living()
    """How people live, whoever plays them."""
    answering: Answering = Answering()
    """How reliably they answer in the evening."""
    sizes: SearchSizes = SearchSizes()
    """How much Search finds for an intention."""
    identity_known: bool = True
    """Whether the robot is told whom it is with, or infers it (`coopera.graphs.robots.identity`)."""
    hourly_traits: bool = False
    """Whether the robot revises its belief about the person each hour, from its own guesses, or each evening."""
    stranger: Callable[[DayPlan, int], HumanHour | None] | None = None
    """What another person did in the same hour of their life, for a method whose robot is told of them instead."""
    own: OwnRobot | None = None
    """A robot of one's own with its evenings, where the method names one."""
    human_agent: AgentId = HUMAN
    """Whose body in the homes the person has."""
    robot_agent: AgentId = ROBOT
    """Whose body in the homes the robot has."""

    def here(self) -> Services:
        """The services of the node that runs now, which may ask a real person."""
        return replace(self, player=self.player.present())

    @property
    def looks_at_frames(self) -> bool:
        """Whether the robot may look at the hour's pictures: they are then there before it thinks."""
        return self.own is not None or self.ask.sees("robot")

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

    def human(self, plan: DayPlan) -> HumanContext:
        """The person's services for a day."""
        return HumanContext(
            ask=self.ask,
            persona=self.people[plan.person],
            plan=plan,
            home=self.home(plan.scene),
            memories=self.memories("human", plan.episode, plan.person),
            embeddings=self.embeddings,
            player=self.player,
            model=self.person,
            living=self.living,
            sizes=self.sizes,
            agent=self.human_agent,
            seed=self.seed,
        )

    def relative(self, path: Path) -> str:
        """A file's name as the trace gives it."""
        return path.relative_to(self.recorder.root).as_posix()
