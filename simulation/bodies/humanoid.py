"""The person's body: the joint tree, forward kinematics, and limbs that reach for points.

The tree and its measures are those of the humanoid that the shipped motion capture was made for, at a quarter of
its size: 1.62 m tall, hips at 0.88 m. The shapes are ours (bodies/person.urdf). The body frame has x forward, y to
the left, z up, and its origin on the floor under the person; all lengths are metres.

A pose is an array of 43 numbers: the pelvis's place (3) and turn (quaternion x, y, z, w), then the joints in the
order of `JOINTS`, balls as quaternions (4) and hinges as angles (1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from coopera.simulation.shapes.rotations import Array, about_y, cross, matrix, posed, quaternion, slerp

Side = Literal["right", "left"]
SIDES: tuple[Side, Side] = ("right", "left")

STANDING = 0.8814
"""Height of the pelvis of a person who stands upright."""
ANKLE = 0.05
"""Height of the ankle joint above the sole."""
THIGH, SHIN = 0.421546, 0.40987
UPPER_ARM, FOREARM = 0.274788, 0.258947
PALM = 0.075
"""From the wrist to the middle of the hand; the forearm and the hand are one link."""
REACH = UPPER_ARM + FOREARM + PALM
CHEST = np.array((0.0, 0.0, 0.236151))  # from the pelvis
NECK = np.array((0.0, 0.0, 0.223894))  # from the chest
HEAD = np.array((0.0, 0.0, 0.175))  # from the neck
MOUTH = np.array((0.105, 0.0, -0.045))  # from the head's centre
_SHOULDER = np.array((-0.02405, 0.18311, 0.2435))  # from the chest; y is mirrored for the right
_HIP = np.array((0.0, 0.084887, 0.0))  # from the pelvis

JOINTS: tuple[tuple[str, int], ...] = (
    ("chest", 4),
    ("neck", 4),
    ("right_hip", 4),
    ("right_knee", 1),
    ("right_ankle", 4),
    ("right_shoulder", 4),
    ("right_elbow", 1),
    ("left_hip", 4),
    ("left_knee", 1),
    ("left_ankle", 4),
    ("left_shoulder", 4),
    ("left_elbow", 1),
)
"""Joint names and how many numbers each takes: the order of the motion capture's rows."""


def _slices() -> dict[str, slice]:
    found, start = {"place": slice(0, 3), "turn": slice(3, 7)}, 7
    for name, width in JOINTS:
        found[name] = slice(start, start + width)
        start += width
    return found


SLICES = _slices()
SIZE = 43


class Frames(NamedTuple):
    """Places (metres) and turns (matrices) of the body's parts, in the body frame."""

    place: dict[str, Array]
    turn: dict[str, Array]

    def point(self, part: str, x: float, y: float, z: float) -> Array:
        """A point given in a part's own frame."""
        found: Array = self.place[part] + self.turn[part] @ np.array((x, y, z))
        return found


def _mirrored(offset: Array, side: Side) -> Array:
    return offset if side == "left" else offset * np.array((1.0, -1.0, 1.0))


def trunk(place: Array, turn: Array, chest: Array, neck: Array) -> Frames:
    """Frames of pelvis, chest, neck, head and shoulders."""
    places, turns = {"pelvis": place}, {"pelvis": turn}
    places["chest"], turns["chest"] = place + turn @ CHEST, turn @ chest
    places["neck"], turns["neck"] = places["chest"] + turns["chest"] @ NECK, turns["chest"] @ neck
    places["head"], turns["head"] = places["neck"] + turns["neck"] @ HEAD, turns["neck"]
    for side in SIDES:
        places[f"{side}_shoulder"] = places["chest"] + turns["chest"] @ _mirrored(_SHOULDER, side)
        places[f"{side}_hip"] = place + turn @ _mirrored(_HIP, side)
    return Frames(places, turns)


def forward(pose: Array) -> Frames:
    """Place every part of the body: trunk, elbows, hands (their middle), knees and ankles."""
    part = {name: pose[where] for name, where in SLICES.items()}
    frames = trunk(part["place"], matrix(part["turn"]), matrix(part["chest"]), matrix(part["neck"]))
    for side in SIDES:
        arm = frames.turn["chest"] @ matrix(part[f"{side}_shoulder"])
        frames.turn[f"{side}_shoulder"] = arm
        elbow = frames.place[f"{side}_shoulder"] + arm @ np.array((0.0, 0.0, -UPPER_ARM))
        hand = arm @ about_y(-float(part[f"{side}_elbow"][0]))
        frames.place[f"{side}_elbow"], frames.turn[f"{side}_elbow"] = elbow, hand
        frames.place[f"{side}_hand"] = elbow + hand @ np.array((0.0, 0.0, -FOREARM - PALM))
        frames.turn[f"{side}_hand"] = hand
        leg = frames.turn["pelvis"] @ matrix(part[f"{side}_hip"])
        frames.turn[f"{side}_hip"] = leg
        knee = frames.place[f"{side}_hip"] + leg @ np.array((0.0, 0.0, -THIGH))
        shin = leg @ about_y(-float(part[f"{side}_knee"][0]))
        frames.place[f"{side}_knee"], frames.turn[f"{side}_knee"] = knee, shin
        frames.place[f"{side}_ankle"] = knee + shin @ np.array((0.0, 0.0, -SHIN))
        frames.turn[f"{side}_ankle"] = shin @ matrix(part[f"{side}_ankle"])
    return frames


class Limb(NamedTuple):
    """How a two-bone limb gets to a point: the first bone's turn, the hinge's bend, and what it missed by."""

    turn: Array
    bend: float
    miss: float


