"""The types for planning an act in the home: steps, plans, the floor that a body takes up, and refusals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import shorten
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import affordances
from coopera.core.errors import SimulationError
from coopera.core.household import AgentId, plain
from coopera.simulation.bodies.elbowroom import Elbowroom
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.catalogue import Rest
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.library import Library, Meant, Motion, Rank
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.state.home_state import AgentState, HomeState, PersonState, ThingState
from coopera.simulation.ways.navigation import RADIUS, Disc, Navigator, Stand

APART = 0.60
"""Two standing bodies keep their middles this far apart (twice the navigation radius, metres)."""
_APART_SEATED = 0.50
_LONGEST = 299
_OFF = 0.1
"""A body this far from the spot where it would stand is on a piece of furniture (metres)."""


class UnableError(SimulationError):
    """An act cannot be done; the text is the reason that its outcome gives."""

    @property
    def sentence(self) -> str:
        """The reason as one line of at most 300 characters, also where a name in it is long or odd."""
        return f"{shorten(str(self), _LONGEST, placeholder=' …')}."


@dataclass(frozen=True, slots=True)
class Walk:
    """An agent goes along corner points, perhaps with a thing in hand (a name, or a text from the magic box)."""

    agent: AgentId
    points: list[Point]
    carries: str | None = None


@dataclass(frozen=True, slots=True)
class Turn:
    """A robot turns on the spot to a heading."""

    agent: AgentId
    yaw: float


@dataclass(frozen=True, slots=True)
class Handle:
    """An agent stands, reaches for a point and there takes a thing (`put` is None) or puts it down.

    `posture` is the body's pose, or the arm's posture, at the moment of the grasp.
    """

    agent: AgentId
    stand: Stand
    posture: Array
    name: str
    put: ThingState | None


@dataclass(frozen=True, slots=True)
class Open:
    """An agent stands at furniture (or a thing) with a lid, a door or a drawer, and opens or closes it."""

    agent: AgentId
    stand: Stand
    posture: Array
    name: str
    opens: bool


@dataclass(frozen=True, slots=True)
class Give:
    """A robot stands before a person and hands over a thing at a point; `back`: it takes the thing instead."""

    agent: AgentId
    receiver: AgentId
    stand: Stand
    posture: Array
    point: tuple[float, float, float]
    thing: str
    back: bool = False


@dataclass(frozen=True, slots=True)
class Dress:
    """A person has put something on or taken it off: what they wear then, and what is in their hand."""

    agent: AgentId
    worn: tuple[str, ...]
    thing: str | None


@dataclass(frozen=True, slots=True)
class Play:
    """A person does a motion at its place."""

    agent: AgentId
    person: PersonState
    motion: Motion


Step = Walk | Turn | Handle | Open | Give | Dress | Play


class Watch(Protocol):
    """Called before each act of a person: lets a robot go where it will see it."""

    @property
    def robot(self) -> AgentId:
        """Who watches."""
        ...

    def __call__(self, plan: Plan, deeds: Sequence[Placed], spot: Point) -> None:
        """Add the robot's drive to the plan; `deeds` is the person at some moments of the act, at least one."""
        ...


class Placed(NamedTuple):
    """A body on the floor plan, with its pose (person) or posture (robot)."""

    x: float
    y: float
    yaw: float
    pose: Array


class Mark(NamedTuple):
    """How far a plan had got."""

    state: HomeState
    steps: int
    metres: float
    at: int
    fetched: int
    opened: int


@dataclass(slots=True)
class Plan:
    """Steps in order, the home afterwards, the distance the acting agent goes, and the furniture it acts at.

    `blocked` names what last kept the robot's arm from a posture that it could otherwise have taken. `in_hand` is what
    the act is done with; `fetched` and `opened` are what that took; `meant` is the motion of a free-form task.
    """

    state: HomeState
    steps: list[Step] = field(default_factory=list)
    metres: float = 0.0
    at: list[str] = field(default_factory=list)
    blocked: str | None = None
    in_hand: str | None = None
    fetched: list[str] = field(default_factory=list)
    opened: list[str] = field(default_factory=list)
    meant: Meant | None = None

    def mark(self) -> Mark:
        """Remember where the plan stands."""
        return Mark(self.state, len(self.steps), self.metres, len(self.at), len(self.fetched), len(self.opened))

    def rewind(self, mark: Mark) -> None:
        """Forget all that was planned since a mark."""
        self.state, self.metres = mark.state, mark.metres
        del self.steps[mark.steps :], self.at[mark.at :], self.fetched[mark.fetched :], self.opened[mark.opened :]


