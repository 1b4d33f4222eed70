"""What a perception module tells of a recorded act: coarse, sometimes wrong, and nothing that was not seen.

It stands in for a model that looks at the pictures, where the robot's own model cannot; it needs no pictures.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from pydantic import Field

from core.household import Percept
from core.people import Frozen
from simulation.cameras import ROBOT_FOV, robot_camera
from simulation.motions import Library
from simulation.recording import Moment, Recording
from simulation.rotations import Array
from simulation.scene import Scene
from simulation.stage import Stage


class Errors(Frozen):
    """How often perception errs: shares in [0, 1]."""

    motion_confused: float = Field(0.15, ge=0, le=1)
    """Another motion class of the same posture is reported."""
    in_hand_missed: float = Field(0.20, ge=0, le=1)
    """The thing in the hand is not recognised."""


_RANGE = 6.0


def perceive(
    stage: Stage,
    scene: Scene,
    recording: Recording,
    library: Library,
    *,
    errors: Errors,
    class_of: Callable[[str], str],
    rng: np.random.Generator,
) -> Percept:
    """Report the recording's last deed; always draws three numbers, so that other errors stay the same.

    The motion is named by its class, never by its caption, and the thing in hand by its class.
    """
    shot = recording.shots[-1]
    moment = shot.at(shot.deed)
    stage.show(recording.state, moment)
    confused, which, missed = rng.random(3)
    label = ""
    if recording.motion is not None:
        label = recording.motion.cls
        others = library.confusable(recording.motion)
        if confused < errors.motion_confused and others:
            label = others[int(which * len(others))]
    in_hand = recording.in_hand if missed >= errors.in_hand_missed else None
    return Percept(
        room=scene.room_at(moment.person.x, moment.person.y).name,
        near=recording.near,
        motion=label,
        in_hand=class_of(in_hand) if in_hand else None,
        visible=visible_from_robot(stage, scene, recording, moment),
    )


def visible_from_robot(stage: Stage, scene: Scene, recording: Recording, moment: Moment) -> list[str]:
    """Names of the objects that the robot's head camera sees at a moment, sorted.

    An object is seen if it lies within the picture and a ray to its middle or to the middle of its top meets nothing
    else first. The stage must show the moment.
    """
    camera = robot_camera(stage.body, moment.robot)
    eye, ahead = np.array(camera.eye), np.array(camera.target) - np.array(camera.eye)
    names, points = [], []
    for thing in scene.objects:
        if moment.in_hand is not None and moment.in_hand.name == thing.name:
            continue
        where = moment.moved.get(thing.name) or recording.state.thing(thing)
        x, y, z = thing.position if thing.fixed else where.position
        for height in (0.5 * thing.size[2], 0.95 * thing.size[2]):
            names.append(thing.name)
            points.append((x, y, z + height))
    ends = np.array(points).reshape(-1, 3)
    candidates = np.flatnonzero(_in_picture(ends - eye, ahead))
    if not len(candidates):
        return []
    lines = ends[candidates] - eye
    beyond = eye + lines * (1 + 0.02 / np.linalg.norm(lines, axis=1))[:, None]
    hits = stage.rays(np.repeat(eye[None], len(candidates), axis=0), beyond)
    seen = {names[i] for i, hit in zip(candidates, hits, strict=True) if stage.home.names.get(int(hit)) == names[i]}
    return sorted(seen)


def _in_picture(lines: Array, ahead: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which directions fall into a 4:3 picture of the robot's camera and are near enough."""
    ahead = ahead / math.sqrt(float(ahead @ ahead))
    right = np.array((ahead[1], -ahead[0], 0.0)) / max(math.hypot(float(ahead[0]), float(ahead[1])), 1e-9)
    up = np.cross(right, ahead)
    depth, across, height = lines @ ahead, lines @ right, lines @ up
    tall = math.tan(math.radians(ROBOT_FOV) / 2)
    inside = (depth > 0.05) & (np.abs(height) <= tall * depth) & (np.abs(across) <= tall * 4 / 3 * depth)
    return np.asarray(inside & (np.linalg.norm(lines, axis=1) <= _RANGE))
