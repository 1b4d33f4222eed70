"""Where everything is from moment to moment of a day: the acts of its trace are done again, each of them recorded."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.clock import hour_label
from coopera.core.errors import RunError, SimulationError
from coopera.core.hour import HourRecord
from coopera.core.household import AgentId, Outcome
from coopera.rundir.directory import RunDir
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.people.skin import Skin, carriers
from coopera.simulation.people.weights import PARTS
from coopera.simulation.shapes.rotations import about_z, quaternion
from coopera.simulation.sight.cameras import robot_camera
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Moment, Recording
from coopera.simulation.sight.stage import Stage
from coopera.simulation.sight.timing import TICKS
from coopera.simulation.world import World
from coopera.studies.assemble import open_embeddings, open_home
from coopera.studies.replay import in_order
from coopera.web.replay3d.ways import Ways

FPS = 7.5
"""Moments shown a second."""
_LONGEST = 3.0  # seconds of one shot: a motion that goes on for eight looks the same all the time
_DEEPEST = -10.0  # metres; what is nowhere lies deeper
CAMERA = "camera"
"""The part of a robot that is its view: z ahead, x to the right."""


class Pose(NamedTuple):
    """A place in metres, and a turn as a quaternion w, x, y, z."""

    place: tuple[float, float, float]
    turn: tuple[float, float, float, float]


GONE = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
"""The pose of what is nowhere to be seen."""


class Frame(NamedTuple):
    """One moment: how long it lasts in seconds, what is going on, and where each thing and each part of a body is.

    `made` are things that the home did not have at first, by name.
    """

    seconds: float
    hour: str
    doing: Mapping[AgentId, str]
    poses: Mapping[str, Pose]
    made: Mapping[str, SceneObject]


class Scenery(NamedTuple):
    """What moves, and how its places are found: the home's stage, its robots, its people's skins, and their walks."""

    scene: Scene
    stage: Stage
    robots: Mapping[AgentId, RobotBody]
    skins: Mapping[AgentId, Skin]
    ways: Ways


class Shown(NamedTuple):
    """An act that was done again, and the home with its recording."""

    record: HourRecord
    act: Outcome
    home: World


def acts_of(run: RunDir, day: int) -> Generator[Shown]:
    """Do a day's acts again, one after another, and yield each of which there is something to see.

    The home begins as the trace has it after the hour before, if there was one in this episode.

    Raises:
        RunError: If the run has no such day, or its people lived their hours in another run.
    """
    records = run.read_day(day)
    if run.config.earlier_life is not None:
        raise RunError(
            f"{run.root}: this run met days lived before; show that life instead: {run.config.earlier_life}."
        )
    if not records:
        days = ", ".join(str(one) for one in run.days())
        raise RunError(f"{run.root}: there is no day {day}; there are {days or 'none yet'}.")
    before = [one for one in run.hours() if one.day < day and one.episode == records[0].episode]
    before = [one for one in before if one.scene == records[0].scene]
    with (
        open_embeddings(run.config) as embeddings,
        open_home(run.config, records[0].scene, embeddings, run.root) as home,
    ):
        home.restore(before[-1].world.get("poses", {}) if before else {})
        for record in records:
            watched = record.world.get("watched", record.robot is not None)
            for number, then in enumerate(in_order(record)):
                seen = watched and number == 0  # as in the run, where a robot then drove to where it saw the person
                done = home.perform(then.agent, then.act, record=seen, keep=not seen)
                if (done.ok or seen) and _has_recording(home):
                    yield Shown(record, then, home)
            home.restore(record.world.get("poses", {}))


def _has_recording(home: World) -> bool:
    try:
        return bool(home.recording.shots)
    except SimulationError:
        return False


def frames_of(scenery: Scenery, shown: Shown) -> Iterator[Frame]:
    """The moments of one act."""
    record, act, recording = shown.record, shown.act, shown.home.recording
    doing = {act.agent: act.act.describe()}
    hour = f"Day {record.day}, {hour_label(record.hour)}"
    if record.human is not None:
        hour += f": {record.human.intention.text}"
    made = {thing.name: thing for thing in recording.state.objects(scenery.scene) if thing.name in recording.state.box}
    moments = (between for moment in _moments(recording) for between in scenery.ways.to(moment))
    for moment in moments:
        yield Frame(1 / FPS, hour, doing, poses_at(scenery, recording, moment), made)


def _moments(recording: Recording) -> Iterator[Moment]:
    """Ticks at even distances, the last of each shot included, of long shots the beginning and the end."""
    step, most = round(TICKS / FPS), round(_LONGEST * TICKS)
    for shot in recording.shots:
        ticks = list(range(0, shot.ticks, step))
        if shot.ticks > 2 * most:
            ticks = [tick for tick in ticks if tick < 2 * most - TICKS or tick >= shot.ticks - TICKS]
        for tick in ticks:
            yield shot.at(tick)


def poses_at(scenery: Scenery, recording: Recording, moment: Moment) -> dict[str, Pose]:
    """Where everything that moves is: things by name, parts of a body as agent/part."""
    stage = scenery.stage
    stage.show(recording.state, moment)
    found = {f"things/{name}": _pose_of(stage, stage.home.bodies[name]) for name in _things(scenery, recording)}
    for agent, placed in moment.bodies.items():
        if agent in scenery.robots:
            found |= _links(stage, agent)
            found[f"{agent}/{CAMERA}"] = _view(scenery.robots[agent], placed)
        else:
            found |= _parts(agent, placed, scenery.skins[agent])
    return found


def _things(scenery: Scenery, recording: Recording) -> list[str]:
    known = scenery.stage.home.bodies
    return [thing.name for thing in recording.state.objects(scenery.scene) if thing.name in known]


def _pose_of(stage: Stage, body: int) -> Pose:
    place, (x, y, z, w) = pybullet.getBasePositionAndOrientation(body, physicsClientId=stage.client)
    return _rounded(place, (w, x, y, z)) if place[2] > _DEEPEST else GONE


def _links(stage: Stage, agent: AgentId) -> dict[str, Pose]:
    body, client = stage.bodies[agent], stage.client
    inner = pybullet.getDynamicsInfo(body, -1, physicsClientId=client)[3:5]
    base = pybullet.getBasePositionAndOrientation(body, physicsClientId=client)
    place, (x, y, z, w) = pybullet.multiplyTransforms(*base, *pybullet.invertTransform(*inner))
    found = {f"{agent}/-1": _rounded(place, (w, x, y, z))}
    for link in range(pybullet.getNumJoints(body, physicsClientId=client)):
        state = pybullet.getLinkState(body, link, computeForwardKinematics=True, physicsClientId=client)
        x, y, z, w = state[5]
        found[f"{agent}/{link}"] = _rounded(state[4], (w, x, y, z))
    return found


def _view(body: RobotBody, placed: Placed) -> Pose:
    eye, target = (np.array(one) for one in robot_camera(body, placed)[:2])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= max(float(np.linalg.norm(right)), 1e-6)
    x, y, z, w = quaternion(np.column_stack([right, np.cross(ahead, right), ahead]))
    return _rounded(tuple(eye), (w, x, y, z))


def _parts(agent: AgentId, placed: Placed, skin: Skin) -> dict[str, Pose]:
    heading, at = about_z(placed.yaw), np.array((placed.x, placed.y, 0.0))
    found = {}
    for number, carrier in enumerate(carriers(skin.rest, forward(placed.pose))):
        turn: NDArray[np.float64] = heading @ carrier[:, :3]
        x, y, z, w = quaternion(turn)
        found[f"{agent}/{PARTS[number]}"] = _rounded((heading @ carrier[:, 3] + at).tolist(), (w, x, y, z))
    return found


def _rounded(place: tuple[float, ...], turn: tuple[float, ...]) -> Pose:
    """A pose to half a millimetre: what has not moved is then the same."""
    x, y, z = (round(2000 * float(one)) / 2000 for one in place)
    a, b, c, d = (round(float(one), 3) for one in turn)
    return Pose((x, y, z), (a, b, c, d))
