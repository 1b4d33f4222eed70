"""The truth of a home: where everybody and everything is, as plain frozen data.

Metres and radians; a heading of 0 looks along +x. An object's room is never stored, since its place tells it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field, model_validator

from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT, AgentId
from coopera.core.people import Frozen
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.library import Posture

_CARRIED = 1.0
Kind: TypeAlias = Literal["person", "robot"]


class PersonState(Frozen):
    """A person: `spot` is the place on the floor from which they walk off, `place` where the body is.

    The two differ where the person sits or lies on something. `support`, `worktop` and `posture` are those of
    `coopera.simulation.motions.poses.Setting`. The person holds `thing` from the magic box and is `at` a furniture.
    """

    kind: Literal["person"] = "person"
    spot: Point
    place: Point
    yaw: float = 0.0
    support: float = 0.0
    worktop: float | None = None
    posture: Posture = "stand"
    motion: str = "stand and wait"
    thing: str | None = None
    at: str | None = None


class RobotState(Frozen):
    """A robot: its base on the floor, and what it holds from the magic box."""

    kind: Literal["robot"] = "robot"
    spot: Point
    yaw: float = 0.0
    thing: str | None = None

    @property
    def place(self) -> Point:
        """Where the body is on the floor plan: a robot is where it stands."""
        return self.spot


AgentState = Annotated[PersonState | RobotState, Field(discriminator="kind")]


class ThingState(Frozen):
    """Where a movable thing is: the centre of its base, its turn, and the furniture it stands on (None: the floor)."""

    position: tuple[float, float, float]
    yaw: float
    on: str | None


class HomeState(Frozen):
    """The whole truth at a moment between two acts; `moved` holds only what is not in its initial place."""

    version: Literal[2] = 2
    scene: str
    agents: dict[AgentId, AgentState]
    """Everybody in the home, in the order in which they were put into it."""
    moved: dict[str, ThingState] = Field(default_factory=dict)

    @model_validator(mode="before")
    @classmethod
    def _of_any_version(cls, data: Any) -> Any:
        return today(data) if isinstance(data, Mapping) else data

    @property
    def inhabitants(self) -> list[str]:
        """Who lives here, in words, sorted: such as "human (person)"."""
        return sorted(f"{agent} ({state.kind})" for agent, state in self.agents.items())

    def ids(self, kind: Kind) -> list[AgentId]:
        """The ids of the people, or of the robots."""
        return [agent for agent, state in self.agents.items() if state.kind == kind]

    def the(self, kind: Kind, agent: AgentId | None = None) -> AgentId:
        """Who is meant: the person (or robot) of that id, or without one the only person of the home.

        Raises:
            SimulationError: If there is no such person, or none was named and there is not just one.
        """
        known = self.ids(kind)
        if agent in known:
            return agent
        if agent is None and len(known) == 1:
            return known[0]
        if not known:
            raise SimulationError(f"There is no {kind} in this home.")
        wrong = f"no {kind} {agent!r}" if agent is not None else f"more than one {kind}"
        raise SimulationError(f"There is {wrong} in this home; name one of {', '.join(known)}.")

    def agent(self, agent: AgentId) -> PersonState | RobotState:
        """One agent's state.

        Raises:
            SimulationError: If nobody of that id lives here.
        """
        if agent not in self.agents:
            raise SimulationError(f"There is no agent {agent!r} in this home; there are {', '.join(self.agents)}.")
        return self.agents[agent]

    def person(self, agent: AgentId | None = None) -> PersonState:
        """A person's state, or that of the only person: as `the` says."""
        found = self.agents[self.the("person", agent)]
        assert isinstance(found, PersonState)
        return found

    def robot(self, agent: AgentId | None = None) -> RobotState:
        """A robot's state, or that of the only robot: as `the` says."""
        found = self.agents[self.the("robot", agent)]
        assert isinstance(found, RobotState)
        return found

    def holder(self, thing: str) -> AgentId | None:
        """Who has a movable thing of the scene in their hand."""
        return next((agent for agent, state in self.agents.items() if state.thing == thing), None)

    def thing(self, initial: SceneObject) -> ThingState:
        """Where a movable thing of the scene is now; what somebody holds is with them, on nothing."""
        holder = self.holder(initial.name)
        if holder is not None:
            return ThingState(position=(*self.agents[holder].place, _CARRIED), yaw=0.0, on=None)
        return self.moved.get(initial.name) or ThingState(position=initial.position, yaw=initial.yaw, on=initial.on)

    def with_thing(self, name: str, where: ThingState) -> HomeState:
        """The same home with one thing put elsewhere."""
        moved = {**self.moved, name: where}
        return self.model_copy(update={"moved": {key: moved[key] for key in sorted(moved)}})

    def with_agent(self, agent: AgentId, **change: object) -> HomeState:
        """The same home with an agent changed."""
        return self.put(agent, self.agents[agent].model_copy(update=change))

    def put(self, agent: AgentId, state: PersonState | RobotState) -> HomeState:
        """The same home with an agent in another state."""
        return self.model_copy(update={"agents": {**self.agents, agent: state}})


def today(snapshot: Mapping[str, Any]) -> Mapping[str, Any]:
    """A snapshot in today's form: those of version 1 had just one person and one robot, and no ids."""
    person, robot = snapshot.get("person"), snapshot.get("robot")
    if not isinstance(person, Mapping) or not isinstance(robot, Mapping) or snapshot.get("version") != 1:
        return snapshot
    rest = {key: value for key, value in snapshot.items() if key not in ("version", "person", "robot")}
    return {**rest, "version": 2, "agents": {HUMAN: {"kind": "person", **person}, ROBOT: {"kind": "robot", **robot}}}


def digest(snapshot: Mapping[str, Any]) -> str:
    """The SHA-256 of a snapshot in canonical JSON: equal for equal homes, in every process."""
    text = json.dumps(snapshot, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def room_of_thing(scene: Scene, state: HomeState, initial: SceneObject) -> str:
    """The room in which a movable thing now is."""
    x, y, _ = state.thing(initial).position
    return scene.room_at(x, y).name
