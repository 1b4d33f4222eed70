"""How agents stand and hold things between two acts, and who turns to whom.

A robot's head turns to a person, and a person to a robot that hands them something.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from coopera.core.household import AgentId
from coopera.simulation.acts.handling import to_body
from coopera.simulation.acts.plans import Give, Ground, Placed
from coopera.simulation.acts.workplace import working
from coopera.simulation.bodies.humanoid_reach import reaching
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.motions.aids import Used
from coopera.simulation.motions.holding import CARRIED, Grip
from coopera.simulation.motions.poses import pose_at
from coopera.simulation.motions.props import Shown
from coopera.simulation.state.home_state import HomeState, PersonState, RobotState
from coopera.simulation.ways.navigation import Stand


class Held(NamedTuple):
    """What someone holds, by its name or its text, and how; `aids` is what else belongs to what they do with it.

    `drawn` is how pictures show it; nothing else knows of it.
    """

    name: str
    grip: Grip = CARRIED
    aids: tuple[Used, ...] = ()
    drawn: Shown | None = None


class Stances(NamedTuple):
    """How agents stand or sit, and what those hold who hold something."""

    bodies: Mapping[AgentId, Placed]
    held: Mapping[AgentId, Held]


def stances(ground: Ground, state: HomeState) -> Stances:
    """How all are between two acts."""
    return Stances(
        {agent: still(ground, state, agent) for agent in state.agents},
        {agent: _holds(ground, state, body) for agent, body in state.agents.items() if body.thing},
    )


def still(ground: Ground, state: HomeState, agent: AgentId) -> Placed:
    """An agent between two acts."""
    body = state.agents[agent]
    if isinstance(body, PersonState):
        motion = ground.motions[body.motion]
        setting, _ = working(ground.scene, state, body, motion)
        return Placed(*body.place, body.yaw, pose_at(motion, 0.0, setting))
    robot = ground.robots[agent]
    return Placed(*body.spot, body.yaw, robot.tucked if body.thing is None else robot.carrying)


def _holds(ground: Ground, state: HomeState, body: PersonState | RobotState) -> Held:
    """What an agent has in hand between two acts, and how."""
    if not isinstance(body, PersonState):
        return Held(body.thing or "")
    return Held(body.thing or "", working(ground.scene, state, body, ground.motions[body.motion])[1])


def receiving(person: Placed, step: Give) -> Placed:
    """The person turned to the robot, with a hand at the thing."""
    yaw = math.atan2(step.stand.y - person.y, step.stand.x - person.x)
    pose = reaching(to_body(Stand(person.x, person.y, yaw, 0.0, 0.0), step.point))
    return person if pose is None else person._replace(yaw=yaw, pose=pose)


def watching(body: RobotBody, robot: Placed, person: Placed) -> Placed:
    """The robot with its head turned to the person's body."""
    stand = Stand(robot.x, robot.y, robot.yaw, 0.0, 0.0)
    return robot._replace(pose=body.look_at(robot.pose, to_body(stand, (person.x, person.y, eye_level(person)))))


def eye_level(person: Placed) -> float:
    """At which height of a person a robot looks (metres)."""
    return min(max(float(person.pose[2]) + 0.15, 0.3), 1.1)
