"""Import a house of ProcTHOR: its rooms as polygons, its objects as our own shapes, or boxes, of the published sizes.

Unity's frame is left-handed with y up and fronts towards +z; ours is right-handed with z up and fronts towards +y. So
(x, y, z) becomes (x, z, y), which looks alike from above, and an object turned by a about y is turned by -a about z.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import SimulationError
from coopera.core.household import SceneId, plain
from coopera.simulation.homes.catalogue import FLAT, catalogue, surfaces
from coopera.simulation.homes.floorplan import Bounds, Point
from coopera.simulation.homes.rooms import Array
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.homes.spots import Spot, Taken, furniture_on, spots, taken_at, taken_by
from coopera.simulation.making.procthor.files import Asset, House, Item
from coopera.simulation.making.procthor.plan import plan_of
from coopera.simulation.making.procthor.things import Kind, kind_of
from coopera.simulation.making.proof import prove
from coopera.simulation.making.report import HIGHEST, PLAIN, Imported, Report
from coopera.simulation.shapes.kit import Size
from coopera.simulation.ways.navigation import REACH, Navigator

_OFF_WALL = 0.055
"""From a room's edge to furniture: half a wall, and a hair."""
_STEP, _FARTHEST = 0.05, 0.8
_CELL = 4.0
"""Side of a cell, by which furniture is found that is near (metres)."""
_ON_FLOOR = 0.15
_REACHED = 1.45
"""Things stand no higher: nobody gets at what is on top of a high fridge."""
_MOVED = 0.15
"""What is shifted by less than this is where the house has it, in metres."""
_BEFORE_DOOR = 0.7
"""Furniture keeps this clear of the middle of a door where it can, in metres."""
_RUN = 0.65
"""Depth of the runs of a counter that goes around a corner."""


class _Piece(NamedTuple):
    """An object on its way: its kind, where its base's middle is, and its yaw."""

    what: str
    item: Item
    kind: Kind
    position: tuple[float, float, float]
    yaw: float


def import_house(house: House, id: str, path: Path, assets: Mapping[str, Asset] | None = None) -> Imported:
    """Make a home of a house.

    Args:
        house: As it was read.
        id: The home's id.
        path: The house's file, for errors.
        assets: Sizes and types of assets by their ids; without them an object has the usual size of its type.

    Raises:
        ConfigError: If its rooms cannot be taken over; names file and field.
    """
    plan = plan_of(house, path)
    maker = _Maker(Scene(id=SceneId(id), rooms=list(plan.rooms.values()), doors=plan.doors), assets or {})
    report = maker.report
    report.left_out.extend(plan.left_out)
    report.guessed.extend(plan.guessed)
    for number, item in enumerate(house.objects):
        maker.take(item, f"objects.{number}")
    scene = maker.finished()
    polygons = sum(room.polygon is not None for room in scene.rooms)
    inside = sum(thing.on is not None for thing in scene.movable)
    things = f"{len(scene.movable)} things that move, {inside} of them on furniture"
    ways = f"{len(scene.doors)} doors and openings"
    report.understood.append(f"{len(scene.rooms)} rooms, {polygons} of them no rectangles, and {ways}")
    report.understood.append(f"{len(scene.fixed)} pieces of furniture, {things}")
    return Imported(scene, report, prove(scene))


