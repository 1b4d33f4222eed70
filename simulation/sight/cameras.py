"""Where to look from: the robot's standing place and the third-person camera, chosen so that a person is seen."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Placed, all_clear_of
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene
from coopera.simulation.shapes.rotations import Array, about_z, wrapped
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.ways.navigation import RADIUS, Disc, Navigator, to_segment

ROBOT_FOV = 60.0
VIEW_FOV = 50.0
_SEEN = ("head", "chest", "right_hand", "left_hand", "pelvis", "right_knee", "left_knee")
_WEIGHTS = np.array((3.0, 2.0, 2.0, 2.0, 1.0, 0.5, 0.5))
_RING = ((2.0, 2.5, 3.0, 1.5), 24, (1.5, 1.9, 2.3))  # PAPER says no camera; radii (m), angles, heights (m) are ours
_WATCH = (1.4, 3.6)
_COMFORT = 2.3
_KEEP_OFF = 0.9
_GLANCES = 3
_AT_ONCE = 48
_LOOKS = 8
_SMALL, _LARGE = (48, 36), 0.04
"""Small pictures by which cameras are compared, and the share of one that is as much of a person as is wanted."""
_OVERHEAD = 4.5
_CLOSE = 0.9  # metres
_FRONT = 0.5  # square metres that a standing body shows
_APART = 0.8
"""Places that are looked through are at least this far apart (metres)."""


class Focus(NamedTuple):
    """The subject of a picture: a person in the act, the furniture under or around the body, and the room."""

    who: AgentId
    person: Placed
    ignore: tuple[str, ...]
    room: str


class Eyes(NamedTuple):
    """Who is to see it: the robot's body, and where it is; a short drive is preferred."""

    body: RobotBody
    start: Point


def body_points(person: Placed) -> Array:
    """Points of the body that should be seen, in the world; shape (7, 3)."""
    frames = forward(person.pose)
    points = np.array([frames.place[part] for part in _SEEN])
    turned: Array = points @ about_z(person.yaw).T + np.array((person.x, person.y, 0.0))
    return turned


def around(scene: Scene, person: Placed) -> tuple[str, ...]:
    """Furniture that a body is on or in: its hull would stop all rays to them."""
    return tuple(thing.name for thing in scene.fixed if thing.bounds.distance(person.x, person.y) < 0.05)


def robot_camera(body: RobotBody, robot: Placed) -> Camera:
    """The camera in a robot's head."""
    place, direction = body.camera(robot.pose)
    heading = about_z(robot.yaw)
    eye = heading @ place + np.array((robot.x, robot.y, 0.0))
    target = eye + heading @ direction
    return Camera(_point(eye), _point(target), ROBOT_FOV)


def _point(place: Array) -> tuple[float, float, float]:
    return float(place[0]), float(place[1]), float(place[2])


def seen_share(stage: Stage, eyes: Array, points: Array) -> Array:
    """Weighted share of the body's points that each eye sees; shapes (n, 3) and (7, 3) to (n,)."""
    starts = np.repeat(eyes, len(points), axis=0)
    ends = np.tile(points, (len(eyes), 1))
    free = (stage.rays(starts, ends) < 0).reshape(len(eyes), len(points))
    share: Array = (free * _WEIGHTS).sum(axis=1) / _WEIGHTS.sum()
    return share


def watching_place(
    stage: Stage,
    navigator: Navigator,
    eyes: Eyes,
    focus: Focus,
    keep_clear: list[Point],
    taken: list[Disc],
) -> Point | None:
    """Choose where a robot stands to watch: it sees most of the person, from the front, and is in nobody's way.

    Where the person's way leaves no such place (a narrow kitchen), it may stand beside the way, if the person can
    still get past.

    Args:
        stage: Set to the home as it is, without anything in the way that is not there.
        navigator: Of the same home.
        eyes: Who is to see it.
        focus: What to see.
        keep_clear: The person's way, as corner points from where they are to where they act.
        taken: Floor that the others take up.

    Returns:
        The place, or None if the person is seen from nowhere; the robot then stays where it is.
    """
    person = focus.person
    cells = np.concatenate([navigator.cells_in(focus.room), *_doorways(navigator, focus)])
    if not len(cells):
        return None
    away = np.hypot(cells[:, 0] - person.x, cells[:, 1] - person.y)
    off = np.full(len(cells), np.inf)
    for a, b in zip(keep_clear, keep_clear[1:], strict=False):
        off = np.minimum(off, to_segment(cells, a, b))
    apart = (away >= _WATCH[0]) & (away <= _WATCH[1]) & (off >= _KEEP_OFF)
    if apart.sum() < 20:
        apart = (away >= 0.9) & (away <= 5.0) & (off >= 0.65)
    place = _best_sight(stage, eyes, focus, cells[apart], taken, _anywhere)
    if place is not None:
        return place
    beside = (away >= 0.9) & (away <= 5.0) & (off < 0.65)

    def can_pass(place: Point) -> bool:
        past = Disc(*place, RADIUS)
        return navigator.route(keep_clear[0], keep_clear[-1], avoid=(past,)).points is not None

    return _best_sight(stage, eyes, focus, cells[beside], taken, can_pass)


