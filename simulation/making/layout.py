"""Lay out the rooms of a generated home: a rectangle cut again and again until each room has its share, and doors."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from itertools import combinations, product
from typing import Literal, NamedTuple

import numpy as np

from coopera.core.errors import SimulationError
from coopera.core.household import SceneId
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.floorplan import TOUCH, Bounds, Edge
from coopera.simulation.homes.scene import DOOR_WIDTH, Doorway, Room, Scene

USUAL_ROOMS = (
    "living room",
    "kitchen",
    "bedroom",
    "bathroom",
    "hallway",
    "study",
    "hobby room",
    "bedroom",
    "dining room",
    "laundry room",
    "garage",
    "sunroom",
)
_LAYOUTS = 400
_MOST_LAYOUTS = 4000
_NARROWEST = 1.5
_UNREACHABLE = 1000.0
_SHARED = 1.4
"""Rooms that share at least this much wall may have a door between them, in metres."""


class Layout(NamedTuple):
    """Rooms and the doors between them; every room can be reached."""

    rooms: list[Room]
    doors: list[Doorway]


class Form(NamedTuple):
    """What makes homes of the same rooms different: see `lay_out` and `reshape.reshaped`."""

    size: float = 1.0
    """How large rooms are beside the usual."""
    long: float = 1.35
    """How wide the home is beside its depth."""
    bites: int = 0
    notch: bool = False
    slants: int = 0
    style: str = ""
    """What is done to the colours of furniture."""


_USUAL = Form()


class _Edge(NamedTuple):
    first: int
    second: int
    axis: Literal["x", "y"]
    at: float
    start: float
    end: float


def room_names(kinds: Sequence[str]) -> list[str]:
    """Names for rooms of these kinds; a second bedroom is "bedroom 2"."""
    seen: Counter[str] = Counter()
    names = []
    for kind in kinds:
        seen[kind] += 1
        names.append(kind if seen[kind] == 1 else f"{kind} {seen[kind]}")
    return names


def lay_out(kinds: Sequence[str], rng: np.random.Generator, form: Form = _USUAL) -> Layout:
    """Return the best of several hundred random layouts: well-proportioned rooms with doors where one wants them.

    Raises:
        SimulationError: If every layout tried has a room that is too narrow or cannot be reached.
    """
    names = room_names(kinds)
    areas = [catalogue().rooms[kind].area * form.size for kind in kinds]
    width = math.sqrt(sum(areas) * form.long)
    whole = Bounds(0.0, 0.0, round(width, 1), round(sum(areas) / width, 1))
    best: tuple[float, list[Room], list[_Edge]] | None = None
    for attempt in range(_MOST_LAYOUTS):
        if attempt >= _LAYOUTS and best is not None and best[0] < _UNREACHABLE:
            break
        cells: dict[int, Bounds] = {}
        _split(whole, [int(i) for i in rng.permutation(len(kinds))], areas, rng, cells)
        if min(min(cell.x1 - cell.x0, cell.y1 - cell.y0) for cell in cells.values()) < _NARROWEST:
            continue
        rooms = [Room(name=names[i], kind=kinds[i], **cells[i]._asdict()) for i in range(len(kinds))]
        edges = _edges(rooms)
        score = _score(rooms, edges)
        if best is None or score < best[0]:
            best = (score, rooms, edges)
    if best is None or best[0] >= _UNREACHABLE:
        raise SimulationError(f"No layout of {len(kinds)} rooms was found in {_MOST_LAYOUTS} tries; use another seed.")
    _, rooms, edges = best
    if form.bites or form.notch or form.slants:
        from coopera.simulation.making.reshape import reshaped  # noqa: PLC0415 - most homes are rectangles

        rooms = reshaped(rooms, rng, bites=form.bites, notch=form.notch, slants=form.slants)
        edges = _edges(rooms)
        if len(_tree(rooms, edges)) < len(rooms) - 1:
            raise SimulationError(f"A layout of {len(kinds)} rooms lost a way to a room; use another seed.")
    return Layout(rooms, _doors(rooms, edges, rng))


def _split(
    whole: Bounds, order: list[int], areas: Sequence[float], rng: np.random.Generator, cells: dict[int, Bounds]
) -> None:
    if len(order) == 1:
        cells[order[0]] = whole
        return
    cut = int(rng.integers(1, len(order)))
    left, right = order[:cut], order[cut:]
    share = sum(areas[i] for i in left) / sum(areas[i] for i in order)
    wide, deep = whole.x1 - whole.x0, whole.y1 - whole.y0
    across = wide >= deep if rng.random() < 0.8 else wide < deep
    if across:
        middle = round(whole.x0 + wide * share, 1)
        parts = whole._replace(x1=middle), whole._replace(x0=middle)
    else:
        middle = round(whole.y0 + deep * share, 1)
        parts = whole._replace(y1=middle), whole._replace(y0=middle)
    _split(parts[0], left, areas, rng, cells)
    _split(parts[1], right, areas, rng, cells)


def _edges(rooms: Sequence[Room]) -> list[_Edge]:
    edges: list[_Edge] = []
    sides = [_from_high_y(room) for room in rooms]
    for i, j in combinations(range(len(rooms)), 2):
        for (wall, inward, _), (other, outward, _) in product(sides[i], sides[j]):
            if wall.axis == other.axis and abs(wall.at - other.at) < TOUCH and sum(inward) == -sum(outward):
                start, end = max(wall.start, other.start), min(wall.end, other.end)
                if end - start >= _SHARED:
                    edges.append(_Edge(i, j, wall.axis, wall.at, start, end))
    return edges


def _from_high_y(room: Room) -> list[Edge]:
    """The straight sides of a room, those along y first, and of those with one axis the highest."""
    straight = (edge for edge in room.edges if not edge.wall.rise)
    return sorted(straight, key=lambda edge: (edge.wall.axis == "x", -edge.wall.at, edge.wall.start))


def _score(rooms: Sequence[Room], edges: Sequence[_Edge]) -> float:
    """Lower is better: long thin rooms, unwanted doors and windowless rooms cost, unreachable rooms most."""
    cost = 0.0
    for room in rooms:
        wide, deep = sorted((room.x1 - room.x0, room.y1 - room.y0))
        allowed = 2.4 if room.kind == "hallway" else 1.5
        cost += 6 * max(0.0, deep / wide - allowed) + 10 * max(0.0, (1.9 if room.kind == "hallway" else 2.4) - wide)
    tree = _tree(rooms, edges)
    cost += _UNREACHABLE * (len(rooms) - 1 - len(tree)) + sum(_dislike(rooms, edge) for edge in tree)
    outer = Scene(id=SceneId("draft"), rooms=list(rooms)).bounds
    for room in rooms:  # a window needs an outer wall
        inner = room.x0 > outer.x0 and room.y0 > outer.y0 and room.x1 < outer.x1 and room.y1 < outer.y1
        cost += 4.0 * (inner and room.kind not in ("hallway", "bathroom"))
    return cost


def _dislike(rooms: Sequence[Room], edge: _Edge) -> float:
    """How little one wants a door between two rooms."""
    kinds = {rooms[edge.first].kind, rooms[edge.second].kind}
    if "hallway" in kinds:
        return 0.0
    if kinds == {"kitchen", "dining room"} or kinds == {"living room", "dining room"}:
        return 0.5
    if "living room" in kinds:
        return 2.0 if "bathroom" in kinds else 1.0
    return 5.0 if "bathroom" in kinds and "bedroom" not in kinds else 3.0


def _tree(rooms: Sequence[Room], edges: Sequence[_Edge]) -> list[_Edge]:
    group = list(range(len(rooms)))
    chosen = []
    for edge in sorted(edges, key=lambda e: (_dislike(rooms, e), -(e.end - e.start), e.first, e.second)):
        a, b = group[edge.first], group[edge.second]
        if a != b:
            group = [a if g == b else g for g in group]
            chosen.append(edge)
    return chosen


def _doors(rooms: Sequence[Room], edges: Sequence[_Edge], rng: np.random.Generator) -> list[Doorway]:
    chosen = _tree(rooms, edges)
    more = [edge for edge in edges if edge not in chosen and _dislike(rooms, edge) <= 1.0]
    doors = []
    for edge in [*chosen, *more[:2]]:
        low, high = edge.start + DOOR_WIDTH / 2 + 0.15, edge.end - DOOR_WIDTH / 2 - 0.15
        along = round(float(rng.choice([low, high, (low + high) / 2])), 2)
        x, y = (along, edge.at) if edge.axis == "x" else (edge.at, along)
        doors.append(Doorway(between=(rooms[edge.first].name, rooms[edge.second].name), x=x, y=y))
    return doors
