"""From key frames to poses: what the body looks like at a moment of a motion, at furniture of any height."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.simulation.bodies.humanoid import ANKLE, MOUTH, SIDES, STANDING, Aim, Frames, Side, solve
from coopera.simulation.motions.library import Clip, Frame, HandPath, Keys, Motion, Posture, Triple, along
from coopera.simulation.shapes.rotations import Array

WORKTOP = 0.9
"""Height of the surface a standing person works at where there is none (metres)."""
_LAP = 0.19  # the top of the thighs above the seat
_SEATED = 0.10  # the pelvis's middle above the seat
_LYING = 0.12
_UPRIGHT, _STOOP = 0.8, 0.5
"""Over a surface this high one works standing upright; over one lower by the second, bent as far as goes (metres)."""
_FARTHER, _HIGHER = 60.0, 220.0
"""One leans by so many degrees more for each metre that things lie farther off, or one sits higher than usual."""
_SEAT = 0.42


class Setting(NamedTuple):
    """The heights that a motion adapts to (metres above the floor).

    The body sits or lies at the height `support` (0: on the floor). The hands work at the height `worktop`; with None
    they work on the lap, or at WORKTOP when the person stands. `posture` replaces the posture of the motion: a person
    without a seat stands. `step` is how far somebody who stands steps up to the surface, and `reach` how much farther
    ahead and to the left than usual the hands work on it; `right` is how much farther than that the right hand goes,
    for what it holds (metres).
    """

    support: float = 0.0
    worktop: float | None = None
    posture: Posture = "stand"
    step: float = 0.0
    reach: tuple[float, float] = (0.0, 0.0)
    right: Triple = (0.0, 0.0, 0.0)


@made_once()
def clip(name: str) -> Clip:
    """The shipped clip of that name, or that of a file with SMPL-X parameters; read once.

    Raises:
        ConfigError: If a file cannot be used.
    """
    path = Path(name)
    if path.suffix not in (".npy", ".npz"):
        return Clip.shipped(name)
    from coopera.simulation.motions.smplx import read_capture, retarget  # noqa: PLC0415 - heavy, and few have such files

    capture = read_capture(path)
    try:
        poses = retarget(capture)
    except ConfigError as err:
        raise ConfigError(f"The motion file {path} cannot be used: {err}.") from err
    return Clip(np.arange(len(poses) + 1) / capture.fps, poses)


def pose_at(motion: Motion, seconds: float, setting: Setting) -> Array:
    """The pose at a moment of a motion, in the body frame."""
    keys = motion.keys
    if keys.clip is not None:
        return _recorded(clip(keys.clip), seconds, setting, motion.posture)
    share = seconds / keys.period
    base = keys.base if setting.posture in (motion.posture, "floor") else None
    aim = _base(setting.posture if base is None else base, setting.support)
    pelvis = np.array(aim.pelvis) + along(keys.pelvis, share)
    aim.pelvis = (float(pelvis[0]), float(pelvis[1]), float(pelvis[2]))
    aim.hips = _sum(aim.hips, along(keys.hips, share))
    aim.chest = _sum(aim.chest, along(keys.chest, share))
    aim.neck = _sum(aim.neck, along(keys.neck, share))
    aim.elbows, aim.knees = keys.elbows, max(keys.knees, aim.knees)
    for side in SIDES:
        foot = keys.right_foot if side == "right" else keys.left_foot
        aim.feet[side] = aim.feet[side] + along(foot, share)
    hands = _hands(keys)
    if setting.posture == "stand" and any("surface" in path.frames for path in hands.values()):
        _stoop(aim, working_height(setting))
    _lean(aim, setting, hands)
    frames = aim.frames()
    origin = np.array((*setting.reach, working_height(setting)))
    for side, path in hands.items():
        begin = origin + np.array(setting.right) if side == "right" else origin
        aim.hands[side] = _hand(path, share, frames, begin)
    pose = solve(aim)[0]
    pose[0] += setting.step
    return pose


def _recorded(clip: Clip, seconds: float, setting: Setting, posture: Posture) -> Array:
    """A recorded pose; who sat or lay when it was recorded does so at the height of what is there."""
    pose = clip.at(seconds)
    if setting.posture != posture or posture not in ("sit", "lie"):
        return pose
    lower = _SEATED if posture == "sit" else _LYING
    pose = pose.copy()
    pose[2] += setting.support + lower - float(np.median(clip.poses[:, 2]))
    return pose


def _hands(keys: Keys) -> dict[Side, HandPath]:
    paths: dict[Side, HandPath | None] = {"right": keys.right, "left": keys.left}
    return {side: path for side, path in paths.items() if path is not None}


def _stoop(aim: Aim, worktop: float) -> None:
    """Bend down to a surface that is too low for standing upright."""
    effort = min(max((_UPRIGHT - worktop) / _STOOP, 0.0), 1.0)
    drop = 0.5 * effort
    aim.pelvis = (aim.pelvis[0] - 0.16 * effort, aim.pelvis[1], aim.pelvis[2] - drop)
    aim.hips = _sum(aim.hips, np.array((52.0 * effort, 0.0, 0.0)))
    aim.knees += 0.3 * effort


def _lean(aim: Aim, setting: Setting, hands: dict[Side, HandPath]) -> None:
    """Bend to what lies farther ahead than usual, and from a high seat down to the feet."""
    bend = _FARTHER * max(setting.reach[0], 0.0)
    if setting.posture == "sit" and any(path.frames[0] == "body" for path in hands.values()):
        bend += _HIGHER * max(setting.support - _SEAT, 0.0)
    aim.hips = _sum(aim.hips, np.array((bend, 0.0, 0.0)))


def working_height(setting: Setting) -> float:
    """The height at which the hands work: of the worktop, the lap, or that of a usual worktop for who stands."""
    if setting.worktop is not None:
        return setting.worktop
    return WORKTOP if setting.posture == "stand" else setting.support + _LAP


def _hand(path: HandPath, share: float, frames: Frames, origin: Array) -> Array:
    """Where a hand goes, in the body frame; `origin` is where the paths over the surface begin."""
    places = [_placed(frame, point, frames, origin) for frame, point in zip(path.frames, path.points, strict=True)]
    return along(places, share)


def _placed(frame: Frame, point: Triple, frames: Frames, origin: Array) -> Triple:
    """A point of a hand's path in the body frame."""
    x, y, z = point
    if frame == "surface":
        return x + float(origin[0]), y + float(origin[1]), z + float(origin[2])
    if frame == "body":
        return point
    if frame == "mouth":
        found = frames.point("head", x + MOUTH[0], y + MOUTH[1], z + MOUTH[2])
    else:
        found = frames.point("pelvis" if frame == "hips" else frame, x, y, z)
    return float(found[0]), float(found[1]), float(found[2])