@dataclass(frozen=True, slots=True)
class Ground:
    """What never changes while a home is lived in: who lives there is part of it, a robot with its body."""

    scene: Scene
    navigator: Navigator
    motions: Library
    people: tuple[AgentId, ...]
    robots: Mapping[AgentId, RobotBody]
    room: Elbowroom
    rank: Rank | None = None
    seats: dict[str, tuple[SceneObject, Rest] | None] = field(default_factory=dict, repr=False, compare=False)
    """The seat that serves each piece of furniture while nobody sits anywhere; filled in as it is asked for."""

    def fixed(self, name: str, number: int | None = None) -> SceneObject:
        """The piece of furniture of that name, and of that id if one is said."""
        found = _known(self.scene.object(name), name, number)
        if not found.fixed:
            raise UnableError(f"the {plain(name)} is no piece of furniture")
        return found

    def movable(self, state: HomeState, name: str, number: int | None = None) -> SceneObject:
        """The movable thing of that name, and of that id if one is said; it may be out of the magic box."""
        found = _known(state.find(self.scene, name), name, number)
        if found.fixed:
            raise UnableError(f"the {plain(name)} cannot be carried")
        return found

    def receptacle(self, state: HomeState, name: str, number: int | None = None) -> SceneObject:
        """The furniture, or the thing that holds others, of that name."""
        found = _known(state.find(self.scene, name), name, number)
        if not found.fixed and not affordances().contains(found.cls):
            raise UnableError(f"the {plain(name)} is no piece of furniture")
        return found


def on_furniture(body: AgentState) -> bool:
    """Whether somebody sits, lies or stands on a piece of furniture."""
    return math.dist(body.spot, body.place) > _OFF


def discs(state: HomeState, agent: AgentId) -> list[Disc]:
    """The floor taken up by an agent: its place, and for a sitting person also the place to get up to."""
    body = state.agents[agent]
    found = [Disc(*body.spot)]
    if on_furniture(body):
        found.append(Disc(*body.place, _APART_SEATED - RADIUS))
    return found


def floor_of_others(state: HomeState, agent: AgentId, *but: AgentId) -> dict[AgentId, list[Disc]]:
    """The floor that each of the others takes up, but for some."""
    return {one: discs(state, one) for one in state.agents if one != agent and one not in but}


def taken_by_others(state: HomeState, agent: AgentId) -> list[Disc]:
    """The floor that all the others take up."""
    return [disc for found in floor_of_others(state, agent).values() for disc in found]


def clear_of(place: Point, taken: list[Disc]) -> bool:
    """Whether a standing body at a place touches none of the discs."""
    return bool(all_clear_of(np.array([place]), taken)[0])


def all_clear_of(places: Array, taken: list[Disc]) -> NDArray[np.bool_]:
    """The same for each of many places; shape (n, 2) to (n,)."""
    clear = np.ones(len(places), dtype=bool)
    for disc in taken:
        clear &= np.hypot(places[:, 0] - disc.x, places[:, 1] - disc.y) >= disc.radius + RADIUS - 1e-9
    return clear


def _known(found: SceneObject | None, name: str, number: int | None) -> SceneObject:
    if found is None:
        raise UnableError(f"there is no {plain(name)} ({name}) in this home")
    if number is not None and found.id != number:
        raise UnableError(f"{name} has the id {found.id}, not {number}")
    return found


def stand_up(ground: Ground, state: HomeState, agent: AgentId, spot: Point) -> HomeState:
    """The home with a person standing about at a spot, with what they hold and wear.

    What they had switched on for what they were doing goes off, unless another one uses it, too.
    """
    person = state.person(agent)
    for name in person.switched:
        thing = state.find(ground.scene, name)
        shared = any(name in state.person(one).switched for one in state.ids("person") if one != agent)
        if thing is not None and not shared:
            state = state.with_condition(thing, {"powered": False})
    risen = PersonState(spot=spot, place=spot, yaw=person.yaw, thing=person.thing, worn=person.worn)
    return state.put(agent, risen)
