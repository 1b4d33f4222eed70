"""Reaching: where an agent stands so that its hand gets to a point, and how its body or arm does it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from coopera.core.household import AgentId, plain
from coopera.simulation.acts.plans import Ground, Placed, Plan, UnableError, Watch, clear_of, taken_by_others
from coopera.simulation.acts.walking import walk, walk_to_deed
from coopera.simulation.bodies.humanoid_reach import reaching
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.rotations import Array, about_z, wrapped
from coopera.simulation.ways.navigation import REACH, Stand

FAR_REACH = 1.0
_TRIES = 24
_POSTURES = 8


class Errand(NamedTuple):
    """A point that a hand should get to, the furniture it lies on, what is carried there, and how often to try.

    `reaches`: how far from the point one may stand (metres), the preferred distance first.
    """

    point: tuple[float, float, float]
    on: SceneObject | None
    carries: str | None = None
    tries: int = _TRIES
    reaches: tuple[float, ...] = (REACH, FAR_REACH)


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
    return reaching(target) if body is None else arm_posture(ground, plan, body, stand, target, errand.on)


def turned_to_work(ground: Ground, agent: AgentId, stand: Stand) -> Stand:
    """The same place, with the side on which a robot's arm works best turned to what it faced."""
    body = ground.robots.get(agent)
    return stand._replace(yaw=wrapped(stand.yaw - body.side)) if body is not None and body.side else stand


def arm_posture(
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


def why(plan: Plan) -> str:
    """What kept the arm from it, as the end of a sentence; empty where nothing is known."""
    return f": its arm would hit the {plain(plan.blocked)}" if plan.blocked else ""


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
    for tries, facing in enumerate(stands_for(ground, plan, agent, errand)):
        if tries >= errand.tries:
            break
        stand = turned_to_work(ground, agent, facing)
        posture = posture_for(ground, plan, agent, stand, errand)
        if posture is None:
            continue
        mark = plan.mark()
        try:
            if agent in ground.people:
                deed = Placed(stand.x, stand.y, stand.yaw, posture)
                walk_to_deed(ground, plan, agent, [deed], (stand.x, stand.y), watch, errand.carries)
            else:
                walk(ground, plan, agent, (stand.x, stand.y), carries=errand.carries)
        except UnableError:
            plan.rewind(mark)
            continue
        plan.state = plan.state.with_agent(agent, yaw=stand.yaw)
        return stand, posture
    return None
