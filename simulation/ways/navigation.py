"""Where a body can stand and walk: a clearance grid of the home, shortest paths on it, and places to act from.

Bodies are discs of radius 0.30 m. Small objects are no obstacles; other agents may be given as some.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.sparse import csr_matrix

from coopera.core.errors import SimulationError
from coopera.simulation.homes.catalogue import blocks
from coopera.simulation.homes.floorplan import Point, Wall
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.ways.floor import CELL as CELL
from coopera.simulation.ways.floor import FAR, Discs, Floor
from coopera.simulation.ways.floor import RADIUS as RADIUS
from coopera.simulation.ways.floor import Disc as Disc
from coopera.simulation.ways.paths import Ways

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

REACH = 0.80
"""Farthest a thing may lie from where one stands: both bodies can then take it."""
STOP = 0.55
"""Farthest from a piece of furniture (its rectangle on the floor) at which one acts on it."""
_DOORWAY = 0.45
"""Two rooms of an imported home at most this far apart from a point may have a doorway there, in metres."""
_COMFORT = 0.45
_DISLIKE = 1.5
"""Walking closer than `_COMFORT` to something counts up to this much longer than it is."""
_STANDS_APART = 0.15
_STEP_ASIDE, _SPREAD = 3.0, 0.5
_REMEMBERED = 256


class Route(NamedTuple):
    """A way to walk: corner points from start to goal, its length in metres, or why there is none."""

    points: list[Point] | None
    length: float = math.inf
    reason: str = ""


class Stand(NamedTuple):
    """A place to act from: where, the heading that faces the target, walking distance, and distance to it."""

    x: float
    y: float
    yaw: float
    walk: float
    gap: float


def obstacle_boxes(things: Iterable[SceneObject], walls: Iterable[Wall]) -> Array:
    """Return obstacles as rows (x, y, half width, half depth, yaw), shape (n, 5)."""
    rows = [(*thing.xy, thing.size[0] / 2, thing.size[1] / 2, thing.yaw) for thing in things]
    rows += [wall.block for wall in walls]
    return np.array(rows, dtype=float).reshape(-1, 5)


def clearance(x: Array, y: Array, boxes: Array) -> Array:
    """Distance from each point to the nearest box (0 inside one); inf without boxes. Any shape in, same out."""
    nearest = np.full(np.shape(x), np.inf)
    for cx, cy, half_x, half_y, yaw in boxes:
        dx, dy = x - cx, y - cy
        cos, sin = math.cos(yaw), math.sin(yaw)
        out_x = np.maximum(np.abs(dx * cos + dy * sin) - half_x, 0.0)
        out_y = np.maximum(np.abs(dy * cos - dx * sin) - half_y, 0.0)
        np.minimum(nearest, np.hypot(out_x, out_y), out=nearest)
    return nearest


class Navigator:
    """Paths and standing places in one home. Built once; holds no state that changes what it answers."""

    def __init__(self, scene: Scene) -> None:
        """Build the grid: about 20 ms for a home of 100 square metres.

        Raises:
            SimulationError: If nowhere in the home is room to stand.
        """
        self.scene = scene
        edge = scene.bounds.grown(CELL)
        self._x0, self._y0 = edge.x0, edge.y0
        self._xs = np.arange(edge.x0, edge.x1 + CELL, CELL)
        self._ys = np.arange(edge.y0, edge.y1 + CELL, CELL)
        grid_x, grid_y = np.meshgrid(self._xs, self._ys, indexing="ij")
        boxes = obstacle_boxes((thing for thing in scene.fixed if blocks(thing)), scene.walls())
        self._clear = self._clearances(boxes)
        self._room = np.full(grid_x.shape, -1)
        for index, room in enumerate(scene.rooms):
            self._room[room.covers(grid_x, grid_y) & (self._room < 0)] = index  # on a shared edge: as in room_at
        if scene.stage is not None:
            self._fill_doorways(grid_x, grid_y)
        self._clear[self._room < 0] = 0.0
        self._floor = Floor(self._clear, (self._x0, self._y0))
        free = self._clear >= RADIUS
        parts, count = label(free)
        if not count:
            raise SimulationError(f"In the home {scene.id!r} there is no room to stand anywhere.")
        sizes = np.bincount(parts.ravel())
        sizes[0] = 0
        self._free: Mask = parts == int(sizes.argmax())
        self._number = np.full(free.shape, -1)
        self._number[self._free] = np.arange(int(self._free.sum()))
        self._cells = np.argwhere(self._free)
        self._centres = np.stack([self._xs[self._cells[:, 0]], self._ys[self._cells[:, 1]]], axis=1)
        of_cell = self._room[self._cells[:, 0], self._cells[:, 1]]
        self._in_room = [np.flatnonzero(of_cell == index) for index in range(len(scene.rooms))]
        self._ways = Ways(self._build_graph(), of_cell)
        self._nearest = lru_cache(maxsize=_REMEMBERED)(self._look_nearest)
        self._way = lru_cache(maxsize=_REMEMBERED)(self._work_out_way)

    def path(self, start: Point, goal: Point, *, avoid: Discs = ()) -> list[Point] | None:
        """Corner points from start to goal, or None; `route` also says why."""
        return self.route(start, goal, avoid=avoid).points

    def route(self, start: Point, goal: Point, *, avoid: Discs = ()) -> Route:
        """Return the shortest comfortable way between two points, pulled straight where nothing is in the way.

        Start and goal are moved to the nearest place where one can stand, at most 0.6 m away.
        """
        return self._way(start, goal, avoid)

    def _work_out_way(self, start: Point, goal: Point, avoid: Discs) -> Route:
        first, last = self._nearest(start, avoid), self._nearest(goal, avoid)
        if first is None or last is None:
            what = "start" if first is None else "goal"
            place = start if first is None else goal
            return Route(None, reason=f"there is no room to stand at the {what} ({place[0]:.2f}, {place[1]:.2f})")
        chain = (
            self._ways.chain_around(first, last, np.flatnonzero(~_outside(avoid, self._centres)))
            if avoid
            else self._ways.chain(first, last)
        )
        if chain is None:
            return Route(None, reason="somebody stands in the way" if avoid else "the way is blocked")
        corners = self._floor.pulled([(x, y) for x, y in self._centres[chain].tolist()], avoid)
        points = [start, *corners] if math.dist(start, corners[0]) > CELL else [start, *corners[1:]]
        points = points if len(points) > 1 else [start, corners[-1]]
        return Route(points, sum(math.dist(a, b) for a, b in zip(points, points[1:], strict=False)))

    def distance(self, start: Point, goal: Point) -> float:
        """Length of the way between two points in metres; inf where there is none."""
        return self.route(start, goal).length

    def approach(
        self,
        target: SceneObject | Point,
        start: Point | None = None,
        *,
        point: Point | None = None,
        reach: float = REACH,
        most: int = 12,
    ) -> list[Stand]:
        """Places to act from, best first: a short walk, near the target, and in front of it.

        A target that is a piece of furniture is stood at within `STOP` of its rectangle; with `point` (a thing
        on it) also within `reach` of that point. A target that is a point is stood at within `reach`. Places lie
        in the target's room, at least 0.15 m apart. Empty where there is none, or none that `start` leads to.
        """
        nodes, face = self._near(target, point, reach)
        places = self._centres[nodes]
        if not len(nodes):
            return []
        walk = np.zeros(len(nodes))
        if start is not None:
            first = self._nearest(start, ())
            if first is None:
                return []
            walk = self._ways.costs(first, nodes)
        gap = self._gaps(target, places) if point is None else np.hypot(*(places - np.array(point)).T)
        cost = walk + 2 * gap + self._off_front(target, places)
        order = np.lexsort((nodes, cost))
        order = order[np.isfinite(cost[order])]
        stands: list[Stand] = []
        while len(order) and len(stands) < most:
            i = int(order[0])
            x, y = places[i].tolist()
            fx, fy = face if point is not None or isinstance(target, tuple) else _facing_point(target, x, y)
            stands.append(Stand(x, y, math.atan2(fy - y, fx - x), float(walk[i]), float(gap[i])))
            order = order[np.hypot(places[order, 0] - x, places[order, 1] - y) >= _STANDS_APART]
        return stands

    def give_way(
        self, here: Point, route: Sequence[Point], *, space: float = 2 * RADIUS, taken: Iterable[Disc] = ()
    ) -> Iterator[Point]:
        """Places, not taken, to step to so that a walker on `route` passes: a short walk past the taken ones first."""
        taken = tuple(taken)
        free, first = _outside(taken, self._centres), self._nearest(here, taken)
        for nearest, farthest in ((0.0, _STEP_ASIDE), (_STEP_ASIDE, math.inf)) if first is not None else ():
            walk = self._ways.costs_around(first or 0, np.flatnonzero(~free), farthest)
            nodes = np.flatnonzero(np.isfinite(walk) & (walk >= nearest) & free)
            away = np.full(len(nodes), np.inf)
            for a, b in zip(route, route[1:], strict=False):
                away = np.minimum(away, to_segment(self._centres[nodes], a, b))
            nodes = nodes[away >= space + 0.05]
            nodes = nodes[np.argsort(walk[nodes], kind="stable")]
            while len(nodes):
                yield self._point(int(nodes[0]))
                nodes = nodes[np.hypot(*(self._centres[nodes] - self._centres[nodes[0]]).T) >= _SPREAD]

    def can_stand(self, x: float, y: float) -> bool:
        """Whether a body fits at a point and the rest of the home can be reached from there."""
        node = self._nearest((x, y), (), within=CELL)
        return node is not None and self._floor.clearance(x, y) >= RADIUS - 0.01

    def cells_in(self, room: str) -> Array:
        """Centres of all cells of a room where one can stand, in fixed order; shape (n, 2)."""
        centres: Array = self._centres[self._in_room[self._index(room)]]
        return centres

    def clearance_in(self, room: str) -> Array:
        """How far each of the same cells is from the nearest obstacle, in metres up to 2; shape (n,)."""
        clear: Array = self._clear[tuple(self._cells[self._in_room[self._index(room)]].T)]
        return clear

    def _index(self, room: str) -> int:
        return next(i for i, known in enumerate(self.scene.rooms) if known.name == room)

    def middle_of(self, room: str) -> Point | None:
        """The place of a room with most space around it; None where one cannot stand in it."""
        index = self._index(room)
        space = np.where(self._free & (self._room == index), self._clear, -1.0)
        best = int(space.argmax())
        if space.flat[best] < 0:
            return None
        i, j = np.unravel_index(best, space.shape)
        return float(self._xs[i]), float(self._ys[j])

    def _fill_doorways(self, grid_x: Array, grid_y: Array) -> None:
        """Give what lies between two rooms of an imported home, whose rooms do not touch, to the nearer of them."""
        away = np.array([room.away(grid_x, grid_y) for room in self.scene.rooms])
        between = (self._room < 0) & ((away <= _DOORWAY).sum(axis=0) > 1)
        self._room[between] = away.argmin(axis=0)[between]

    def _clearances(self, boxes: Array) -> Array:
        """Clearance of every cell, up to `FAR`: beyond that nobody asks, and each box is looked at only nearby."""
        clear = np.full((len(self._xs), len(self._ys)), FAR)
        for box in boxes:
            around = math.hypot(box[2], box[3]) + FAR
            i, j = np.searchsorted(self._xs, (box[0] - around, box[0] + around))
            k, m = np.searchsorted(self._ys, (box[1] - around, box[1] + around))
            x, y = np.meshgrid(self._xs[i:j], self._ys[k:m], indexing="ij")
            np.minimum(clear[i:j, k:m], clearance(x, y, box[None]), out=clear[i:j, k:m])
        return clear

    def _near(self, target: SceneObject | Point, point: Point | None, reach: float) -> tuple[NDArray[np.int64], Point]:
        """Nodes of the target's room that are near enough to act from, and the point to face."""
        room = self.scene.room_at(*target).name if isinstance(target, tuple) else target.room
        nodes = self._in_room[self._index(room)]
        aim = target if isinstance(target, tuple) else point
        if aim is not None:
            nodes = nodes[np.hypot(*(self._centres[nodes] - np.array(aim)).T) <= reach]
        if isinstance(target, tuple):
            return nodes, target
        standing_on_something = target.position[2] > 0.2  # a microwave on a counter: its support keeps one away
        gaps = self._gaps(target, self._centres[nodes])
        return nodes[gaps <= (REACH - 0.05 if standing_on_something else STOP)], point or target.xy

    def _gaps(self, target: SceneObject | Point, places: Array) -> Array:
        if isinstance(target, tuple):
            return np.asarray(np.hypot(*(places - np.array(target)).T))
        return clearance(places[:, 0], places[:, 1], obstacle_boxes([target], []))

    def _off_front(self, target: SceneObject | Point, places: Array) -> Array:
        """0.6 for places behind or beside a piece of furniture, 0 for those in front of it."""
        if isinstance(target, tuple) or not blocks(target):
            return np.zeros(len(places))
        ahead = (places - np.array(target.xy)) @ np.array([math.cos(target.facing), math.sin(target.facing)])
        return np.where(ahead > target.size[1] / 2, 0.0, 0.6)

    def _build_graph(self) -> csr_matrix:
        heads, tails, weights = [], [], []
        for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1)):
            here = self._cells
            there = here + np.array([dx, dy])
            inside = (there >= 0).all(1) & (there < np.array(self._free.shape)).all(1)
            here, there = here[inside], there[inside]
            ok = self._free[there[:, 0], there[:, 1]]
            if dx and dy:  # no cutting of corners
                ok &= self._free[there[:, 0], here[:, 1]] & self._free[here[:, 0], there[:, 1]]
            here, there = here[ok], there[ok]
            tight = np.minimum(self._clear[here[:, 0], here[:, 1]], self._clear[there[:, 0], there[:, 1]])
            dislike = np.clip((_COMFORT - tight) / (_COMFORT - RADIUS), 0.0, 1.0) * (_DISLIKE - 1.0)
            heads.append(self._number[here[:, 0], here[:, 1]])
            tails.append(self._number[there[:, 0], there[:, 1]])
            weights.append(CELL * math.hypot(dx, dy) * (1.0 + dislike))
        head, tail, weight = np.concatenate(heads), np.concatenate(tails), np.concatenate(weights)
        both = (np.concatenate([head, tail]), np.concatenate([tail, head]))
        return csr_matrix((np.concatenate([weight, weight]), both), shape=(len(self._cells),) * 2)

    def _look_nearest(self, place: Point, avoid: Discs, within: float = 0.6) -> int | None:
        room = next((i for i, known in enumerate(self.scene.rooms) if known.contains(*place)), None)
        i, j = round((place[0] - self._x0) / CELL), round((place[1] - self._y0) / CELL)
        if not avoid and 0 <= i < len(self._xs) and 0 <= j < len(self._ys):
            node = int(self._number[i, j])
            if node >= 0 and room in (None, self._room[i, j]):
                return node
        away = np.hypot(*(self._centres - np.array(place)).T)
        if room is not None:  # not through a wall, unless this side has no room at all
            away += 0.3
            away[self._in_room[room]] -= 0.3
        if avoid:
            away = np.where(_outside(avoid, self._centres), away, np.inf)
        best = int(away.argmin())
        return best if away[best] <= within else None

    def _point(self, node: int) -> Point:
        return float(self._centres[node, 0]), float(self._centres[node, 1])


def _facing_point(target: SceneObject, x: float, y: float) -> Point:
    """The point of a piece of furniture to look at: its middle, but no more than half a metre to the side."""
    bounds = target.bounds
    cx, cy = target.xy
    nearest_x, nearest_y = min(max(x, bounds.x0), bounds.x1), min(max(y, bounds.y0), bounds.y1)
    return (cx + nearest_x) / 2, (cy + nearest_y) / 2


def _outside(avoid: Iterable[Disc], places: Array) -> Mask:
    outside: Mask = np.ones(len(places), dtype=bool)
    for disc in avoid:
        outside &= np.hypot(*(places - np.array([disc.x, disc.y])).T) >= disc.radius + RADIUS
    return outside


def to_segment(places: Array, a: Point, b: Point) -> Array:
    """Distance of each place to the straight way between two points; shape (n, 2) to (n,)."""
    start, along = np.array(a), np.array(b) - np.array(a)
    length = float(along @ along)
    share = np.clip(((places - start) @ along) / length, 0.0, 1.0) if length > 0 else np.zeros(len(places))
    return np.asarray(np.hypot(*(places - start - share[:, None] * along).T))
