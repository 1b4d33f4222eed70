"""What the two can do: walk without running into each other, take a thing, put it down, hand it over.

A skill is planned completely before anything changes: the plan holds the steps (which a recording plays) and the
home as it will be afterwards. What cannot be planned raises `UnableError`, and the home stays as it was.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from core.errors import SimulationError
from core.household import Agent, HandOver, PickPlace, plain
from simulation import fetch
from simulation.humanoid_reach import reaching
from simulation.motions import Library, Motion
from simulation.navigation import Disc, Navigator, Route, Stand
from simulation.placing import free_places, full
from simulation.rotations import Array, wrapped
from simulation.scene import Point, Scene, SceneObject
from simulation.state import HomeState, PersonState, ThingState

APART = 0.60
"""Two standing bodies keep their middles this far apart (twice the navigation radius, metres)."""
_APART_SEATED = 0.50
_DETOUR = 4.0
"""Longest way around the other one, in metres more than the straight way, before they are asked to step aside."""
_FAR_REACH = 1.0
_TRIES = 24
HANDING = (APART, 1.25)
"""Nearest and farthest distance from the person's middle at which the robot hands over a thing."""
_COMFORTABLE = 0.85


class UnableError(SimulationError):
    """An act cannot be done; the text is the reason that its outcome gives."""


@dataclass(frozen=True, slots=True)
class Walk:
    """An agent goes along corner points, perhaps with a thing in hand (a name, or a text from the magic box)."""

    agent: Agent
    points: list[Point]
    carries: str | None = None


@dataclass(frozen=True, slots=True)
class Turn:
    """The robot turns on the spot to a heading."""

    yaw: float


@dataclass(frozen=True, slots=True)
class Handle:
    """An agent stands, reaches for a point and there takes a thing (`put` is None) or puts it down.

    `posture` is the body's pose, or the arm's posture, at the moment of the grasp.
    """

    agent: Agent
    stand: Stand
    posture: Array
    name: str
    put: ThingState | None


@dataclass(frozen=True, slots=True)
class Give:
    """The robot stands before the person and hands over a thing from the magic box at a point."""

    stand: Stand
    posture: Array
    point: tuple[float, float, float]
    thing: str


@dataclass(frozen=True, slots=True)
class Play:
    """The person does a motion at its place."""

    person: PersonState
    motion: Motion


Step = Walk | Turn | Handle | Give | Play


class Watch(Protocol):
    """Called before each deed of the person: lets the robot go where it will see it."""

    def __call__(self, plan: Plan, deed: Placed, spot: Point) -> None:
        """Add the robot's drive to the plan; the deed is the person in the middle of it."""
        ...


class Placed(NamedTuple):
    """A body on the floor plan, with its pose (person) or posture (robot)."""

    x: float
    y: float
    yaw: float
    pose: Array


@dataclass(slots=True)
class Plan:
    """Steps in order, the home afterwards, the distance the acting agent goes, and the furniture it acts at."""

    state: HomeState
    steps: list[Step] = field(default_factory=list)
    metres: float = 0.0
    at: list[str] = field(default_factory=list)
    motion: Motion | None = None


@dataclass(frozen=True, slots=True)
class Ground:
    """What never changes while a home is lived in."""

    scene: Scene
    navigator: Navigator
    library: Library
    search: Callable[[str], str] | None = None

    def fixed(self, name: str) -> SceneObject:
        """The piece of furniture of that name."""
        found = self.scene.object(name)
        if found is None:
            raise UnableError(f"there is no {plain(name)} ({name}) in this home")
        if not found.fixed:
            raise UnableError(f"the {plain(name)} is no piece of furniture")
        return found

    def movable(self, name: str) -> SceneObject:
        """The movable thing of that name."""
        found = self.scene.object(name)
        if found is None:
            raise UnableError(f"there is no {plain(name)} ({name}) in this home")
        if found.fixed:
            raise UnableError(f"the {plain(name)} cannot be carried")
        return found


def other(agent: Agent) -> Agent:
    """The one who is not acting."""
    return "robot" if agent == "human" else "human"


def discs(state: HomeState, agent: Agent) -> list[Disc]:
    """The floor that an agent takes up: where it stands, and where the person sits or would get up to."""
    if agent == "robot":
        return [Disc(*state.robot.spot)]
    person = state.person
    found = [Disc(*person.spot)]
    if math.dist(person.spot, person.place) > 0.1:
        found.append(Disc(*person.place, _APART_SEATED - fetch.RADIUS))
    return found


def clear_of(place: Point, taken: list[Disc]) -> bool:
    """Whether a standing body at a place touches none of the discs."""
    return all(math.dist(place, (disc.x, disc.y)) >= disc.radius + fetch.RADIUS - 1e-9 for disc in taken)


def stand_up(person: PersonState, spot: Point) -> PersonState:
    """The person standing about at a spot, with what they hold."""
    return PersonState(spot=spot, place=spot, yaw=person.yaw, thing=person.thing)


