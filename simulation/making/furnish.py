"""Furnish one room of a generated home, so that everything in it can be walked up to.

Each piece is tried at many places, the best-looking first. A place is good if the free floor stays connected, leads to
every door, and leaves room to stand in front of every piece so far.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.ndimage import label

from coopera.simulation.homes.catalogue import FLAT, FixedClass, catalogue
from coopera.simulation.homes.floorplan import Bounds, Edge
from coopera.simulation.homes.scene import Doorway, Room
from coopera.simulation.homes.spots import Taken, is_free
from coopera.simulation.shapes.kit import Size
from coopera.simulation.ways.navigation import CELL, RADIUS, Array, Mask, clearance

_INSET = 0.06
"""From a room's edge to the back of furniture: half a wall, and a hair."""
_NEXT = 0.02
_ACCESS = 0.45
"""A place to stand lies at most this far from a piece."""
_ACCESS_ON_TOP = 0.65
_SPARE = 0.03
"""Ways are kept this much wider than a body, since the whole home is later seen through another grid."""
_TRIES = 40
FACING = {(0.0, 1.0): 0.0, (0.0, -1.0): math.pi, (1.0, 0.0): -math.pi / 2, (-1.0, 0.0): math.pi / 2}
"""The yaw of furniture with its back to a wall, by the vector from the wall into the room; none stands aslant."""
_ALONG = (0.2, 0.5, 0.8)
_MIDDLE = ("sofa", "bed", "fireplace", "tv_stand", "curtain", "piano", "desk", "workbench")
_RUN = ("kitchen_counter", "kitchen_sink", "stove", "fridge", "dishwasher", "kitchen_cabinet")


@dataclass(frozen=True, slots=True)
class Piece:
    """A placed piece of furniture, not yet named."""

    cls: str
    x: float
    y: float
    z: float
    yaw: float
    size: Size

    @property
    def bounds(self) -> Bounds:
        """The rectangle on the floor; pieces stand at right angles."""
        turned = abs(math.sin(self.yaw)) > 0.5
        half_x, half_y = (self.size[1] / 2, self.size[0] / 2) if turned else (self.size[0] / 2, self.size[1] / 2)
        return Bounds(self.x - half_x, self.y - half_y, self.x + half_x, self.y + half_y)

    @property
    def front(self) -> tuple[float, float]:
        """Unit vector of the front."""
        return round(-math.sin(self.yaw)), round(math.cos(self.yaw))