def _best_sight(
    stage: Stage,
    robot: Eyes,
    focus: Focus,
    cells: Array,
    taken: list[Disc],
    allowed: Callable[[Point], bool],
) -> Point | None:
    """The allowed cell, of shape (n, 2), from which the person is seen best; None if they are seen from none."""
    person = focus.person
    cells = cells[::4] if len(cells) > 400 else cells
    cells = cells[all_clear_of(cells, taken)]
    if not len(cells):
        return None
    away = np.hypot(cells[:, 0] - person.x, cells[:, 1] - person.y)
    towards = np.arctan2(person.y - cells[:, 1], person.x - cells[:, 0])
    ahead, _, high = robot.body.camera(robot.body.tucked)[0].tolist()
    eyes = np.stack(
        (cells[:, 0] + ahead * np.cos(towards), cells[:, 1] + ahead * np.sin(towards), high + 0 * away), axis=1
    )
    side = np.abs(np.array([wrapped(float(t) + math.pi - person.yaw) for t in towards]))
    drive = np.hypot(cells[:, 0] - robot.start[0], cells[:, 1] - robot.start[1])
    convenience = -0.25 * np.abs(away - _COMFORT) - 0.25 * side - 0.02 * drive
    points, share, score = body_points(person), np.zeros(len(cells)), convenience
    best: list[int] = []
    left = np.argsort(-convenience, kind="stable")
    stage.hide(focus.ignore)
    while len(left):  # rays cost most: none for what cannot be better than the best, however much is seen from there
        some, left = left[:_AT_ONCE], left[_AT_ONCE:]
        share[some] = seen_share(stage, eyes[some], points)
        score = 3 * share + convenience
        seeing = np.flatnonzero(share > 0.2)
        best = [int(seeing[i]) for i in _best_apart(cells[seeing], score[seeing], allowed)]
        if len(best) == _GLANCES and len(left) and score[best[-1]] > 3 + convenience[left[0]] + 1e-5:
            break
    stage.unhide(focus.ignore)
    if not best:
        return None
    aim = points[1]
    cameras = [Camera(_point(eyes[i]), _point(aim), ROBOT_FOV) for i in best]
    return _floor(cells[best[_clearest(stage, cameras, score[best])]])


def _anywhere(place: Point) -> bool:
    return True


def _floor(cell: Array) -> Point:
    return float(cell[0]), float(cell[1])


def _best_apart(places: Array, score: Array, allowed: Callable[[Point], bool], most: int = _GLANCES) -> list[int]:
    """The few best allowed places that lie apart, best first."""
    found: list[int] = []
    tried: list[int] = []
    for i in np.argsort(-np.round(score, 6), kind="stable"):
        if all(math.hypot(*(places[i, :2] - places[j, :2])) >= _APART for j in tried):
            tried.append(int(i))
            if allowed(_floor(places[i])):
                found.append(int(i))
        if len(found) == most:
            break
    return found


def _clearest(stage: Stage, cameras: list[Camera], score: Array) -> int:
    """Which camera to take: near enough to show the person large, and with nothing close before the lens."""
    ahead = [_glance(camera) for camera in cameras]
    starts = np.repeat([camera.eye for camera in cameras], len(ahead[0]), axis=0)
    hits = stage.rays(starts, starts + _CLOSE * np.concatenate(ahead)).reshape(len(cameras), -1)
    close = (hits >= 0).mean(axis=1)
    values = []
    for camera, already, blocked in zip(cameras, score, close, strict=True):
        tall = 2 * math.tan(math.radians(camera.fov) / 2) * math.dist(camera.eye, camera.target)
        person = _FRONT / (tall * tall * 4 / 3)
        values.append(round(float(already) + 12 * min(person, 0.12) - 3 * float(blocked), 6))
    return values.index(max(values))


