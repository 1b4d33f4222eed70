"""Where to look from: the robot's standing place and the third-person camera, chosen so that a person is seen."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.acts.plans import Placed, all_clear_of
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Room, Scene
from coopera.simulation.shapes.rotations import Array, about_z
from coopera.simulation.sight.hiding import Body, angle_from_front, behind_balls, behind_boxes, boxes_of
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.stances import eye_level
from coopera.simulation.ways.navigation import RADIUS, Disc, Navigator, to_segment

ROBOT_FOV = 60.0
VIEW_FOV = 50.0
_MARGIN, _TALL, _LENS = 1.2, 1.15, (22.0, 56.0)
"""How much more than what it is to show is in a picture from across the room, how many metres of it are so at least,
and the narrowest and the widest lens."""
_RING = ((2.0, 2.5, 1.5, 1.2), 24, (1.5, 1.9, 2.35))  # PAPER says no camera; radii (m), angles, heights (m) are ours
_CORNER = (0.25, 2.2)
"""How far from a room's walls, and how high, the cameras in its corners are (metres)."""
_OFF_WALL = 0.12
"""How far from a room's walls any camera across the room is, at least (metres)."""
_WATCH = (1.1, 4.5)
_COMFORT = 2.1
_KEEP_OFF = (0.65, 0.9)
"""How far from the person's way the robot stands at least, and what it would like (metres)."""
_CROWDED = 1.2
"""What each metre costs that it stands nearer to the way than it would like."""
_MANY = 400
_GLANCES = 3
_AT_ONCE = 16
_SIGHT = 6.0
"""What it counts to see all of a body; the rest of a score is fractions of 1."""
_ACROSS = 9.0
"""The same for the camera across the room, which is in nobody's way."""
_LEAST = 0.15
"""Who sees a smaller share of a body does not see it."""
_SIDE, _BACK = 0.3, (1.75, 0.8)
"""What each radian from the front costs, and what it costs besides from where on."""
_BESIDE, _ASKANCE = 1.2, 0.8
"""From across the room each radian beyond the first costs so much more: shoulders hide what hands do."""
_OVERHEAD = 4.5
_IN = 0.03  # metres
_WELL = 0.95
"""How much of half a picture counts as within it."""
_CLOSE = 0.9  # metres
_FRONT = 0.5  # square metres that a standing body shows
_APART = 0.8
"""Places that are looked through are at least this far apart (metres)."""


class Focus(NamedTuple):
    """The subject of a picture: a body in the act, its room, and who else hides it.

    `ignore` is the furniture that it is on or in, or has a hand in, and `held` what is in a hand: their hulls would
    stop all rays. `framed` are the points that a picture from across the room has within it, shape (n, 3); the body's
    own, if nothing is said.
    """

    placed: Placed
    body: Body
    ignore: tuple[str, ...]
    room: str
    others: tuple[Body, ...] = ()
    held: tuple[str, ...] = ()
    framed: Array | None = None


