"""Motion capture in SMPL-X parameters (Motion-X, AMASS) as poses of our person.

Of the model's joints 22 are read: root, legs, spine, collars, neck, head, arms. Our body has one joint for the spine's
three, one for neck and head, and hinges for elbows and knees. So limbs are matched by the directions of their bones.
Collars count to the arms; wrists, fingers, toes and the face are dropped.

SMPL's own axes are x left, y up, z forward; ours x forward, y left, z up. Motion-X keeps y up in the world, AMASS z.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from coopera.core.errors import ConfigError
from coopera.core.foreign.arrays import read_arrays
from coopera.simulation.bodies.humanoid import ANKLE, SIDES, SIZE, SLICES, STANDING, Side, forward
from coopera.simulation.shapes.rotations import Array, wrapped

COLUMNS = 322
"""PAPER App. C.2: Motion-X rows are root 3, body 63, hands 90, jaw 3, face 150, translation 3, shape 10."""
_TRANSLATION = slice(309, 312)
_RATES = ("mocap_frame_rate", "mocap_framerate")
_AMASS = (*_RATES, "root_orient", "pose_body", "poses", "trans")
_FPS = 30.0
_MOST_FRAMES = 30_000
_LARGEST = 1e4  # radians or metres
_PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
_PELVIS, _SPINE, _HEAD = 0, 9, 15
_ARM = {"left": (16, 18), "right": (17, 19)}
_LEG = {"left": (1, 4, 7), "right": (2, 5, 8)}
_AXES = np.array(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))  # from SMPL's axes to ours
_STRAIGHT = 0.05
_UPSIDE_DOWN = -0.3
_SMPL_PELVIS = 0.93  # height of a standing SMPL body's pelvis, about


class Capture(NamedTuple):
    """A recorded motion: rotation vectors (T, 22, 3), translations (T, 3), pictures per second, the world's up axis."""

    turns: Array
    translation: Array
    fps: float
    up: Literal["y", "z"]


def read_capture(path: Path) -> Capture:
    """Read a Motion-X array (.npy of 322 columns) or an AMASS file (.npz); nothing in it is executed.

    Raises:
        ConfigError: If the file is none of these, damaged, or has values that are not finite.
    """
    data = read_arrays(path, _AMASS)
    found = _amass(path, data) if isinstance(data, dict) else _motion_x(path, data)
    frames = len(found.turns)
    if not 2 <= frames <= _MOST_FRAMES:
        raise ConfigError(f"The motion file {path} must have from 2 to {_MOST_FRAMES} frames, not {frames}.")
    if not all((np.abs(part) < _LARGEST).all() for part in (found.turns, found.translation)):
        raise ConfigError(f"The motion file {path} holds numbers that are not finite, or beyond {_LARGEST:g}.")
    return found


def _motion_x(path: Path, rows: Array) -> Capture:
    if rows.ndim != 2 or rows.shape[1] != COLUMNS or rows.dtype.kind != "f":
        raise ConfigError(f"The motion file {path} must hold numbers of shape (frames, {COLUMNS}), not {rows.shape}.")
    rows = rows.astype(np.float64)
    return Capture(rows[:, :66].reshape(-1, 22, 3), rows[:, _TRANSLATION], _FPS, "y")


def _amass(path: Path, data: dict[str, Array]) -> Capture:
    rates = [data[key] for key in _RATES if key in data]
    fps = float(rates[0].flat[0]) if rates and rates[0].size == 1 else 0.0
    parts = ("root_orient", "pose_body") if {"root_orient", "pose_body"} <= data.keys() else ("poses",)
    turns, where = [data.get(part, np.zeros((0, 0))) for part in parts], data.get("trans", np.zeros((0, 3)))
    frames = len(where) if where.ndim == 2 else 0
    whole = where.shape == (frames, 3) and all(one.ndim == 2 and len(one) == frames for one in turns)
    width = sum(one.shape[1] for one in turns) if whole else 0
    if not whole or not (width == 66 or (width > 66 and parts == ("poses",))) or not 1.0 <= fps <= 1000.0:
        raise ConfigError(
            f"The motion file {path} must be an AMASS file: poses (or root_orient and pose_body), trans, and "
            "mocap_frame_rate."
        )
    step = max(1, round(fps / _FPS))
    thin = np.concatenate([one[::step, :66].astype(np.float64) for one in turns], axis=1)
    return Capture(thin.reshape(-1, 22, 3), where[::step].astype(np.float64), fps / step, "z")


