"""What a perception module tells of a recorded act: coarse, sometimes wrong, and nothing that was not seen.

Objects are seen where rays meet them; the person's motion is recognised from their joints (`pose_matching`).
It stands in for a model that looks at the pictures, where the robot's own model cannot; it needs no pictures.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from coopera.core.household import Percept, PerceptErrors
from coopera.simulation.acts.plans import Placed
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.library import Library
from coopera.simulation.shapes.rotations import Array, about_z
from coopera.simulation.sight.cameras import ROBOT_FOV, around, robot_camera
from coopera.simulation.sight.pose_matching import HANDS, PARTS, matcher, skeleton
from coopera.simulation.sight.recording import Moment, Recording
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.timing import TICKS

INSTANTS = 8
"""At how many moments the person's joints are looked at: as many as a run takes pictures, if nothing else is asked."""
_RANGE = 6.0


def perceive(
    stage: Stage,
    scene: Scene,
    recording: Recording,
    library: Library,
    *,
    errors: PerceptErrors,
    class_of: Callable[[str], str],
    rng: np.random.Generator,
) -> Percept:
    """Report the last act of a recording; the draw for one error never changes another.

    Pose matching recognises the motion from the joints in the camera's view, not from the motion played. The report
    gives the motion's class, never its caption. It gives the class of the thing in hand if a hand is in view, and the
    states that the act leaves visible objects in.
    """
    shot = recording.shots[-1]
    moment = shot.at(shot.deed)
    person = moment.bodies[recording.person]
    stage.show(recording.state, moment)
    confused, which, missed = rng.random(3)
    joints, seconds = seen_joints(stage, scene, recording, INSTANTS)
    noise = rng.normal(0.0, errors.joint_noise, joints.shape)
    motion, label = matcher(library).match(joints + noise, seconds), ""
    if motion is not None:
        label = motion.cls
        others = library.confusable(motion)
        if confused < errors.motion_confused and others:
            label = others[int(which * len(others))]
    hand_seen = bool(np.isfinite(joints[:, HANDS]).any())
    in_hand = recording.in_hand if hand_seen and missed >= errors.in_hand_missed else None
    visible = visible_from_robot(stage, scene, recording, moment)
    return Percept(
        room=scene.room_at(person.x, person.y).name,
        near=recording.near,
        motion=label,
        in_hand=class_of(in_hand) if in_hand else None,
        visible=visible,
        states={name: said for name, said in recording.states.items() if name in visible},
    )


def seen_joints(stage: Stage, scene: Scene, recording: Recording, count: int) -> tuple[Array, Array]:
    """The watched person's joints at uniformly sampled moments, as far as the robot's head camera sees them.

    A joint is seen if it lies within the picture and no furniture stands before it; what the person sits or lies on
    hides nothing.

    Returns:
        Joint positions (count, 13, 3) in the world, NaN where not seen, and the moments in seconds (count,).
    """
    ticks = np.linspace(0, recording.ticks - 1, count).round().astype(int)
    joints = np.full((count, len(PARTS), 3), np.nan)
    found = [recording.find(int(tick)) for tick in ticks]
    for index, shot in enumerate(recording.shots):
        ignore = around(scene, shot.at(shot.deed).bodies[recording.person])
        stage.hide(ignore)
        for i, (there, within) in enumerate(found):
            if there == index:
                moment = shot.at(within)
                points = in_world(moment.bodies[recording.person])
                seen = _seen(stage, _eyes(stage, recording, moment), points)
                joints[i, seen] = points[seen]
        stage.unhide(ignore)
    return joints, ticks / TICKS


def _eyes(stage: Stage, recording: Recording, moment: Moment) -> Camera:
    return robot_camera(stage.robots[recording.robot], moment.bodies[recording.robot])


def in_world(person: Placed) -> Array:
    """A person's joints in the world, shape (13, 3)."""
    turned: Array = skeleton(person.pose) @ about_z(person.yaw).T + np.array((person.x, person.y, 0.0))
    return turned


def _seen(stage: Stage, camera: Camera, points: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    eye, ahead = np.array(camera.eye), np.array(camera.target) - np.array(camera.eye)
    hits = stage.rays(np.repeat(eye[None], len(points), axis=0), points)
    free = np.array([hit < 0 or stage.small(int(hit)) for hit in hits])
    return np.asarray(free & _in_picture(points - eye, ahead))


def visible_from_robot(stage: Stage, scene: Scene, recording: Recording, moment: Moment) -> list[str]:
    """Names of the objects that the robot's head camera sees at a moment, sorted.

    An object is seen if it lies within the picture and a ray to its middle or to the middle of its top meets nothing
    else first. The stage must show the moment.
    """
    camera = _eyes(stage, recording, moment)
    eye, ahead = np.array(camera.eye), np.array(camera.target) - np.array(camera.eye)
    with_people = {moment.held[agent].name for agent in moment.held if agent not in stage.robots}
    with_people = with_people.union(*moment.worn.values())
    names, points = [], []
    for thing in (*scene.fixed, *recording.state.objects(scene)):
        if thing.name in with_people:
            continue
        where = None if thing.fixed else moment.moved.get(thing.name) or recording.state.thing(thing)
        x, y, z = thing.position if where is None else where.position
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
