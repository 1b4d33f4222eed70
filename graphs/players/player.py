"""Who plays the person, and what they work with: a language model, the log of a real person, or one who is asked."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple, Protocol, runtime_checkable

from langchain_core.embeddings import Embeddings
from typing_extensions import TypedDict

from coopera.core.clock import Clock
from coopera.core.hour import (
    DayPlan,
    Found,
    HumanHour,
    Intention,
    Recalled,
    Reflection,
    RobotHour,
    SearchSizes,
    Task,
)
from coopera.core.household import HUMAN, AgentId, Collab
from coopera.core.people import Circumstance, Persona
from coopera.core.protocols import Ask, Home
from coopera.graphs.players.changes import Change
from coopera.graphs.players.evening import Lived
from coopera.graphs.players.living import Living
from coopera.graphs.players.person_models import FULL, PersonModel
from coopera.graphs.players.real_person import Verdict
from coopera.graphs.players.reflecting import Draft, Opinion
from coopera.graphs.robots.robot_view import Memories
from coopera.memory import Search


class HumanInput(TypedDict):
    """What starts a person's hour; `hours` are all hours of the day, in order."""

    clock: Clock
    hours: list[int]


class HumanState(HumanInput, total=False):
    """Working state of the person's hour; a key is absent until its node has run."""

    recalled: list[Recalled]  # by recall; intentions first, best first
    today: list[dict[str, Any]]  # by recall; this day's intentions so far, in order
    intention: Intention  # by propose
    circumstances: list[Circumstance]  # by propose: what is different that day
    found: Found  # by search
    can: dict[str, list[str]]  # by search; {furniture: what can be done there, the nearest to the intention first}
    tasks: list[Task]  # by decompose, then revised by merge
    stated: bool  # by decompose: a real person has said what the tasks are
    wrong: list[str]  # by decompose and merge: what code finds wrong with the tasks
    profile_says: Opinion  # by reflect_profile
    scene_says: Opinion  # by reflect_scene
    reflections: Annotated[list[Reflection], operator.add]  # by merge, in order
    repairs: list[str]  # by mend


@dataclass(frozen=True, slots=True)
class HumanContext:
    """The person's services for a day in a home."""

    ask: Ask
    persona: Persona
    plan: DayPlan
    home: Home
    memories: Memories
    embeddings: Embeddings
    player: Player
    model: PersonModel = FULL
    sizes: SearchSizes = SearchSizes()
    living: Living = Living()
    agent: AgentId = HUMAN
    """Whose body in the home the person has."""
    seed: int = 0
    """What the run's draws derive from."""

    def changes(self, clock: Clock) -> Sequence[Change]:
        """What is different for the person on a day."""
        return self.living.changes(self.persona.id, clock.day)

    @property
    def collab(self) -> Collab:
        """The collaboration type of the day."""
        return self.plan.collab

    def search(self, texts: Sequence[str]) -> Search:
        """Search over a fixed list of texts (object names, motion captions)."""
        return Search(self.embeddings, list(texts))


class Decomposed(NamedTuple):
    """An intention as tasks; `stated` where a real person has said what they are, so that no model revises them."""

    drafts: Sequence[Draft]
    stated: bool


class Player(Protocol):
    """Who decides for the person, and answers for them in the evening.

    Raises:
        ModelOutputError: From each method, if a language model's reply cannot be used.
    """

    one_by_one: ClassVar[bool]
    """Whether they are asked one thing after another, since somebody answers; a model is asked everything at once."""

    def intention(self, state: HumanState, ctx: HumanContext) -> Intention:
        """What the person wants to do this hour. Reads `clock`, `recalled`, `today`."""
        ...

    def tasks(self, state: HumanState, ctx: HumanContext) -> Decomposed:
        """What they will do for it, in order. Reads `intention`, `found` and `recalled`, too."""
        ...

    def verdicts(self, clock: Clock, ctx: HumanContext, human: HumanHour, robot: RobotHour) -> list[Verdict]:
        """What they say in the evening of each intention, then of each task, that the robot imagined in an hour."""
        ...

    def present(self) -> Player:
        """The player as the node that runs now reaches them; nothing is asked before."""
        ...


@runtime_checkable
class Attending(Protocol):
    """A player who is there in the evening and is asked about the whole day at once."""

    def evening(self, ctx: HumanContext, hours: Sequence[Lived]) -> list[list[Verdict]]:
        """What they say of each intention, then of each task, that the robot imagined: a list for each hour."""
        ...