def _glance(camera: Camera) -> Array:
    """Unit vectors of a coarse raster over a 4:3 picture; shape (108, 3)."""
    ahead = np.array(camera.target) - np.array(camera.eye)
    ahead = ahead / math.sqrt(float(ahead @ ahead))
    right = np.array((ahead[1], -ahead[0], 0.0)) / max(math.hypot(float(ahead[0]), float(ahead[1])), 1e-9)
    tall = math.tan(math.radians(camera.fov) / 2)
    up, across = np.meshgrid(np.linspace(-tall, tall, 9), np.linspace(-tall, tall, 12) * 4 / 3)
    lines = ahead + up.reshape(-1, 1) * np.cross(right, ahead) + across.reshape(-1, 1) * right
    return np.asarray(lines / np.linalg.norm(lines, axis=1)[:, None])


def _doorways(navigator: Navigator, focus: Focus) -> list[Array]:
    """Places in the rooms next door within sight distance, for rooms too small to watch in."""
    scene = navigator.scene
    names = sorted({name for door in scene.doors if focus.room in door.between for name in door.between})
    rooms = [navigator.cells_in(name) for name in names if name != focus.room]
    return [c[np.hypot(c[:, 0] - focus.person.x, c[:, 1] - focus.person.y) <= _WATCH[1]] for c in rooms]


def view_camera(stage: Stage, scene: Scene, focus: Focus) -> Camera:
    """The third-person camera: of a ring of places in the room, the one that sees the body best and from the front."""
    person = focus.person
    points = body_points(person)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    room = scene.room(focus.room) or scene.rooms[0]
    radii, count, heights = _RING
    eyes = np.array(
        [
            (person.x + r * math.cos(k * math.tau / count), person.y + r * math.sin(k * math.tau / count), z)
            for r in radii
            for z in heights
            for k in range(count)
        ]
    )
    inside = np.array([_in_the_open(scene, room.bounds.grown(-0.12), eye) for eye in eyes])
    target = (float(middle[0]), float(middle[1]), float(middle[2]) + 0.05)
    if not inside.any():
        corner = room.centre
        return Camera((corner[0], corner[1], _OVERHEAD), target, VIEW_FOV)
    eyes = eyes[inside]
    stage.hide(focus.ignore)
    share = seen_share(stage, eyes, points)
    stage.unhide(focus.ignore)
    angle = np.arctan2(eyes[:, 1] - person.y, eyes[:, 0] - person.x)
    side = np.array([abs(wrapped(float(a) - person.yaw)) for a in angle])
    away = np.hypot(eyes[:, 0] - person.x, eyes[:, 1] - person.y)
    score = 3 * share - 0.3 * np.abs(side - 0.7) - 0.2 * np.abs(away - 2.5) - 0.1 * np.abs(eyes[:, 2] - 1.9)
    best = _best_apart(eyes, score, _anywhere, _LOOKS if focus.ignore else _GLANCES)
    cameras = [Camera(_point(eyes[i]), target, VIEW_FOV) for i in best]
    if not focus.ignore:
        return cameras[_clearest(stage, cameras, score[best])]
    cameras.append(Camera((target[0] + 0.3, target[1] + 0.3, _OVERHEAD), target, VIEW_FOV))
    return max(cameras, key=lambda camera: _shown(stage, camera, focus.who))


def _shown(stage: Stage, camera: Camera, who: AgentId) -> float:
    """How much of a small picture the person fills, up to `_LARGE`: what they are in may hide them, unlike its hull."""
    return min(round(float((stage.picture(camera, _SMALL)[1] == stage.bodies[who]).mean()), 4), _LARGE)


def _in_the_open(scene: Scene, bounds: tuple[float, float, float, float], eye: Array) -> bool:
    """Whether a camera there is in the room and in no piece of furniture."""
    x, y, z = (float(value) for value in eye)
    if not (bounds[0] <= x <= bounds[2] and bounds[1] <= y <= bounds[3]):
        return False
    return all(thing.top + 0.1 < z or thing.bounds.distance(x, y) > 0.15 for thing in scene.fixed)