class _Maker:
    """A home that is being put together, the furniture first."""

    def __init__(self, scene: Scene, assets: Mapping[str, Asset]) -> None:
        self.scene = scene
        self.assets = assets
        self.report = Report()
        self._doors = [Bounds(door.x, door.y, door.x, door.y).grown(_BEFORE_DOOR) for door in scene.doors]
        self.fixed: list[SceneObject] = []
        self._raster: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
        self._waiting: list[tuple[_Piece, str]] = []
        self._count: Counter[str] = Counter()
        self._carriers: dict[str, list[str]] = {}

    def take(self, item: Item, what: str, parent: str = "") -> None:
        """Take an object and its children over; what moves waits until all furniture stands."""
        told = f"{what} ({item.asset})"
        kind = kind_of(item, self.assets)
        carrier = parent
        piece = _placed(told, item, kind)
        if kind.leave:
            self.report.left_out.append(f"{told}: {kind.leave}")
        elif piece.position[2] > HIGHEST:
            self.report.left_out.append(f"{told}: hangs {piece.position[2]:.2f} m above the floor, out of reach")
        else:
            if kind.guess:
                self.report.guessed.append(f"{told}: {kind.guess}")
            if max(abs(math.remainder(turn, 360.0)) for turn in (item.rotation.x, item.rotation.z)) > 3.0:
                self.report.guessed.append(f"{told}: it leans in the house, and stands upright here")
            if kind.fixed:
                names = [self._stand(one) for one in _runs(piece, self.scene)]
                carrier = what
                self._carriers[what] = [name for name in names if name]
            else:
                self._waiting.append((piece, parent))
        for number, child in enumerate(item.children):
            self.take(child, f"{what}.children.{number}", carrier)

    def _stand(self, piece: _Piece) -> str:
        """Put furniture where it stands, or as near as it has room; its name, or nothing where it has none."""
        room = self.scene.room_at(*piece.position[:2])
        thing = _object(piece, room, 0, self._name(piece.kind.cls))
        thing = self._lifted(thing)
        place = self._place(thing, room)
        if place is None:
            self.report.left_out.append(f"{piece.what}: there is no room for it within {_FARTHEST} m")
            return ""
        moved = thing.model_copy(update={"position": (*place, thing.position[2])})
        away = math.dist(moved.xy, thing.xy)
        if away > _MOVED:
            self.report.guessed.append(
                f"{piece.what}: shifted by {away:.2f} m, for it would stand in a wall or in another piece"
            )
        for cell in _cells(moved.bounds):
            self._raster[cell].append(len(self.fixed))
        self.fixed.append(moved)
        return moved.name

    def _place(self, thing: SceneObject, room: Room) -> Point | None:
        """The nearest place with room, of those clear of doors if there is one."""
        space, around = taken_by(thing), thing.bounds.grown(_FARTHEST + _STEP)
        near = (taken_by(other) for other in self._near(around) if min(other.size[2], thing.size[2]) > FLAT)
        filled = [one.bounds for one in near if space.low < one.high - 0.01 and one.low < space.high - 0.01]
        places = _around(thing.xy)
        half = taken_at(Spot(0.0, 0.0, 0.0, thing.yaw), thing.size).bounds
        free, beside = (_clear(np.array(places), half, spaces) for spaces in (filled, self._doors))
        for at in (*np.flatnonzero(free & beside), *np.flatnonzero(free & ~beside)):
            x, y = places[at]
            if room.encloses(Bounds(x + half.x0, y + half.y0, x + half.x1, y + half.y1).grown(_OFF_WALL)):
                return x, y
        return None

    def _near(self, bounds: Bounds) -> list[SceneObject]:
        """The furniture so far that may touch a rectangle, in the order in which it came."""
        return [self.fixed[at] for at in sorted({at for cell in _cells(bounds) for at in self._raster[cell]})]

    def _lifted(self, thing: SceneObject) -> SceneObject:
        """Furniture at its height: on the floor, on what is below it, or where it hangs."""
        x, y, z = thing.position
        if z < _ON_FLOOR:
            return thing.model_copy(update={"position": (x, y, 0.0)})
        near = self._near(thing.bounds.grown(0.1))
        below = [other for other in near if other.top <= z + 0.2 and other.bounds.encloses(thing.bounds, 0.1)]
        tops = [other.position[2] + row.z for other in below for row in surfaces(other)]
        nearest = min((top for top in tops if abs(top - z) < 0.3), key=lambda top: abs(top - z), default=z)
        return thing.model_copy(update={"position": (x, y, round(nearest, 4))})

    def _name(self, cls: str) -> str:
        self._count[cls] += 1
        return f"{cls}_{self._count[cls]}"

    def finished(self) -> Scene:
        """The home with everything that moves put on the furniture, or on the floor."""
        scene = self.scene.model_copy(update={"objects": [_numbered(one, i) for i, one in enumerate(self.fixed)]})
        scene = Scene.model_validate(scene.model_dump())
        try:
            navigator: Navigator | None = Navigator(scene)
        except SimulationError:  # `prove` says so
            navigator = None
        taken = {thing.name: furniture_on(scene, thing) for thing in scene.fixed}
        things: list[SceneObject] = []
        for piece, parent in self._waiting:
            found = self._put(piece, self._carriers.get(parent, []), scene, navigator, taken, things)
            if found is not None:
                things.append(_numbered(found, len(scene.objects) + len(things)))
        return Scene.model_validate(scene.model_copy(update={"objects": [*scene.objects, *things]}).model_dump())

    def _put(
        self,
        piece: _Piece,
        parents: Sequence[str],
        scene: Scene,
        navigator: Navigator | None,
        taken: dict[str, list[Taken]],
        things: Sequence[SceneObject],
    ) -> SceneObject | None:
        x, y, z = piece.position
        carriers = [thing for thing in scene.fixed if thing.name in parents]
        carriers = carriers or ([] if z <= _ON_FLOOR else _below(scene, piece.position))
        best: tuple[float, SceneObject, Spot] | None = None
        for carrier in carriers:
            stands = navigator.approach(carrier, most=40) if navigator else []
            for spot in (one for one in spots(carrier, piece.kind.size, taken[carrier.name]) if one.z <= _REACHED):
                near = any(math.dist(spot[:2], stand[:2]) <= REACH - 0.04 for stand in stands)
                cost = math.dist(spot[:3], piece.position) + (0.0 if near else 10.0)
                if best is None or cost < best[0]:
                    best = (cost, carrier, spot)
        if best is None and carriers:
            self.report.left_out.append(
                f"{piece.what}: there is no room for it within reach on {plain(carriers[0].name)}"
            )
            return None
        if best is None:
            return self._lay_down(piece, scene, things)
        carrier, spot = best[1], best[2]
        away = math.dist(spot[:3], piece.position)
        if away > _MOVED:
            self.report.guessed.append(
                f"{piece.what}: {away:.2f} m from where the house has it on {plain(carrier.name)}"
            )
        taken[carrier.name].append(taken_at(spot, piece.kind.size))
        room = scene.room(carrier.room) or scene.rooms[0]
        named = _object(piece, room, 0, self._name(piece.kind.cls))
        return named.model_copy(update={"position": spot[:3], "yaw": spot.yaw, "on": carrier.name})

    def _lay_down(self, piece: _Piece, scene: Scene, things: Sequence[SceneObject]) -> SceneObject | None:
        """Put a thing on the floor, where the house has it or as near as there is room."""
        room = scene.room_at(*piece.position[:2])
        thing = _object(piece, room, 0, self._name(piece.kind.cls))
        filled = [taken_by(other) for other in [*scene.fixed, *things] if other.size[2] > FLAT]
        for x, y in _around(thing.xy):
            moved = thing.model_copy(update={"position": (x, y, 0.0)})
            space = taken_by(moved)
            if room.encloses(space.bounds.grown(_OFF_WALL)) and not any(
                space.low < other.high - 0.01 and other.low < space.high and space.bounds.overlaps(other.bounds)
                for other in filled
            ):
                return moved
        self.report.left_out.append(f"{piece.what}: there is no room for it on the floor")
        return None


