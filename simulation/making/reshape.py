"""Rooms that are no rectangles: corners of a layout's rooms are given to their neighbours, cut out, or cut off."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
import shapely

from coopera.core.household import SceneId
from coopera.simulation.homes.floorplan import Bounds, Point
from coopera.simulation.homes.scene import Room, Scene

BITE, DEEP = (1.3, 2.6), (0.8, 1.8)
"""Between these, in metres, is how long and how deep a corner is that goes to the room next door."""
CUT = (0.8, 1.5)
"""Between these is how far a corner of the home is cut off, along each wall."""
_NARROWEST = 1.7
_LEAST_AREA = 5.0
_MOST_TRIES = 60
_GRID = 0.01
"""Corners lie on a grid of this, in metres, so that neighbours meet."""


def reshaped(
    rooms: Sequence[Room], rng: np.random.Generator, *, bites: int, notch: bool = False, slants: int = 0
) -> list[Room]:
    """The rooms with some corners moved; fewer are where no more fit.

    Args:
        rooms: Rectangles that share walls.
        rng: What it is drawn from.
        bites: How many rooms give a corner to a room next door: both then have six corners or more.
        notch: Whether a corner of the home is cut out, so that the home itself is no rectangle.
        slants: How many corners of the home are cut off aslant.
    """
    shapes = {room.name: shapely.box(*room.bounds) for room in rooms}
    outer = Scene(id=SceneId("draft"), rooms=list(rooms)).bounds
    corners = [(x, y) for x in (outer.x0, outer.x1) for y in (outer.y0, outer.y1)]
    order = [corners[int(i)] for i in rng.permutation(4)]
    if notch:
        _at_a_corner(shapes, order, lambda at: _square(at, outer, rng))
    for _ in range(slants):
        _at_a_corner(shapes, order, lambda at: _triangle(at, outer, rng))
    for _ in range(bites):
        for _ in range(_MOST_TRIES):
            if _bite(shapes, rng):
                break
    return [_room(room, shapes[room.name]) for room in rooms]


def _room(room: Room, shape: shapely.Polygon) -> Room:
    if shape.equals(shapely.box(*room.bounds)):
        return room
    corners = [(round(x, 2), round(y, 2)) for x, y in shape.exterior.coords[:-1]]
    return Room.model_validate({"name": room.name, "kind": room.kind, "polygon": corners})


def _at_a_corner(
    shapes: dict[str, shapely.Polygon], corners: list[Point], cut: Callable[[Point], shapely.Polygon]
) -> None:
    """Take a piece out of the room in the first corner of the home whose room stays a good one."""
    for at in list(corners):
        piece = cut(at)
        name = next((name for name, shape in shapes.items() if shape.intersection(piece).area > 1e-6), "")
        if name and shapes[name].covers(piece):
            left = shapes[name].difference(piece, grid_size=_GRID)
            if _good(left):
                shapes[name] = left
                corners.remove(at)
                return


def _square(at: Point, outer: Bounds, rng: np.random.Generator) -> shapely.Polygon:
    wide, deep = (round(float(rng.uniform(*BITE)), 1) for _ in range(2))
    x1, y1 = _inwards(at, outer, wide, deep)
    return shapely.box(min(at[0], x1), min(at[1], y1), max(at[0], x1), max(at[1], y1))


def _triangle(at: Point, outer: Bounds, rng: np.random.Generator) -> shapely.Polygon:
    wide, deep = (round(float(rng.uniform(*CUT)), 1) for _ in range(2))
    x1, y1 = _inwards(at, outer, wide, deep)
    return shapely.Polygon([at, (x1, at[1]), (at[0], y1)])


def _inwards(at: Point, outer: Bounds, wide: float, deep: float) -> Point:
    x, y = outer.middle
    return round(at[0] + (wide if at[0] < x else -wide), 2), round(at[1] + (deep if at[1] < y else -deep), 2)


def _bite(shapes: dict[str, shapely.Polygon], rng: np.random.Generator) -> bool:
    """Give a corner of one room to the room next door, if both stay good ones."""
    names = sorted(shapes)
    giver, taker = (names[int(i)] for i in rng.choice(len(names), 2, replace=False))
    shared = shapes[giver].intersection(shapes[taker])
    long, deep = (round(float(rng.uniform(*span)), 1) for span in (BITE, DEEP))
    pieces = list(_pieces(shared, long, deep))
    if not pieces:
        return False
    piece = pieces[int(rng.integers(len(pieces)))]
    if not shapes[giver].covers(piece):
        return False
    left = shapes[giver].difference(piece, grid_size=_GRID)
    grown = shapes[taker].union(piece, grid_size=_GRID)
    if not (_good(left) and _good(grown)) or left.area < 0.6 * shapes[giver].area:
        return False
    shapes[giver], shapes[taker] = left, grown
    return True


def _pieces(shared: shapely.Geometry, long: float, deep: float) -> Iterator[shapely.Polygon]:
    """Rectangles at the ends of a shared wall, on either side of it."""
    if shared.geom_type not in ("LineString", "MultiLineString") or shared.length < long + 1.5:
        return
    x0, y0, x1, y1 = (round(side, 2) for side in shared.bounds)
    if x1 - x0 < 0.01:
        for low in (y0, round(y1 - long, 2)):
            for side in (-deep, deep):
                yield shapely.box(min(x0, x0 + side), low, max(x0, x0 + side), low + long)
    elif y1 - y0 < 0.01:
        for low in (x0, round(x1 - long, 2)):
            for side in (-deep, deep):
                yield shapely.box(low, min(y0, y0 + side), low + long, max(y0, y0 + side))


def _good(shape: shapely.Geometry) -> bool:
    """Whether a shape is one simple polygon, large enough and nowhere too narrow for a person and furniture."""
    if shape.geom_type != "Polygon" or shape.interiors or shape.area < _LEAST_AREA:
        return False
    half = _NARROWEST / 2
    with np.errstate(all="ignore"):  # GEOS divides by 0 where two sides nearly run along each other
        inner = shape.buffer(-half, join_style="mitre")
        grown = inner.buffer(half + 0.02, join_style="mitre")
        return inner.geom_type == "Polygon" and bool(grown.covers(shape.buffer(-0.6)))
