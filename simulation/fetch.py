"""The robot's body: a Fetch-like mobile manipulator; its chain, its reach and where it looks.

Joint origins, axes and limits follow Fetch Robotics' public description; the shapes (bodies/fetch.urdf) are ours.
The body frame has x forward, y to the left, z up and its origin on the floor under the base; metres and radians.
A posture is an array of `SIZE` numbers in the order of `JOINTS`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from core.randomness import rng_at
from simulation.rotations import Array, about_x, about_y, about_z, wrapped

RADIUS = 0.30  # PAPER §Scenes: the navigation radius that Habitat 3.0 gives both bodies
HEIGHT = 1.1

ARM = (
    "torso_lift",
    "shoulder_pan",
    "shoulder_lift",
    "upperarm_roll",
    "elbow_flex",
    "forearm_roll",
    "wrist_flex",
    "wrist_roll",
)
"""The chain from base to gripper; the first is a lift (metres), the others turn (radians)."""
JOINTS = (*ARM, "head_pan", "head_tilt", "left_finger", "right_finger")
SIZE = len(JOINTS)

_ORIGINS = np.array(
    (
        (-0.086875, 0.0, 0.37743),
        (0.119525, 0.0, 0.34858),
        (0.117, 0.0, 0.06),
        (0.219, 0.0, 0.0),
        (0.133, 0.0, 0.0),
        (0.197, 0.0, 0.0),
        (0.1245, 0.0, 0.0),
        (0.1385, 0.0, 0.0),
    )
)
_AXES = ("z", "z", "y", "x", "y", "x", "y", "x")
_TURNS = {"x": about_x, "y": about_y, "z": about_z}
_GRIPPER = np.array((0.16645, 0.0, 0.0))
_LOW = np.array((0.0, -1.6056, -1.221, -math.pi, -2.251, -math.pi, -2.16, -math.pi))
_HIGH = np.array((0.38615, 1.6056, 1.518, math.pi, 2.251, math.pi, 2.16, math.pi))
_HEAD_PAN = np.array((0.053125, 0.0, 0.603001))
_HEAD_TILT = np.array((0.14253, 0.0, 0.057999))
_CAMERA = np.array((0.07, 0.0, 0.0225))

TUCKED = np.array((0.05, 1.32, 1.40, -0.2, 1.72, 0.0, 1.66, 0.0, 0.0, 0.25, 0.04, 0.04))
"""Arm folded over the base: for driving and for looking."""
CARRYING = np.array((0.12, 0.9, 0.85, -1.2, 1.95, -0.5, 1.0, 0.4, 0.0, 0.25, 0.03, 0.03))
"""Gripper low beside the body with a thing in it, out of the camera's way."""
READY = np.array((0.15, 0.0, -0.35, 0.0, 1.25, 0.0, 0.75, 0.0, 0.0, 0.4, 0.05, 0.05))
"""Arm raised in front: where each reach starts."""

REACH = 1.05
"""Farthest horizontal distance from the base's middle at which anything can be grasped (metres)."""
_WEIGHTS = np.array((0.2, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0))
_ARRIVED = 0.005
_RESTARTS = 12


class Gripper(NamedTuple):
    """Where the gripper is in the body frame: its middle, its turn (x points out of it), and the Jacobian (3, 8)."""

    place: Array
    turn: Array
    jacobian: Array


def gripper(posture: Array) -> Gripper:
    """Place the gripper for a posture; only the first eight joints matter."""
    place, turn = np.zeros(3), np.eye(3)
    starts: list[Array] = []
    axes: list[Array] = []
    for i, axis in enumerate(_AXES):
        place = place + turn @ _ORIGINS[i]
        starts.append(place)
        axes.append(turn[:, "xyz".index(axis)])
        if i == 0:
            place = place + turn[:, 2] * posture[0]
        else:
            turn = turn @ _TURNS[axis](float(posture[i]))
    end = place + turn @ _GRIPPER
    jacobian = np.cross(np.array(axes), end - np.array(starts)).T
    jacobian[:, 0] = (0.0, 0.0, 1.0)
    return Gripper(end, turn, jacobian)


def _descend(start: Array, target: Array) -> Array | None:
    """Follow damped least squares to a target, drawn towards READY in the null space; None if it gets stuck."""
    posture = start.copy()
    for step in range(60):
        at = gripper(posture)
        error = target - at.place
        distance = math.sqrt(float(error @ error))
        if distance < _ARRIVED:
            return posture
        jacobian = at.jacobian * _WEIGHTS
        square = jacobian @ jacobian.T + 1e-3 * np.eye(3)
        inverse = jacobian.T @ np.linalg.inv(square)
        move = inverse @ (error * min(1.0, 0.25 / distance))
        drawn = (READY[:8] - posture) * (0.05 if step < 40 else 0.0)
        move = move + drawn - inverse @ (jacobian @ drawn)
        posture = np.clip(posture + np.clip(move * _WEIGHTS, -0.35, 0.35), _LOW, _HIGH)
    return None


def reach(target: Array) -> Array | None:
    """Find a posture that puts the gripper's middle within 5 mm of a point in the body frame.

    Starts from READY, turned towards the target, then from seeded random postures: the same point always gives the
    same posture. None if the point is out of reach or no start gets there.
    """
    flat = math.hypot(float(target[0]), float(target[1]))
    if flat > REACH + 0.1 or not 0.0 < float(target[2]) < 2.0:
        return None
    rng = rng_at(0, "fetch", "reach", *(round(float(value), 3) for value in target))
    start = READY[:8].copy()
    start[1] = min(max(wrapped(math.atan2(float(target[1]), float(target[0]) - 0.03)), _LOW[1]), _HIGH[1])
    start[0] = min(max(float(target[2]) - 0.75, 0.0), 0.38)
    for _ in range(_RESTARTS):
        found = _descend(start, target)
        if found is not None:
            posture = READY.copy()
            posture[:8] = found
            return posture
        start = rng.uniform(_LOW, _HIGH)
    return None


def camera(posture: Array) -> tuple[Array, Array]:
    """The head camera's place and viewing direction in the body frame."""
    shoulders = _ORIGINS[0] + np.array((0.0, 0.0, float(posture[0])))
    pan = about_z(float(posture[8]))
    head = pan @ about_y(float(posture[9]))
    place = shoulders + _HEAD_PAN + pan @ _HEAD_TILT + head @ _CAMERA
    return place, head[:, 0]


def look_at(posture: Array, target: Array) -> Array:
    """The posture with the head turned so that the camera faces a point in the body frame, within its limits."""
    looking = posture.copy()
    shoulders = _ORIGINS[0] + np.array((0.0, 0.0, float(posture[0])))
    line = target - (shoulders + _HEAD_PAN)
    looking[8] = min(max(math.atan2(float(line[1]), float(line[0])), -1.57), 1.57)
    drop = float(_HEAD_TILT[2] + _CAMERA[2] - line[2])
    flat = max(math.hypot(float(line[0]), float(line[1])) - float(_HEAD_TILT[0]), 0.05)
    looking[9] = min(max(math.atan2(drop, flat), -0.76), 1.45)
    return looking