def _placed(what: str, item: Item, kind: Kind) -> _Piece:
    x, y = item.position.plan
    base = round(max(item.position.y - kind.size[2] / 2, 0.0), 4)
    yaw = round(math.remainder(-math.radians(item.rotation.y), math.tau), 4)
    return _Piece(what, item, kind, (x, y, base), yaw)


def _runs(piece: _Piece, scene: Scene) -> list[_Piece]:
    """A counter around a corner as its straight runs: one along its back, one at the side nearer to a wall, or both."""
    wide, deep, high = piece.kind.size
    around = piece.item.asset.split("_")[1:2]
    if piece.kind.cls != "kitchen_counter" or around not in (["L"], ["C"]) or min(wide, deep) < _RUN + 0.3:
        return [piece]
    cos, sin = math.cos(piece.yaw), math.sin(piece.yaw)
    x0, y0, z = piece.position
    room = scene.room_at(x0, y0)

    def run(x: float, y: float, size: Size, turn: float) -> _Piece:
        place = (round(x0 + x * cos - y * sin, 4), round(y0 + x * sin + y * cos, 4), z)
        return piece._replace(kind=piece.kind._replace(size=size), position=place, yaw=piece.yaw + turn)

    back = run(0.0, (_RUN - deep) / 2, (wide, _RUN, high), 0.0)
    arms = [run(s * (wide - _RUN) / 2, _RUN / 2, (deep - _RUN, _RUN, high), s * math.pi / 2) for s in (-1.0, 1.0)]
    if around == ["C"]:
        return [back, *arms]

    def to_wall(arm: _Piece) -> float:
        return min(edge.wall.distance(*arm.position[:2]) for edge in room.edges)

    return [back, min(arms, key=lambda arm: round(to_wall(arm), 2))]