def bend_limb(root: Array, target: Array, bones: tuple[float, float], pole: Array, *, arm: bool) -> Limb:
    """Bend a limb from `root` to `target`, its middle joint towards `pole`; too far a target is pointed at.

    A bent elbow brings the forearm forward, a bent knee the shin backward; `bend` is at least 0 (radians).
    """
    upper, lower = bones
    line = target - root
    distance = math.sqrt(float(line @ line))
    reached = min(max(distance, abs(upper - lower) + 1e-3), upper + lower - 1e-4)
    along = line / distance if distance > 1e-9 else np.array((0.0, 0.0, -1.0))
    across = pole - float(pole @ along) * along
    norm = math.sqrt(float(across @ across))
    across = across / norm if norm > 1e-6 else _any_normal(along)
    cos = (upper * upper + reached * reached - lower * lower) / (2 * upper * reached)
    sin = math.sqrt(max(0.0, 1 - cos * cos))
    first = along * cos + across * sin
    second = (along * reached - first * upper) / lower
    hinge = cross(across, along)
    y = -hinge if arm else hinge
    z = -first
    turn = np.stack((cross(y, z), y, z), axis=1)
    return Limb(turn, math.acos(min(max(float(first @ second), -1.0), 1.0)), abs(distance - reached))


def _any_normal(line: Array) -> Array:
    other = np.array((1.0, 0.0, 0.0)) if abs(float(line[0])) < 0.9 else np.array((0.0, 1.0, 0.0))
    normal = cross(line, other)
    found: Array = normal / math.sqrt(float(normal @ normal))
    return found


@dataclass(slots=True)
class Aim:
    """What a pose should achieve, in the body frame (metres); bends are (forward, left turn, left lean) in degrees.

    `hands` gives targets for the middles of the hands, `feet` for the ankles. A hand without a target hangs, a foot
    without a target stands. `elbows` lifts the elbows sideways: 0 lets them hang, 1 brings them to shoulder height.
    `toes` is the pitch of the feet in degrees (positive: toes down). `knee_pole` turns the knees away from forward.
    """

    pelvis: tuple[float, float, float] = (0.0, 0.0, STANDING)
    hips: tuple[float, float, float] = (0.0, 0.0, 0.0)
    chest: tuple[float, float, float] = (0.0, 0.0, 0.0)
    neck: tuple[float, float, float] = (0.0, 0.0, 0.0)
    hands: dict[Side, Array] = field(default_factory=dict)
    feet: dict[Side, Array] = field(default_factory=dict)
    elbows: float = 0.15
    knees: float = 0.1
    toes: float = 0.0
    knee_pole: tuple[float, float, float] | None = None

    def frames(self) -> Frames:
        """The trunk's frames, in which hand targets may be given."""
        return trunk(np.array(self.pelvis), posed(*self.hips), posed(*self.chest), posed(*self.neck))


def at_rest(frames: Frames, side: Side) -> Array:
    """Where a hanging hand is."""
    sign = 1.0 if side == "left" else -1.0
    return frames.point("chest", *(_mirrored(_SHOULDER, side) + np.array((0.06, sign * 0.07, -REACH * 0.97))))


def solve(aim: Aim) -> tuple[Array, float]:
    """Find the pose that achieves an aim.

    Returns:
        The pose, and by how much the worse of the two hands misses its target (metres, 0 if both get there).
    """
    frames = aim.frames()
    pose = np.zeros(SIZE)
    pose[SLICES["place"]] = aim.pelvis
    pose[SLICES["turn"]] = quaternion(frames.turn["pelvis"])
    pose[SLICES["chest"]] = quaternion(posed(*aim.chest))
    pose[SLICES["neck"]] = quaternion(posed(*aim.neck))
    missed = 0.0
    for side in SIDES:
        sign = 1.0 if side == "left" else -1.0
        pole = frames.turn["chest"] @ np.array((-0.45, sign * (0.35 + 2.0 * aim.elbows), -1.0 + aim.elbows))
        target = aim.hands.get(side)
        if target is None:
            target = at_rest(frames, side)
        arm = bend_limb(frames.place[f"{side}_shoulder"], target, (UPPER_ARM, FOREARM + PALM), pole, arm=True)
        missed = max(missed, arm.miss)
        pose[SLICES[f"{side}_shoulder"]] = quaternion(frames.turn["chest"].T @ arm.turn)
        pose[SLICES[f"{side}_elbow"]] = arm.bend
        _stand(pose, aim, frames, side)
    return pose, missed


def _stand(pose: Array, aim: Aim, frames: Frames, side: Side) -> None:
    """Bend one leg so that its ankle gets to its place, and lay the foot flat."""
    sign = 1.0 if side == "left" else -1.0
    heading = posed(0.0, aim.hips[1])
    foot = aim.feet.get(side, np.array((0.0, sign * 0.1, ANKLE)))
    x, y, z = aim.knee_pole or (1.0, 0.0, 0.15)
    pole = heading @ np.array((x, y + sign * aim.knees, z))
    leg = bend_limb(frames.place[f"{side}_hip"], foot, (THIGH, SHIN), pole, arm=False)
    pose[SLICES[f"{side}_hip"]] = quaternion(frames.turn["pelvis"].T @ leg.turn)
    pose[SLICES[f"{side}_knee"]] = -leg.bend
    shin = leg.turn @ about_y(leg.bend)
    flat = heading @ posed(aim.toes, sign * 8.0)
    pose[SLICES[f"{side}_ankle"]] = quaternion(shin.T @ flat)


def blend(first: Array, second: Array, share: float) -> Array:
    """Move from one pose to another by a share in [0, 1]."""
    mixed = first + share * (second - first)
    for where in SLICES.values():
        if where.stop - where.start == 4:
            mixed[where] = slerp(first[where], second[where], share)
    return mixed
