"""What people and robots can do: take a thing, put it down, hand it over.

A skill is planned completely before anything changes: the plan holds the steps (which a recording plays) and the
home as it will be afterwards. What cannot be planned raises `UnableError`, and the home stays as it was.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from coopera.core.household import HUMAN, AgentId, HandOver, PickPlace, plain
from coopera.simulation.acts.agents import named
from coopera.simulation.acts.free_places import free_places, full
from coopera.simulation.acts.home_check import FLOOR_REACH
from coopera.simulation.acts.navigation import RADIUS, REACH, Stand
from coopera.simulation.acts.plans import (
    APART,
    Give,
    Ground,
    Handle,
    Placed,
    Plan,
    UnableError,
    Watch,
    clear_of,
    taken_by_others,
)
from coopera.simulation.acts.state import HomeState, PersonState, ThingState
from coopera.simulation.acts.walking import walk, walk_to_deed
from coopera.simulation.bodies.humanoid_reach import reaching
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.rotations import Array, about_z

_FAR_REACH = 1.0
_TRIES = 24
_POSTURES = 8
HANDING = (APART, 1.25)
"""Nearest and farthest distance from the person's middle at which the robot hands over a thing."""
_COMFORTABLE = 0.85


class Errand(NamedTuple):
    """A point that a hand should get to, the furniture it lies on, what is carried there, and how often to try.

    `reaches`: how far from the point one may stand (metres), the preferred distance first.
    """

    point: tuple[float, float, float]
    on: SceneObject | None
    carries: str | None = None
    tries: int = _TRIES
    reaches: tuple[float, ...] = (REACH, _FAR_REACH)


def to_body(stand: Stand, point: tuple[float, float, float]) -> Array:
    """A point of the world in the frame of a body that stands there."""
    cos, sin = math.cos(stand.yaw), math.sin(stand.yaw)
    dx, dy = point[0] - stand.x, point[1] - stand.y
    return np.array((dx * cos + dy * sin, dy * cos - dx * sin, point[2]))


def posture_for(ground: Ground, plan: Plan, agent: AgentId, stand: Stand, errand: Errand) -> Array | None:
    """How an agent that stands there gets its hand to a point of the world; None if it cannot.

    A robot's arm must keep clear of furniture and walls; what it would hit is noted in the plan.
    """
    target = to_body(stand, errand.point)
    body = ground.robots.get(agent)
    return reaching(target) if body is None else _arm_posture(ground, plan, body, stand, target, errand.on)


def _arm_posture(
    ground: Ground, plan: Plan, body: RobotBody, stand: Stand, target: Array, on: SceneObject | None
) -> Array | None:
    """A robot's first posture that reaches a point of its body frame and keeps the arm clear."""
    heading, place = about_z(stand.yaw).T, np.array((stand.x, stand.y, 0.0))
    for posture in islice(body.reach(target), _POSTURES):
        hit = ground.room.hit(body.arm(posture) @ heading + place, target @ heading + place, on)
        if hit is None:
            return posture
        plan.blocked = hit
    return None


def grip(thing: SceneObject, position: tuple[float, float, float]) -> tuple[float, float, float]:
    """Where a thing that stands at a position is held."""
    return position[0], position[1], position[2] + max(0.6 * thing.size[2], 0.02)


def stands_for(ground: Ground, plan: Plan, agent: AgentId, errand: Errand) -> Iterator[Stand]:
    """Yield places to stand at to reach a point: clear of the others first, near ones before stretched ones."""
    taken = taken_by_others(plan.state, agent)
    start = plan.state.agents[agent].spot
    later: list[Stand] = []
    on, point = errand.on, errand.point[:2]
    for reach in errand.reaches:
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


def go_to_reach(
    ground: Ground, plan: Plan, agent: AgentId, errand: Errand, watch: Watch | None = None
) -> tuple[Stand, Array] | None:
    """Add a walk to where an agent's hand gets to a point; with `watch`, a robot goes first to see the act.

    Returns:
        The place, and the posture in which the point is reached; None if there is no such place.
    """
    for tries, stand in enumerate(stands_for(ground, plan, agent, errand)):
        if tries >= errand.tries:
            break
        posture = posture_for(ground, plan, agent, stand, errand)
        if posture is None:
            continue
        mark = plan.mark()
        try:
            if agent in ground.people:
                deed = Placed(stand.x, stand.y, stand.yaw, posture)
                walk_to_deed(ground, plan, agent, deed, (stand.x, stand.y), watch, errand.carries)
            else:
                walk(ground, plan, agent, (stand.x, stand.y), carries=errand.carries)
        except UnableError:
            plan.rewind(mark)
            continue
        plan.state = plan.state.with_agent(agent, yaw=stand.yaw)
        return stand, posture
    return None