def walk(ground: Ground, plan: Plan, agent: Agent, goal: Point, carries: str | None = None) -> None:
    """Add a walk to a plan: around the other one, or past them once they have stepped aside.

    Raises:
        UnableError: If there is no way.
    """
    start = plan.state.spot(agent)
    route = ground.navigator.route(start, goal)
    if route.points is None:
        raise UnableError(f"the {agent} cannot get there: {route.reason}")
    hit = _in_the_way(route, discs(plan.state, other(agent)))
    if hit is not None:
        around = ground.navigator.route(start, goal, avoid=hit)
        if (
            around.points is not None
            and around.length <= route.length + _DETOUR
            and math.dist(around.points[-1], goal) < 0.08
            and _in_the_way(around, discs(plan.state, other(agent))) is None
        ):
            route = around
        else:
            _step_aside(ground, plan, other(agent), route)
    points = route.points or [start, goal]
    plan.steps.append(Walk(agent, points, carries))
    plan.metres += route.length
    last = points[-1]
    if agent == "human":
        plan.state = plan.state.model_copy(update={"person": stand_up(plan.state.person, last)})
    else:
        plan.state = plan.state.with_robot(spot=last)


def _in_the_way(route: Route, taken: list[Disc]) -> Disc | None:
    """The first disc that a walker on the route would touch; the start is left out, since they are there already."""
    points = route.points or []
    for disc in taken:
        need = disc.radius + fetch.RADIUS - 0.01
        for a, b in zip(points, points[1:], strict=False):
            if _to_line((disc.x, disc.y), a, b) < min(need, math.dist(points[0], (disc.x, disc.y)) - 0.01):
                return disc
    return None


def _to_line(point: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = dx * dx + dy * dy
    share = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / length if length > 0 else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (a[0] + share * dx, a[1] + share * dy))


def _step_aside(ground: Ground, plan: Plan, agent: Agent, route: Route) -> None:
    """Let the agent in the way go where the walker passes it."""
    here = plan.state.spot(agent)
    aside = ground.navigator.give_way(here, route.points or [])
    way = ground.navigator.route(here, aside) if aside is not None else None
    if way is None or way.points is None:
        raise UnableError(f"the {agent} stands in the way and has nowhere to step aside")
    plan.steps.append(Walk(agent, way.points))
    if agent == "human":
        plan.state = plan.state.model_copy(update={"person": stand_up(plan.state.person, way.points[-1])})
    else:
        plan.state = plan.state.with_robot(spot=way.points[-1])


def to_body(stand: Stand, point: tuple[float, float, float]) -> Array:
    """A point of the world in the frame of a body that stands there."""
    cos, sin = math.cos(stand.yaw), math.sin(stand.yaw)
    dx, dy = point[0] - stand.x, point[1] - stand.y
    return np.array((dx * cos + dy * sin, dy * cos - dx * sin, point[2]))


def posture_for(agent: Agent, stand: Stand, point: tuple[float, float, float]) -> Array | None:
    """How an agent that stands there gets its hand to a point of the world; None if it cannot."""
    target = to_body(stand, point)
    return reaching(target) if agent == "human" else fetch.reach(target)


def grip(thing: SceneObject, position: tuple[float, float, float]) -> tuple[float, float, float]:
    """Where a thing that stands at a position is held."""
    return position[0], position[1], position[2] + max(0.6 * thing.size[2], 0.02)


def stands_for(ground: Ground, plan: Plan, agent: Agent, on: SceneObject | None, point: Point) -> Iterator[Stand]:
    """Yield places to stand at to reach a point: clear of the other one first, near ones before stretched ones."""
    taken = discs(plan.state, other(agent))
    start = plan.state.spot(agent)
    later: list[Stand] = []
    for reach in (0.8, _FAR_REACH):
        found = (
            ground.navigator.approach(point, start, reach=reach)
            if on is None
            else ground.navigator.approach(on, start, point=point, reach=reach)
        )
        for stand in found:
            if clear_of((stand.x, stand.y), taken):
                yield stand
            else:
                later.append(stand)
    yield from later


def take(ground: Ground, plan: Plan, agent: Agent, thing: SceneObject, watch: Watch | None = None) -> None:
    """Add to a plan: go to a thing and take it.

    Raises:
        UnableError: If there is no place to stand, or the arm gets there from none.
    """
    where = plan.state.thing(thing)
    point = grip(thing, where.position)
    carrier = ground.scene.object(where.on) if where.on else None
    for tries, stand in enumerate(stands_for(ground, plan, agent, carrier, where.position[:2])):
        posture = posture_for(agent, stand, point)
        if posture is not None:
            _watched(watch, plan, stand, posture)
            walk(ground, plan, agent, (stand.x, stand.y))
            plan.steps.append(Handle(agent, stand, posture, thing.name, None))
            _face(plan, agent, stand)
            if carrier is not None:
                plan.at.append(carrier.name)
            return
        if tries >= _TRIES:
            break
    raise UnableError(f"the {agent} cannot reach the {plain(thing.name)}")