def _sum(base: tuple[float, float, float], by: Array) -> tuple[float, float, float]:
    return base[0] + float(by[0]), base[1] + float(by[1]), base[2] + float(by[2])


def _feet(x: float, y: float, z: float) -> dict[Side, Array]:
    return {"right": np.array((x, -y, z)), "left": np.array((x, y, z))}


def _base(name: str, support: float) -> Aim:
    """The still posture that a motion's keys are added to; `support` carries a sitting or lying body."""
    if name == "sit":
        # A low seat pushes the knees up, a high one lets the feet hang: the legs find that themselves.
        return Aim(pelvis=(0.0, 0.0, support + _SEATED), feet=_feet(0.44, 0.11, ANKLE), knees=0.12)
    if name in ("lie", "supine"):
        feet = _feet(0.84, 0.10, support + 0.07)
        return Aim((0.0, 0.0, support + _LYING), (-90.0, 0.0, 0.0), feet=feet, toes=-65.0, knee_pole=(0.2, 0.0, 1.0))
    if name in ("floor", "crossed"):
        feet = _feet(0.26, -0.09, support + 0.08)
        return Aim((0.0, 0.0, support + 0.11), feet=feet, knees=1.6, toes=20.0)
    if name == "kneel":
        feet = _feet(-0.34, 0.12, support + 0.08)
        pole = (0.6, 0.0, -1.0)
        return Aim((0.0, 0.0, support + 0.46), (66.0, 0.0, 0.0), feet=feet, toes=80.0, knee_pole=pole)
    if name == "prone":
        feet = _feet(-0.78, 0.09, support + 0.12)
        pole = (0.3, 0.0, -1.0)
        return Aim((0.0, 0.0, support + 0.40), (72.0, 0.0, 0.0), feet=feet, toes=65.0, knee_pole=pole)
    if name == "crouch":
        feet = {"right": np.array((0.10, -0.12, ANKLE)), "left": np.array((-0.12, 0.12, ANKLE + 0.04))}
        return Aim((-0.12, 0.0, 0.36), (24.0, 0.0, 0.0), feet=feet, knees=0.4)
    return Aim(pelvis=(0.0, 0.0, STANDING - 0.01), feet=_feet(0.0, 0.1, ANKLE))
