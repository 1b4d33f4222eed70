"""From hand to hand: a robot brings a thing to a person, or is asked for it, or takes one over."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from coopera.core.household import HUMAN, AgentId, HandOver, plain
from coopera.simulation.acts.handling import arm_posture, to_body, turned_to_work
from coopera.simulation.acts.plans import APART, Give, Ground, Plan, UnableError, taken_by_others
from coopera.simulation.acts.walking import walk
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.state.agents import named
from coopera.simulation.state.home_state import HomeState, PersonState
from coopera.simulation.ways.navigation import RADIUS, Stand

HANDING = (APART, 1.25)
"""Nearest and farthest distance from the person's middle at which the robot hands over a thing."""
_TRIES = 24
_COMFORTABLE = 0.85


def receiver_of(state: HomeState, act: HandOver) -> AgentId:
    """Who is to get it: the person that the act names, or else the only one.

    Raises:
        UnableError: If it is not clear who that is.
    """
    people = state.ids("person")
    if act.receiver in people:
        return act.receiver
    if act.receiver is None and len(people) == 1:
        return people[0]
    wrong = "it is not said to whom" if act.receiver is None else f"there is no person {act.receiver!r}"
    raise UnableError(f"{wrong}; the people here are {', '.join(people) or 'none'}")


def give(ground: Ground, plan: Plan, robot: AgentId, person: AgentId, name: str, *, back: bool = False) -> None:
    """Add to a plan: the robot drives up to the person and hands over what it holds, or takes what the person holds.

    The hand that gets it must be empty.

    Raises:
        UnableError: If the robot cannot get within handing distance of the person.
    """
    body, carries = ground.robots[robot], None if back else name
    for stand in _before_person(ground, plan.state, robot, person):
        mark = plan.mark()
        try:
            walk(ground, plan, robot, (stand.x, stand.y), carries=carries)
        except UnableError:
            plan.rewind(mark)
            continue
        there = turned_to_work(ground, robot, _facing(stand, plan.state.person(person)))
        point = handing_point(plan.state.person(person), there)
        posture = arm_posture(ground, plan, body, there, to_body(there, point), None)
        if not HANDING[0] - 0.05 <= there.gap <= HANDING[1] or posture is None:
            plan.rewind(mark)
            continue
        plan.steps.append(Give(robot, person, there, posture, point, name, back))
        plan.state = plan.state.with_agent(robot, yaw=there.yaw).with_held(robot if back else person, name)
        return
    whom = "the person" if person == HUMAN else person
    raise UnableError(f"{named(robot)} cannot get within handing distance of {whom}")


def ask_for(ground: Ground, plan: Plan, agent: AgentId, holder: AgentId, thing: SceneObject) -> None:
    """Add to a plan: who holds a thing is asked for it. A robot brings it, and a person hands it to a robot.

    Raises:
        UnableError: If it is worn, or in use among people or among robots, or they cannot get to each other.
    """
    if plan.state.agents[holder].thing != thing.name:
        raise UnableError(f"{named(holder)} wears the {plain(thing.name)}")
    if holder in ground.robots and agent in ground.people:
        give(ground, plan, holder, agent, thing.name)
    elif agent in ground.robots and holder in ground.people:
        give(ground, plan, agent, holder, thing.name, back=True)
    else:
        raise UnableError(f"{named(holder)} holds the {plain(thing.name)}; it can be had once it is put down")


def _facing(stand: Stand, person: PersonState) -> Stand:
    """The same place, turned to the person, who may have had to step aside."""
    x, y = person.place
    yaw = math.atan2(y - stand.y, x - stand.x)
    return stand._replace(yaw=yaw, gap=math.dist((stand.x, stand.y), (x, y)))


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