def take(ground: Ground, plan: Plan, agent: AgentId, thing: SceneObject, watch: Watch | None = None) -> None:
    """Add to a plan: go to a thing and take it.

    Raises:
        UnableError: If there is no place to stand, or the arm gets there from none, or another one holds the thing.
    """
    holder = plan.state.holder(thing.name)
    if holder is not None and holder != agent:
        raise UnableError(f"{named(holder)} holds the {plain(thing.name)}")
    where = plan.state.thing(thing)
    carrier = ground.scene.object(where.on) if where.on else None
    found = go_to_reach(ground, plan, agent, Errand(grip(thing, where.position), carrier), watch)
    if found is None:
        raise UnableError(f"{named(agent)} cannot reach the {plain(thing.name)}{_why(plan)}")
    plan.steps.append(Handle(agent, *found, thing.name, None))
    if carrier is not None:
        plan.at.append(carrier.name)


def put(
    ground: Ground, plan: Plan, agent: AgentId, thing: SceneObject, receptacle: SceneObject, watch: Watch | None = None
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
    for far in (False, True):  # first where the other one can take it, too
        for place in places[:: max(1, len(places) // 8)]:
            reach = _FAR_REACH if far else FLOOR_REACH if place.z < 0.1 else REACH
            errand = Errand(grip(thing, place[:3]), receptacle, thing.name, tries=8, reaches=(reach,))
            found = go_to_reach(ground, plan, agent, errand, watch)
            if found is not None:
                there = ThingState(position=place[:3], yaw=place.yaw, on=receptacle.name)
                plan.steps.append(Handle(agent, *found, thing.name, there))
                plan.state = plan.state.with_thing(thing.name, there)
                plan.at.append(receptacle.name)
                return
    raise UnableError(f"{named(agent)} cannot reach a free place on the {plain(receptacle.name)}{_why(plan)}")


def _why(plan: Plan) -> str:
    return f": its arm would hit the {plain(plan.blocked)}" if plan.blocked else ""


def _sat_upon(state: HomeState, receptacle: SceneObject, place: Point) -> bool:
    """Whether somebody sits or lies just there."""
    for person in map(state.person, state.ids("person")):
        if person.posture != "stand" and receptacle.bounds.distance(*person.place) <= 0:
            near = 0.35 if person.posture == "sit" else 0.8
            if math.dist(place, person.place) < near:
                return True
    return False


def pick_place(ground: Ground, state: HomeState, agent: AgentId, act: PickPlace, watch: Watch | None = None) -> Plan:
    """Plan a pick-and-place: go, take, go, put. What the agent held from the magic box goes back there.

    Raises:
        UnableError: With the reason why it cannot be done.
    """
    thing, receptacle = ground.movable(act.object), ground.fixed(act.receptacle)
    if agent in ground.robots:
        _refuse_full_gripper(ground, state, agent)
    plan = Plan(emptied(state, agent))
    take(ground, plan, agent, thing, watch)
    put(ground, plan, agent, thing, receptacle, watch)
    plan.at.reverse()
    return plan


def hand_over(ground: Ground, state: HomeState, agent: AgentId, act: HandOver) -> Plan:
    """Plan a hand-over: a thing appears from the magic box in a gripper, goes to a person, and is given.

    What the person held from the box vanishes back into it.

    Raises:
        UnableError: If the robot cannot get within handing distance of the person, or it is not clear who that is.
    """
    receiver = _receiver(state, act)
    _refuse_full_gripper(ground, state, agent)
    plan = Plan(emptied(state, agent).out_of_box(ground.scene, agent, act.object))
    name = str(plan.state.agents[agent].thing)
    person, body = state.person(receiver), ground.robots[agent]
    for stand in _before_person(ground, state, agent, receiver):
        point = handing_point(person, stand)
        posture = _arm_posture(ground, plan, body, stand, to_body(stand, point), None)
        if posture is None:
            continue
        mark = plan.mark()
        try:
            walk(ground, plan, agent, (stand.x, stand.y), carries=name)
        except UnableError:
            plan.rewind(mark)
            continue
        plan.steps.append(Give(agent, receiver, stand, posture, point, name))
        plan.state = emptied(plan.state.with_agent(agent, yaw=stand.yaw), receiver).with_held(receiver, name)
        return plan
    whom = "the person" if receiver == HUMAN else receiver
    raise UnableError(f"{named(agent)} cannot get within handing distance of {whom}")


def emptied(state: HomeState, agent: AgentId) -> HomeState:
    """The home with what an agent held from the magic box back in it."""
    held = state.agents[agent].thing
    return state.into_box(held) if held in state.box else state


def _receiver(state: HomeState, act: HandOver) -> AgentId:
    """Who is to get it: the person that the act names, or else the only one."""
    people = state.ids("person")
    if act.receiver in people:
        return act.receiver
    if act.receiver is None and len(people) == 1:
        return people[0]
    wrong = "it is not said to whom" if act.receiver is None else f"there is no person {act.receiver!r}"
    raise UnableError(f"{wrong}; the people here are {', '.join(people) or 'none'}")


def _refuse_full_gripper(ground: Ground, state: HomeState, agent: AgentId) -> None:
    """What a robot took by a single step (see primitives) does not go back by itself."""
    held = state.agents[agent].thing
    if held is not None and ground.scene.object(held) is not None:
        raise UnableError(f"{named(agent)} must first put down the {plain(held)}")


def _before_person(ground: Ground, state: HomeState, agent: AgentId, receiver: AgentId) -> Iterator[Stand]:
    """Places within handing distance of a person, in their room: at a comfortable distance, ahead, and near first."""
    here = _where_it_is(ground, state, agent, receiver)
    if here is not None:
        yield here
    person, robot = state.person(receiver), state.agents[agent]
    cells = ground.navigator.cells_in(ground.scene.room_at(*person.place).name)
    cells = cells[(np.abs(cells - np.array(person.place)) <= HANDING[1]).all(axis=1)]
    gap = np.hypot(*(cells - np.array(person.place)).T)
    near = (gap >= HANDING[0]) & (gap <= HANDING[1])
    for disc in taken_by_others(state, agent):
        near &= np.hypot(*(cells - np.array((disc.x, disc.y))).T) >= disc.radius + RADIUS
    cells, gap = cells[near], gap[near]
    towards = np.arctan2(person.place[1] - cells[:, 1], person.place[0] - cells[:, 0])
    side = np.abs(np.remainder(towards - person.yaw, math.tau) - math.pi)  # 0 straight ahead of the person
    drive = np.hypot(*(cells - np.array(robot.spot)).T)
    cost = np.round(np.abs(gap - _COMFORTABLE) + 0.2 * side + 0.1 * drive, 6)
    order = np.argsort(cost, kind="stable")
    for i in order[:: max(1, len(order) // _TRIES)]:
        yield Stand(float(cells[i, 0]), float(cells[i, 1]), float(towards[i]), float(drive[i]), float(gap[i]))


def _where_it_is(ground: Ground, state: HomeState, agent: AgentId, receiver: AgentId) -> Stand | None:
    """A robot's own place, if it is already before the person, in the same room and within handing distance."""
    (x, y), person = state.agents[agent].spot, state.person(receiver)
    gap = math.dist((x, y), person.place)
    together = ground.scene.room_at(x, y) == ground.scene.room_at(*person.place)
    if not (together and HANDING[0] <= gap <= HANDING[1]):
        return None
    return Stand(x, y, math.atan2(person.place[1] - y, person.place[0] - x), 0.0, gap)


def handing_point(person: PersonState, stand: Stand) -> tuple[float, float, float]:
    """Where a thing changes hands: in front of the person, towards the robot, at chest height."""
    x, y = person.place
    away = math.atan2(stand.y - y, stand.x - x)
    gap = min(0.42, math.dist((x, y), (stand.x, stand.y)) - 0.35)
    height = 1.0 if person.posture == "stand" else person.support + 0.45
    return x + gap * math.cos(away), y + gap * math.sin(away), height