def put(
    ground: Ground,
    plan: Plan,
    agent: Agent,
    thing: SceneObject,
    receptacle: SceneObject,
    watch: Watch | None = None,
) -> None:
    """Add to a plan: carry a thing in hand to a piece of furniture and put it down there.

    Raises:
        UnableError: If the furniture is full or cannot be reached.
    """
    places = [
        place
        for place in free_places(ground.scene, plan.state, thing, receptacle)
        if not _sat_upon(plan.state, receptacle, place[:2])
    ]
    if not places:
        raise UnableError(full(receptacle, thing))
    for place in places[:: max(1, len(places) // 8)]:
        point = grip(thing, place[:3])
        for tries, stand in enumerate(stands_for(ground, plan, agent, receptacle, place[:2])):
            posture = posture_for(agent, stand, point)
            if posture is not None:
                _watched(watch, plan, stand, posture)
                walk(ground, plan, agent, (stand.x, stand.y), carries=thing.name)
                there = ThingState(position=place[:3], yaw=place.yaw, on=receptacle.name)
                plan.steps.append(Handle(agent, stand, posture, thing.name, there))
                plan.state = plan.state.with_thing(thing.name, there)
                _face(plan, agent, stand)
                plan.at.append(receptacle.name)
                return
            if tries >= 6:
                break
    raise UnableError(f"the {agent} cannot reach a free place on the {plain(receptacle.name)}")


def _watched(watch: Watch | None, plan: Plan, stand: Stand, posture: Array) -> None:
    if watch is not None:
        watch(plan, Placed(stand.x, stand.y, stand.yaw, posture), (stand.x, stand.y))


def _sat_upon(state: HomeState, receptacle: SceneObject, place: Point) -> bool:
    """Whether the person sits or lies just there."""
    person = state.person
    if person.posture == "stand" or receptacle.bounds.distance(*person.place) > 0:
        return False
    near = 0.35 if person.posture == "sit" else 0.8
    return math.dist(place, person.place) < near


def _face(plan: Plan, agent: Agent, stand: Stand) -> None:
    if agent == "human":
        plan.state = plan.state.with_person(yaw=stand.yaw)
    else:
        plan.state = plan.state.with_robot(yaw=stand.yaw)


def pick_place(ground: Ground, state: HomeState, agent: Agent, act: PickPlace, watch: Watch | None = None) -> Plan:
    """Plan a pick-and-place: go, take, go, put. What the agent held from the magic box goes back there.

    Raises:
        UnableError: With the reason why it cannot be done.
    """
    thing, receptacle = ground.movable(act.object), ground.fixed(act.receptacle)
    plan = Plan(state.with_person(thing=None) if agent == "human" else state.with_robot(thing=None))
    if agent == "human":
        plan.motion = ground.library["put things away on a shelf"]
    take(ground, plan, agent, thing, watch)
    put(ground, plan, agent, thing, receptacle, watch)
    plan.at.reverse()
    return plan


def hand_over(ground: Ground, state: HomeState, act: HandOver) -> Plan:
    """Plan a hand-over: a thing appears from the magic box in the gripper, goes to the person, and is given.

    What the person held from the box vanishes back into it.

    Raises:
        UnableError: If the robot cannot get within handing distance of the person.
    """
    plan = Plan(state.with_robot(thing=act.object))
    person = state.person
    for stand in _before_person(ground, state):
        point = handing_point(person, stand)
        posture = fetch.reach(to_body(stand, point))
        if posture is None:
            continue
        try:
            walk(ground, plan, "robot", (stand.x, stand.y), carries=act.object)
        except UnableError:
            continue
        plan.steps.append(Give(stand, posture, point, act.object))
        plan.state = plan.state.with_robot(thing=None, yaw=stand.yaw).with_person(thing=act.object)
        return plan
    raise UnableError("the robot cannot get within handing distance of the person")


def _before_person(ground: Ground, state: HomeState) -> list[Stand]:
    """Places within handing distance of the person, in their room: at a comfortable distance, ahead, and near first."""
    person, taken = state.person, discs(state, "human")
    found: list[tuple[float, Stand]] = []
    for x, y in ground.navigator.free_in(ground.scene.room_at(*person.place).name):
        gap = math.dist((x, y), person.place)
        if HANDING[0] <= gap <= HANDING[1] and clear_of((x, y), taken):
            towards = math.atan2(person.place[1] - y, person.place[0] - x)
            side = abs(wrapped(towards + math.pi - person.yaw))
            drive = math.dist((x, y), state.robot.spot)
            cost = abs(gap - _COMFORTABLE) + 0.2 * side + 0.1 * drive
            found.append((round(cost, 6), Stand(x, y, towards, drive, gap)))
    found.sort()
    return [stand for _, stand in found[:: max(1, len(found) // _TRIES)]]


def handing_point(person: PersonState, stand: Stand) -> tuple[float, float, float]:
    """Where a thing changes hands: in front of the person, towards the robot, at chest height."""
    x, y = person.place
    away = math.atan2(stand.y - y, stand.x - x)
    gap = min(0.42, math.dist((x, y), (stand.x, stand.y)) - 0.35)
    height = 1.0 if person.posture == "stand" else person.support + 0.45
    return x + gap * math.cos(away), y + gap * math.sin(away), height