class Lens(NamedTuple):
    """What pictures are taken with: the point in their middle, and the vertical field of view in degrees."""

    target: tuple[float, float, float]
    fov: float

    def shows(self, eyes: Array, points: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Whether a 4:3 picture from each eye has a point well within it; shapes (n, 3) to (n,)."""
        ahead = np.array(self.target) - eyes
        ahead = ahead / np.linalg.norm(ahead, axis=1)[:, None]
        right = np.stack((ahead[:, 1], -ahead[:, 0], 0 * ahead[:, 0]), axis=1)
        right = right / np.maximum(np.linalg.norm(right, axis=1), 1e-9)[:, None]
        lines, tall = points - eyes, math.tan(math.radians(self.fov) / 2) * _WELL
        depth, across = (lines * ahead).sum(axis=1), (lines * right).sum(axis=1)
        high = (lines * np.cross(right, ahead)).sum(axis=1)
        return np.asarray((depth > 0) & (np.abs(high) <= tall * depth) & (np.abs(across) <= tall * 4 / 3 * depth))


class Eyes(NamedTuple):
    """Who is to see it: the robot's body, and where it is; a short drive is preferred."""

    body: RobotBody
    start: Point


def around(scene: Scene, person: Placed) -> tuple[str, ...]:
    """Furniture that a body is on or in: its hull would stop all rays to them."""
    return tuple(thing.name for thing in scene.fixed if thing.bounds.distance(person.x, person.y) < 0.05)


def within(scene: Scene, points: Array) -> tuple[str, ...]:
    """Furniture in whose hull a point is, such as a hand over a bed; points of shape (n, 3)."""
    boxes = np.array([thing.bounds for thing in scene.fixed]).reshape(-1, 4)[:, :, None]
    x, y, z = points.T
    away = np.hypot(
        np.maximum(np.maximum(boxes[:, 0] - x, x - boxes[:, 2]), 0.0),
        np.maximum(np.maximum(boxes[:, 1] - y, y - boxes[:, 3]), 0.0),
    )
    low = z < np.array([thing.top + _IN for thing in scene.fixed])[:, None]
    inside = ((away < _IN) & low).any(axis=1)
    return tuple(thing.name for thing, it in zip(scene.fixed, inside.tolist(), strict=True) if it)


def robot_camera(body: RobotBody, robot: Placed) -> Camera:
    """The camera in a robot's head."""
    place, direction = body.camera(robot.pose)
    heading = about_z(robot.yaw)
    eye = heading @ place + np.array((robot.x, robot.y, 0.0))
    target = eye + heading @ direction
    return Camera(_point(eye), _point(target), ROBOT_FOV)


def _point(place: Array) -> tuple[float, float, float]:
    return float(place[0]), float(place[1]), float(place[2])


def _unhidden(scene: Scene, eyes: Array, focus: Focus, aim: Lens) -> NDArray[np.bool_]:
    """Which points of the body each eye may see through a lens, before rays are cast; shape (eyes, points).

    What the body is on or in hides by its parts, and the body hides itself; other bodies hide it, too.
    """
    points = focus.body.points
    starts, ends = np.repeat(eyes, len(points), axis=0), np.tile(points, (len(eyes), 1))
    bodies = (focus.body, *focus.others)
    balls, radii = (np.concatenate([getattr(body, name) for body in bodies]) for name in ("balls", "radii"))
    free = aim.shows(starts, ends)
    free[free] = ~behind_balls(starts[free], ends[free], balls, radii)
    boxes = boxes_of([thing for thing in scene.fixed if thing.name in focus.ignore])
    free[free] = ~behind_boxes(starts[free], ends[free], boxes)
    return free.reshape(len(eyes), len(points))


def _struck(stage: Stage, eyes: Array, focus: Focus, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which of the points that each eye may see it does see: other furniture hides what is behind the box around it."""
    of_eye, of_point = np.nonzero(free)
    hits = stage.rays(eyes[of_eye], focus.body.points[of_point])
    seen = free.copy()
    seen[free] = (hits < 0) | np.isin(hits, [stage.home.bodies[name] for name in focus.held])
    return seen


def _best_seeing(  # noqa: PLR0913 - what is looked for, from where, and what counts
    stage: Stage,
    scene: Scene,
    eyes: Array,
    places: Array,
    focus: Focus,
    aim: Lens,
    worth: float,
    convenience: Array,
    allowed: Callable[[Point], bool],
    least: float = -1.0,
) -> tuple[list[int], Array]:
    """The few best eyes at allowed places that lie apart, best first, and the scores of all that may be among them.

    A score is the share of the body that is seen, times its `worth`, and the eye's `convenience`, shape (n,); eyes that
    see no more than the `least` share are left out. Rays cost most: they are cast for the most promising eyes first,
    and for none that could not be among the best. What the body is on or in is out of the way of rays meanwhile.
    """
    weights = focus.body.weights
    free = _unhidden(scene, eyes, focus, aim)
    hoped = worth * (free @ weights) + convenience
    score = np.full(len(eyes), -np.inf)
    best: list[int] = []
    left, many = np.argsort(-hoped, kind="stable"), _AT_ONCE
    stage.hide(focus.ignore)
    while len(left):
        some, left, many = left[:many], left[many:], 2 * many
        share = _struck(stage, eyes[some], focus, free[some]) @ weights
        score[some] = np.where(share > least, worth * share + convenience[some], -np.inf)
        known = np.flatnonzero(np.isfinite(score))
        best = [int(known[i]) for i in _best_apart(places[known], score[known], allowed)]
        if len(best) == _GLANCES and len(left) and score[best[-1]] > hoped[left[0]] + 1e-5:
            break
    stage.unhide(focus.ignore)
    return best, score


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
    person = focus.placed
    cells = np.concatenate([navigator.cells_in(focus.room), *_doorways(navigator, focus)])
    if not len(cells):
        return None
    away = np.hypot(cells[:, 0] - person.x, cells[:, 1] - person.y)
    off = np.full(len(cells), np.inf)
    for a, b in zip(keep_clear, keep_clear[1:], strict=False):
        off = np.minimum(off, to_segment(cells, a, b))
    near = (away >= _WATCH[0]) & (away <= _WATCH[1])
    free = off >= _KEEP_OFF[0]
    close = _CROWDED * np.maximum(_KEEP_OFF[1] - off, 0.0)
    place = _best_sight(stage, navigator.scene, eyes, focus, cells[near & free], close[near & free], taken, _anywhere)
    if place is not None:
        return place
    beside = near & ~free

    def can_pass(place: Point) -> bool:
        past = Disc(*place, RADIUS)
        return navigator.route(keep_clear[0], keep_clear[-1], avoid=(past,)).points is not None

    return _best_sight(stage, navigator.scene, eyes, focus, cells[beside], close[beside], taken, can_pass)


def _best_sight(  # noqa: PLR0913 - what is looked for, by whom, and where
    stage: Stage,
    scene: Scene,
    robot: Eyes,
    focus: Focus,
    cells: Array,
    close: Array,
    taken: list[Disc],
    allowed: Callable[[Point], bool],
) -> Point | None:
    """The allowed cell, of shape (n, 2), from which the person is seen best; None if they are seen from none.

    `close` is what each costs for being in the way, shape (n,).
    """
    person = focus.placed
    step = 4 if len(cells) > _MANY else 1
    clear = all_clear_of(cells[::step], taken)
    cells, close = cells[::step][clear], close[::step][clear]
    if not len(cells):
        return None
    away = np.hypot(cells[:, 0] - person.x, cells[:, 1] - person.y)
    towards = np.arctan2(person.y - cells[:, 1], person.x - cells[:, 0])
    ahead, _, high = robot.body.camera(robot.body.tucked)[0].tolist()
    eyes = np.stack(
        (cells[:, 0] + ahead * np.cos(towards), cells[:, 1] + ahead * np.sin(towards), high + 0 * away), axis=1
    )
    drive = np.hypot(cells[:, 0] - robot.start[0], cells[:, 1] - robot.start[1])
    side = angle_from_front(person, cells[:, 0], cells[:, 1])
    convenience = -0.25 * np.abs(away - _COMFORT) - _from_behind(side) - 0.02 * drive - close
    lens = Lens((person.x, person.y, eye_level(person)), ROBOT_FOV)
    best, score = _best_seeing(stage, scene, eyes, cells, focus, lens, _SIGHT, convenience, allowed, _LEAST)
    if not best:
        return None
    stage.hide(focus.ignore)
    cameras = [Camera(_point(eyes[i]), lens.target, ROBOT_FOV) for i in best]
    clearest = _clearest(stage, cameras, score[best])
    stage.unhide(focus.ignore)
    return _floor(cells[best[clearest]])


def _from_behind(side: Array) -> Array:
    """What it costs to look at a body from an angle from its front, in radians."""
    cost: Array = _SIDE * side + _BACK[1] * np.maximum(side - _BACK[0], 0.0)
    return cost


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
    return [c[np.hypot(c[:, 0] - focus.placed.x, c[:, 1] - focus.placed.y) <= _WATCH[1]] for c in rooms]


def view_camera(stage: Stage, scene: Scene, focus: Focus) -> Camera:
    """The third-person camera: of places around the body and in the room's corners, the one that sees it best."""
    placed, points = focus.placed, focus.body.points if focus.framed is None else focus.framed
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    room = scene.room(focus.room) or scene.rooms[0]
    radii, count, heights = _RING
    inset, high = _CORNER
    ring = [
        (placed.x + r * math.cos(k * math.tau / count), placed.y + r * math.sin(k * math.tau / count), z)
        for r in radii
        for z in heights
        for k in range(count)
    ]
    corners = [(x, y, high) for x, y in room.corners(inset)]
    eyes = np.array([*ring, *corners])
    inside = _in_the_open(scene, room, eyes)
    target = _point(middle)
    if not inside.any():
        corner = room.centre
        return Camera((corner[0], corner[1], _OVERHEAD), target, VIEW_FOV)
    eyes = eyes[inside]
    side = angle_from_front(placed, eyes[:, 0], eyes[:, 1])
    away = np.hypot(eyes[:, 0] - placed.x, eyes[:, 1] - placed.y)
    cost = _from_behind(np.maximum(side, 0.7)) + 0.2 * np.abs(away - 2.0) + 0.2 * np.abs(eyes[:, 2] - 2.0)
    cost += _ASKANCE * np.maximum(side - _BESIDE, 0.0)
    lens = Lens(target, VIEW_FOV)
    best, score = _best_seeing(stage, scene, eyes, eyes, focus, lens, _ACROSS, -cost, _anywhere)
    cameras = [Camera(_point(eyes[i]), target, VIEW_FOV) for i in best]
    camera = cameras[_clearest(stage, cameras, score[best])]
    return camera if focus.framed is None else _closed_in(camera, focus.framed)


def _closed_in(camera: Camera, points: Array) -> Camera:
    """The same camera with the lens that just has some points in its 4:3 picture, with a margin."""
    ahead = np.array(camera.target) - np.array(camera.eye)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.array((ahead[1], -ahead[0], 0.0)) / max(math.hypot(float(ahead[0]), float(ahead[1])), 1e-9)
    lines = points - np.array(camera.eye)
    depth = np.maximum(lines @ ahead, 0.3)
    high, wide = np.abs(lines @ np.cross(right, ahead)) / depth, np.abs(lines @ right) / depth
    least = _TALL / 2 / math.dist(camera.eye, camera.target)
    tall = max(_MARGIN * float(high.max()), _MARGIN * float(wide.max()) * 3 / 4, least)
    return camera._replace(fov=min(max(2 * math.degrees(math.atan(tall)), _LENS[0]), _LENS[1]))


def _in_the_open(scene: Scene, room: Room, eyes: Array) -> NDArray[np.bool_]:
    """Whether a camera at each of many places is in the room and in no piece of furniture; shape (n, 3) to (n,)."""
    x, y, z = eyes.T[:, :, None]
    boxes = np.array([thing.bounds for thing in scene.fixed]).reshape(-1, 4)
    tops = np.array([thing.top for thing in scene.fixed])
    gaps = np.hypot(
        np.maximum(np.maximum(boxes[:, 0] - x, x - boxes[:, 2]), 0.0),
        np.maximum(np.maximum(boxes[:, 1] - y, y - boxes[:, 3]), 0.0),
    )
    free = ((tops + 0.1 < z) | (gaps > 0.15)).all(axis=1)
    found: NDArray[np.bool_] = free & room.covers(eyes[:, 0], eyes[:, 1], _OFF_WALL)
    return found