def retarget(capture: Capture) -> Array:
    """Poses of our person, shape (T, 43): on the spot, facing forward at the start, the lowest part on the floor.

    Raises:
        ConfigError: If the body is upside down most of the time, as some published clips are.
    """
    world = _AXES if capture.up == "y" else np.eye(3)
    turns = _global_turns(capture.turns, world)
    if float(np.median(turns[:, _PELVIS, 2, 2])) < _UPSIDE_DOWN:
        raise ConfigError("the body is upside down most of the time")
    ahead = turns[0, _PELVIS, :, 0]
    heading = math.atan2(float(ahead[1]), float(ahead[0])) if math.hypot(*ahead[:2]) > 0.3 else 0.0
    turns = Rotation.from_euler("z", -wrapped(heading)).as_matrix() @ turns
    poses = np.zeros((len(turns), SIZE))
    pelvis, chest = turns[:, _PELVIS], turns[:, _SPINE]
    poses[:, SLICES["turn"]] = _quaternions(pelvis)
    poses[:, SLICES["chest"]] = _quaternions(_transposed(pelvis) @ chest)
    poses[:, SLICES["neck"]] = _quaternions(_transposed(chest) @ turns[:, _HEAD])
    for side in SIDES:
        _arm(poses, turns, chest, side)
        _leg(poses, turns, pelvis, side)
    up = (capture.translation @ world.T)[:, 2] * STANDING / _SMPL_PELVIS
    poses[:, 2] = up - up.min()
    poses[:, 2] += _to_floor(poses)
    return poses


def _global_turns(turns: Array, world: Array) -> Array:
    """Orientation of each joint's part in our world, (T, 22, 3, 3): identity is the T-pose, facing forward."""
    local = Rotation.from_rotvec(turns.reshape(-1, 3)).as_matrix().reshape(-1, 22, 3, 3)
    whole = np.empty_like(local)
    for joint, parent in enumerate(_PARENTS):
        whole[:, joint] = local[:, joint] if parent < 0 else whole[:, parent] @ local[:, joint]
    found: Array = world @ whole @ _AXES.T
    return found


def _arm(poses: Array, turns: Array, chest: Array, side: Side) -> None:
    """In the T-pose an arm points sideways; bending the elbow brings the forearm forward."""
    out = 1.0 if side == "left" else -1.0
    upper, lower = (turns[:, joint] @ np.array((0.0, out, 0.0)) for joint in _ARM[side])
    hinge = turns[:, _ARM[side][0]] @ np.array((0.0, 0.0, out))
    limb, bend = _limb(upper, lower, hinge, -1.0)
    poses[:, SLICES[f"{side}_shoulder"]] = _quaternions(_transposed(chest) @ limb)
    poses[:, SLICES[f"{side}_elbow"]] = bend[:, None]


def _leg(poses: Array, turns: Array, pelvis: Array, side: Side) -> None:
    """A leg points down; bending the knee brings the shin backward."""
    hip, knee, ankle = _LEG[side]
    down = np.array((0.0, 0.0, -1.0))
    limb, bend = _limb(turns[:, hip] @ down, turns[:, knee] @ down, turns[:, hip] @ np.array((0.0, 1.0, 0.0)), 1.0)
    poses[:, SLICES[f"{side}_hip"]] = _quaternions(_transposed(pelvis) @ limb)
    poses[:, SLICES[f"{side}_knee"]] = -bend[:, None]
    shin = limb @ Rotation.from_rotvec(bend[:, None] * np.array((0.0, 1.0, 0.0))).as_matrix()
    poses[:, SLICES[f"{side}_ankle"]] = _quaternions(_transposed(shin) @ turns[:, ankle])


def _limb(upper: Array, lower: Array, hinge: Array, sign: float) -> tuple[Array, Array]:
    """Turns of the upper bone (T, 3, 3), whose -z is the bone and whose y is the hinge, and bends (T,) from 0 to pi.

    The hinge is square to both bones; where they are almost in line, it is what the model's own twist says.
    """
    normal = sign * np.cross(upper, lower)
    size = np.linalg.norm(normal, axis=1)
    square = hinge - (hinge * upper).sum(axis=1)[:, None] * upper
    y = np.where((size < _STRAIGHT)[:, None], square, normal)
    y /= np.maximum(np.linalg.norm(y, axis=1), 1e-9)[:, None]
    bend = np.where(size < _STRAIGHT, 0.0, np.arctan2(size, (upper * lower).sum(axis=1)))
    return np.stack((np.cross(y, -upper), y, -upper), axis=2), bend


def _to_floor(poses: Array) -> float:
    """By how much to raise a motion so that its lowest part just stands on the floor."""
    lowest = np.inf
    for pose in poses[:: max(1, len(poses) // 60)]:
        for part, place in forward(pose).place.items():
            lowest = min(lowest, float(place[2]) - (ANKLE if part.endswith("ankle") else 0.09))
    return -lowest


def _quaternions(matrices: Array) -> Array:
    found: Array = Rotation.from_matrix(matrices).as_quat()
    return found


def _transposed(matrices: Array) -> Array:
    return np.swapaxes(matrices, 1, 2)