@dataclass(slots=True)
class RoomPlan:
    """A room being furnished: its floor grid, the space that doors need, and the pieces so far."""

    room: Room
    doors: Sequence[Doorway]
    others: Sequence[Room]
    """The other rooms of the home: where none is beyond a wall, it is an outer one."""
    rng: np.random.Generator
    pieces: list[Piece] = field(default_factory=list)
    x: Array = field(init=False)
    y: Array = field(init=False)
    clear: Array = field(init=False)
    door_space: list[Bounds] = field(init=False)
    door_cells: list[tuple[int, int]] = field(init=False)

    def __post_init__(self) -> None:
        """Build the empty floor."""
        r = self.room
        xs, ys = np.arange(r.x0, r.x1 + CELL / 2, CELL), np.arange(r.y0, r.y1 + CELL / 2, CELL)
        self.x, self.y = np.meshgrid(xs, ys, indexing="ij")
        self.clear = r.depth(self.x, self.y) - 0.05
        self.door_space, self.door_cells = [], []
        for door in self.doors:
            half = door.width / 2 + 0.05
            wall, inward, _ = min(r.edges, key=lambda edge: edge.wall.distance(door.x, door.y))
            wide, deep = (half, 0.75) if wall.axis == "x" else (0.75, half)
            self.door_space.append(Bounds(door.x - wide, door.y - deep, door.x + wide, door.y + deep))
            x, y = door.x + 0.4 * inward[0], door.y + 0.4 * inward[1]
            self.door_cells.append((round((x - r.x0) / CELL), round((y - r.y0) / CELL)))

    def add(self, cls: str) -> bool:
        """Place one more piece of a class; False where it does not fit."""
        kind = catalogue().fixed[cls]
        size = self._size(kind)
        if kind.stands.startswith("on:"):
            return self._add_on_top(cls, size, kind.stands.partition(":")[2])
        candidates = sorted(self._candidates(cls, kind, size), key=lambda pair: pair[0])
        tried = 0
        for _, piece in candidates:
            if not self._fits(piece):
                continue
            if piece.size[2] <= FLAT:
                self.pieces.append(piece)
                return True
            tried += 1
            if self._keeps_access(piece):
                return True
            if tried == _TRIES:
                break
        return False

    def _size(self, kind: FixedClass) -> Size:
        w, d, h = kind.size
        vary = self.rng.uniform(0.96, 1.04, 2)
        return round(w * float(vary[0]), 2), round(d * float(vary[1]), 2) if d > 0.2 else d, h

    def _candidates(self, cls: str, kind: FixedClass, size: Size) -> Iterator[tuple[float, Piece]]:
        relation, _, other = kind.stands.partition(":")
        anchors = [piece for piece in self.pieces if piece.cls == other]
        if relation in ("beside", "around", "front", "opposite") and anchors:
            yield from self._related(cls, size, relation, anchors)
            if relation in ("around", "front"):
                return
        if relation in ("centre", "floor"):
            yield from self._inside(cls, size, flat=relation == "floor")
        elif relation != "around" or cls == "office_chair":
            yield from self._along_walls(cls, size, outer=relation == "outer")

    def _related(self, cls: str, size: Size, relation: str, anchors: Sequence[Piece]) -> Iterator[tuple[float, Piece]]:
        """Places told by another piece: at its sides, in front of it, around it, or across the room."""
        for anchor in anchors:
            w, d, _ = anchor.size
            if relation == "opposite":
                yield from self._opposite(cls, size, anchor)
            elif relation == "beside":
                for side in (-1, 1):
                    x, y = side * (w / 2 + size[0] / 2 + _NEXT), -d / 2 + size[1] / 2
                    yield self._rank(0.2), self._from(anchor, cls, size, x, y, 0.0)
            elif relation == "front":
                for gap in (0.68, 0.75, 0.85):
                    yield gap, self._from(anchor, cls, size, 0.0, d / 2 + gap + size[1] / 2, 0.0)
            else:
                yield from self._around(cls, size, anchor)

    def _around(self, cls: str, size: Size, anchor: Piece) -> Iterator[tuple[float, Piece]]:
        w, d, _ = anchor.size
        off = d / 2 + size[1] / 2 + 0.03
        if anchor.cls == "desk":
            for x in (-0.2 * w, 0.0, 0.1 * w):
                yield abs(x), self._from(anchor, cls, size, x, off, math.pi)
            return
        for x in (-0.24 * w, 0.24 * w):
            yield self._rank(0.1), self._from(anchor, cls, size, x, off, math.pi)
            yield self._rank(0.1), self._from(anchor, cls, size, x, -off, 0.0)

    def _opposite(self, cls: str, size: Size, anchor: Piece) -> Iterator[tuple[float, Piece]]:
        for rank, piece in self._along_walls(cls, size):
            if piece.front == (-anchor.front[0], -anchor.front[1]):
                dx, dy = piece.x - anchor.x, piece.y - anchor.y
                yield abs(dx * anchor.front[1]) + abs(dy * anchor.front[0]) - 10 + 0.01 * rank, piece

    def _from(self, anchor: Piece, cls: str, size: Size, x: float, y: float, turn: float) -> Piece:
        cos, sin = math.cos(anchor.yaw), math.sin(anchor.yaw)
        wx, wy = anchor.x + x * cos - y * sin, anchor.y + x * sin + y * cos
        return _piece(cls, wx, wy, anchor.yaw + turn, size)

    def _inside(self, cls: str, size: Size, *, flat: bool) -> Iterator[tuple[float, Piece]]:
        cx, cy = self.room.centre
        tables = [piece for piece in self.pieces if piece.cls == "coffee_table"]
        if flat and tables:
            cx, cy = tables[0].x, tables[0].y
        for yaw in (0.0, math.pi / 2):
            for dx in np.arange(-1.4, 1.41, 0.2):
                for dy in np.arange(-1.4, 1.41, 0.2):
                    piece = _piece(cls, cx + float(dx), cy + float(dy), yaw, size)
                    under = sum(piece.bounds.overlaps(other.bounds) for other in self.pieces) if flat else 0
                    yield math.hypot(dx, dy) + 0.6 * under * (not tables) + self._rank(0.1), piece

    def _along_walls(self, cls: str, size: Size, *, outer: bool = False) -> Iterator[tuple[float, Piece]]:
        """Places with the back to a wall: flush with corners and neighbours, in the middle, and random ones."""
        for edge in self.room.edges:
            yaw = FACING.get(edge.inward)
            if yaw is None or (outer and not self._is_outer(edge)):
                continue
            wall, start, end = edge.wall.at, edge.wall.start, edge.wall.end
            low, high = start + _INSET + size[0] / 2, end - _INSET - size[0] / 2
            if low > high:
                continue
            along_x = abs(math.sin(yaw)) < 0.5
            flush = [low, high]
            for other in self.pieces:
                span = (other.bounds.x0, other.bounds.x1) if along_x else (other.bounds.y0, other.bounds.y1)
                flush += [span[0] - _NEXT - size[0] / 2, span[1] + _NEXT + size[0] / 2]
            middle = (low + high) / 2
            free = [middle, *(float(v) for v in self.rng.uniform(low, high, 10))]
            off = _INSET + size[1] / 2
            for along, is_flush in [*((v, True) for v in flush), *((v, False) for v in free)]:
                if not low - 1e-6 <= along <= high + 1e-6:
                    continue
                back = wall + off if yaw in (0.0, -math.pi / 2) else wall - off
                piece = _piece(cls, *((along, back) if along_x else (back, along)), yaw, size)
                yield self._wall_rank(piece, abs(along - middle), is_flush), piece

    def _is_outer(self, edge: Edge) -> bool:
        """Whether there is no other room behind a wall."""
        (x0, y0), (x1, y1) = edge.wall.ends
        places = [
            (x0 + (x1 - x0) * s - 0.1 * edge.inward[0], y0 + (y1 - y0) * s - 0.1 * edge.inward[1]) for s in _ALONG
        ]
        return not any(other.contains(*place) for other in self.others for place in places)

    def _wall_rank(self, piece: Piece, aside: float, is_flush: bool) -> float:
        if piece.cls in _MIDDLE:
            return aside + self._rank(1.0)
        rank = (0.0 if is_flush else 0.8) + self._rank(1.0)
        if piece.cls in _RUN:
            run = [other for other in self.pieces if other.cls in _RUN]
            beside = any(piece.bounds.overlaps(other.bounds, 0.05) for other in run)
            rank += 0.0 if not run or beside else 2.0
        return rank

    def _rank(self, spread: float) -> float:
        return float(self.rng.uniform(0, spread))

    def _fits(self, piece: Piece) -> bool:
        b = piece.bounds
        if not self.room.encloses(b.grown(0.05)):
            return False
        if piece.size[2] <= FLAT:
            return not any(b.overlaps(other.bounds) for other in self.pieces if other.size[2] <= FLAT)
        if any(b.overlaps(space) for space in self.door_space):
            return False
        return not any(b.overlaps(other.bounds, 0.01) for other in self.pieces if other.size[2] > FLAT)

    def _keeps_access(self, piece: Piece) -> bool:
        """Add a piece if everything stays reachable with it; else leave all as it was."""
        clear = np.minimum(self.clear, _distance(piece, self.x, self.y))
        parts, count = label(clear >= RADIUS + _SPARE)
        if not count:
            return False
        main = parts[self.door_cells[0]] if self.door_cells else int(np.bincount(parts.ravel())[1:].argmax()) + 1
        if not main or any(parts[cell] != main for cell in self.door_cells):
            return False
        floor: Mask = parts == main
        if not all(self._has_access(other, floor) for other in [*self.pieces, piece]):
            return False
        self.clear = clear
        self.pieces.append(piece)
        return True

    def _has_access(self, piece: Piece, floor: Mask) -> bool:
        if piece.size[2] <= FLAT or piece.z > 0:
            return True
        near = floor & (_distance(piece, self.x, self.y) <= _ACCESS)
        stands = catalogue().fixed[piece.cls].stands
        if stands != "centre" and not stands.startswith("around"):
            ahead = (self.x - piece.x) * piece.front[0] + (self.y - piece.y) * piece.front[1]
            near &= ahead > piece.size[1] / 2
        return bool(near.any())

    def _add_on_top(self, cls: str, size: Size, carrier_cls: str) -> bool:
        """Stand a piece on another one, towards its back; on one that carries little."""
        carriers = [piece for piece in self.pieces if piece.cls == carrier_cls]
        carriers = [carriers[int(index)] for index in self.rng.permutation(len(carriers))]
        carriers.sort(key=lambda carrier: sum(p.z > 0 and p.bounds.overlaps(carrier.bounds) for p in self.pieces))
        for carrier in carriers:
            spare = carrier.size[0] - size[0] - 0.04
            if spare < 0:
                continue
            y = 0.0 if carrier.size[1] < size[1] + 0.24 else (carrier.size[1] - size[1]) / 2 - 0.14
            for x in self.rng.permutation([-spare / 2, spare / 2, 0.0]):
                flat = self._from(carrier, cls, size, float(x), y, 0.0)
                piece = Piece(cls, flat.x, flat.y, carrier.size[2], flat.yaw, size)
                others = [Taken(p.bounds, p.z, p.z + p.size[2]) for p in self.pieces if p is not carrier]
                if is_free(Taken(piece.bounds, piece.z, piece.z + size[2]), others) and self._can_stand_by(piece):
                    self.pieces.append(piece)
                    return True
        return False

    def _can_stand_by(self, piece: Piece) -> bool:
        near = (self.clear >= RADIUS) & (_distance(piece, self.x, self.y) <= _ACCESS_ON_TOP)
        ahead = (self.x - piece.x) * piece.front[0] + (self.y - piece.y) * piece.front[1]
        return bool((near & (ahead > 0)).any())


def _distance(piece: Piece, x: Array, y: Array) -> Array:
    return clearance(x, y, np.array([[piece.x, piece.y, piece.size[0] / 2, piece.size[1] / 2, piece.yaw]]))


def _piece(cls: str, x: float, y: float, yaw: float, size: Size) -> Piece:
    return Piece(cls, round(x, 3), round(y, 3), 0.0, round(math.remainder(yaw, math.tau), 4), size)