def _object(piece: _Piece, room: Room, id: int, name: str) -> SceneObject:
    kind = piece.kind
    known = catalogue().fixed.get(kind.cls) or catalogue().movable.get(kind.cls)
    colours = known.colours if known else PLAIN
    return SceneObject(
        id=id,
        name=name,
        cls=kind.cls,
        category=kind.category,
        fixed=kind.fixed,
        room=room.name,
        position=piece.position,
        yaw=piece.yaw,
        size=kind.size,
        colour=colours[sum(map(ord, piece.item.asset)) % len(colours)],
    )


def _numbered(thing: SceneObject, id: int) -> SceneObject:
    return thing.model_copy(update={"id": id})


def _below(scene: Scene, position: tuple[float, float, float]) -> list[SceneObject]:
    """The furniture over which a thing is, that with the nearest top first."""
    over = [thing for thing in scene.fixed if thing.bounds.distance(*position[:2]) <= 0.0 and thing.size[2] > FLAT]
    return sorted(over, key=lambda thing: (abs(thing.top - position[2]), thing.id))[:1]


def _around(place: Point) -> list[Point]:
    """A place, and places on a raster around it, the nearest first."""
    return [(round(place[0] + dx, 4), round(place[1] + dy, 4)) for dx, dy in _steps()]


@lru_cache
def _steps() -> list[Point]:
    """The way to each place of the raster, the shortest first."""
    ticks = np.arange(-_FARTHEST, _FARTHEST + _STEP / 2, _STEP)
    dx, dy = (axis.ravel() for axis in np.meshgrid(ticks, ticks, indexing="ij"))
    away = np.round(np.hypot(dx, dy), 6)
    order = np.lexsort((dy, dx, away))[: int((away <= _FARTHEST).sum())]
    return list(zip(dx[order].tolist(), dy[order].tolist(), strict=True))


def _clear(places: Array, half: Bounds, spaces: Iterable[Bounds]) -> NDArray[np.bool_]:
    """At which places, shape (n, 2), what takes `half` around it overlaps none of the rectangles; shape (n,)."""
    x, y = places.T
    clear = np.ones(len(places), dtype=bool)
    for one in spaces:
        clear &= (x + half.x0 >= one.x1) | (one.x0 >= x + half.x1) | (y + half.y0 >= one.y1) | (one.y0 >= y + half.y1)
    return clear


def _cells(bounds: Bounds) -> Iterator[tuple[int, int]]:
    """The cells of a raster on the floor that a rectangle touches."""
    x0, y0, x1, y1 = (math.floor(value / _CELL) for value in bounds)
    return product(range(x0, x1 + 1), range(y0, y1 + 1))
