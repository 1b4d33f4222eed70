"""Who turns to whom: a robot's head to a person, and a person to a robot that hands them something."""

from __future__ import annotations

import math

from coopera.simulation.acts.handling import to_body
from coopera.simulation.acts.plans import Give, Placed
from coopera.simulation.bodies.humanoid_reach import reaching
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.ways.navigation import Stand


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
