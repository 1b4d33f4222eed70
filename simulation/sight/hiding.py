"""What hides what, worked out without a picture: bodies as a few balls, furniture that somebody is in as its parts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import SIDES, Frames, forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.catalogue import solids
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.kit import Size
from coopera.simulation.shapes.rotations import Array, about_z

Hidden = NDArray[np.bool_]
_SEEN = {"head": 2.0, "chest": 1.5, "pelvis": 1.0, "right_knee": 0.5, "left_knee": 0.5}
_HAND = 3.0
_WORK = 0.8
"""What all that is worked with counts besides, where all of the body is 1."""
_LOW, _FLAT, _STEPS, _SITS, _LARGE = 0.45, 0.35, 0.12, 0.8, 0.7
"""In metres: who has the pelvis below the first sits low, and lies if the head is less than the second above it; feet
that move farther than the third step about; who has the pelvis below the fourth sits; the last is large for a thing."""
_ABOVE = 0.02
_TORSO, _HEAD = 0.14, 0.11  # radii (metres)
_TOUCH = 0.02
"""A ball ends so far from a point that it holds: a hand in the lap is seen from the front."""
_NEAR = 0.1
"""Parts within this distance of a point hide nothing of it: it lies on them."""


class Body(NamedTuple):
    """A body as cameras are chosen for it.

    Points that should be seen, shape (n, 3), what each counts, shape (n,), adding up to 1, and the balls that hide
    what is behind them: middles, shape (m, 3), and radii, shape (m,). All in the world, in metres.
    """

    points: Array
    weights: Array
    balls: Array
    radii: Array


def person_body(person: Placed, *later: Placed) -> Body:
    """A person: both hands count for more than half, by where they are now and at other moments of an act."""
    frames = forward(person.pose)
    points = np.array([frames.place[part] for part in _SEEN])
    hands = [_in_world(person, _hands(frames))]
    hands += [_in_world(other, _hands(forward(other.pose))) for other in later]
    weights = [*_SEEN.values(), *([_HAND / len(hands)] * (2 * len(hands)))]
    low, high, head = (frames.place[part] for part in ("pelvis", "chest", "head"))
    balls = np.array([*(low + (high - low) * share for share in (0.0, 0.4, 0.8, 1.2)), head])
    radii = np.array([_TORSO] * 4 + [_HEAD])
    points = np.concatenate((_in_world(person, points), *hands))
    return Body(points, np.array(weights) / sum(weights), _in_world(person, balls), radii)


def at_work(body: Body, work: Array) -> Body:
    """The same, for a picture of what it does: points of what it works with, shape (n, 3), count besides."""
    if not len(work):
        return body
    points = np.concatenate((body.points, work))
    weights = np.concatenate((body.weights, np.full(len(work), _WORK / len(work))))
    return body._replace(points=points, weights=weights / weights.sum())


def framed_of(persons: Sequence[Placed], *, whole: bool = False) -> Array:
    """What of a person is to be within a picture, at some moments: shape (n, 3), in the world.

    The head, the trunk and the hands; the feet of who lies, sits on the floor or steps about, too,
    and where the `whole` body is asked for.
    """
    joints = [forward(person.pose).place for person in persons]
    feet_of = [[at[f"{side}_ankle"] for side in SIDES] for at in joints]
    ankles = np.array([_in_world(one, np.array(feet)) for one, feet in zip(persons, feet_of, strict=True)])
    low = min(float(at["pelvis"][2]) for at in joints) < _LOW
    flat = min(float(at["head"][2] - at["pelvis"][2]) for at in joints) < _FLAT
    feet = whole or low or flat or float(np.ptp(ankles, axis=0).max()) > _STEPS
    found = []
    for person, at in zip(persons, joints, strict=True):
        points = [at["head"] + (0.0, 0.0, _HEAD), at["chest"], at["pelvis"], *(at[f"{side}_hand"] for side in SIDES)]
        points += [at[f"{side}_knee"] for side in SIDES] if person.pose[2] < _SITS else []
        points += [at[f"{side}_ankle"] for side in SIDES] if feet else []
        found.append(_in_world(person, np.array(points)))
    return np.concatenate(found)


def corners_of(person: Placed, things: Sequence[tuple[Array, Array, Size]]) -> Array:
    """The corners of the boxes around things, given by place, turn and size in a body's frame: shape (8 n, 3), world.

    Of what is large, only what is near its middle counts.
    """
    signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)])
    found = [np.zeros((0, 3))]
    for place, turn, size in things:
        corners = signs * np.minimum(size, (_LARGE, _LARGE, math.inf))
        found.append(_in_world(person, corners @ np.asarray(turn).T + place))
    return np.concatenate(found)


def tops_of(person: Placed, things: Sequence[tuple[Array, Array, Size]]) -> Array:
    """The middles of the tops of such things, just above them: shape (n, 3), in the world."""
    tops = [place + turn @ np.array((0.0, 0.0, size[2])) + (0.0, 0.0, _ABOVE) for place, turn, size in things]
    return _in_world(person, np.array(tops).reshape(-1, 3))


def _hands(frames: Frames) -> Array:
    return np.array([frames.place[f"{side}_hand"] for side in SIDES])


def robot_body(body: RobotBody, robot: Placed) -> Body:
    """A robot: its gripper counts for half."""
    arm = body.arm(robot.pose)
    points = np.array([body.camera(robot.pose)[0], arm[-1], arm[len(arm) // 2], (0.0, 0.0, 0.35)])
    balls = np.array([(0.0, 0.0, height) for height in (0.3, 0.5, 0.7)])
    weights = np.array((0.25, 0.5, 0.15, 0.1))
    return Body(_in_world(robot, points), weights, _in_world(robot, balls), np.full(3, 0.16))


def _in_world(placed: Placed, points: Array) -> Array:
    turned: Array = points @ about_z(placed.yaw).T + np.array((placed.x, placed.y, 0.0))
    return turned


def behind_balls(starts: Array, ends: Array, balls: Array, radii: Array) -> Hidden:
    """Which lines, shapes (n, 3), pass through a ball before they end; one that holds the end hides it from beyond."""
    line = ends - starts
    to_ball = balls[None] - starts[:, None]
    length = np.maximum((line * line).sum(axis=1), 1e-9)[:, None]
    share = np.clip((to_ball * line[:, None]).sum(axis=2) / length, 0.0, 1.0)
    nearest = starts[:, None] + share[:, :, None] * line[:, None]
    apart = np.linalg.norm(nearest - balls[None], axis=2)
    end_apart = np.linalg.norm(ends[:, None] - balls[None], axis=2)
    hidden: Hidden = (apart < np.minimum(radii[None], end_apart - _TOUCH)).any(axis=1)
    return hidden


class Boxes(NamedTuple):
    """The parts of some furniture, each as the box around it: middles, half extents, shapes (m, 3), and yaws (m,)."""

    middles: Array
    halves: Array
    yaws: Array


def boxes_of(furniture: Sequence[SceneObject], *, opaque: bool = True) -> Boxes:
    """The parts of furniture, or those that are `opaque`."""
    middles, halves, yaws = [], [], []
    for thing in furniture:
        turn = about_z(thing.yaw)
        for solid in solids(thing):
            if solid.opaque or not opaque:
                middles.append(turn @ np.array(solid.middle) + np.array(thing.position))
                halves.append(solid.half)
                yaws.append(thing.yaw)
    return Boxes(np.array(middles).reshape(-1, 3), np.array(halves).reshape(-1, 3), np.array(yaws))


def behind_boxes(starts: Array, ends: Array, boxes: Boxes) -> Hidden:
    """Which lines, shapes (n, 3), meet a box; one that the end is in or nearly touches does not hide it."""
    hidden = np.zeros(len(starts), dtype=bool)
    for middle, half, yaw in zip(boxes.middles, boxes.halves, boxes.yaws, strict=True):
        back = about_z(-float(yaw))
        a, b = (starts - middle) @ back.T, (ends - middle) @ back.T
        outside = np.linalg.norm(np.maximum(np.abs(b) - half, 0.0), axis=1) > _NEAR
        line = np.where(np.abs(b - a) < 1e-9, 1e-9, b - a)
        one, other = (-half - a) / line, (half - a) / line
        enters = np.minimum(one, other).max(axis=1)
        leaves = np.maximum(one, other).min(axis=1)
        hidden |= outside & (enters < leaves) & (enters < 1.0) & (leaves > 0.0)
    return hidden


def angle_from_front(person: Placed, x: Array, y: Array) -> Array:
    """Angles between where a body faces and where places lie, in [0, pi]."""
    turn = np.arctan2(y - person.y, x - person.x) - person.yaw
    found: Array = np.abs((turn + math.pi) % math.tau - math.pi)
    return found
