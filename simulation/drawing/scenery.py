"""All triangles of a home in the world's frame: what stands fast, made once, and what moves, set again when it does.

Every triangle carries a tag: the number of the body that it is of, and that of its class (`Scenery.classes`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing import house
from coopera.simulation.drawing.files import read_solid
from coopera.simulation.drawing.geometry import Floats, Mesh, merged, of_part, painted
from coopera.simulation.drawing.materials import METRES, Material, of_thing
from coopera.simulation.homes.catalogue import parts_of
from coopera.simulation.homes.meshes import part_file
from coopera.simulation.homes.scene import Scene, SceneObject, rgb_of
from coopera.simulation.shapes.kit import Colour, Part, Size
from coopera.simulation.shapes.rotations import Array, about_z

VERTEX = np.dtype([("at", "<f4", 3), ("normal", "i1", 4), ("paint", "u1", 4), ("uv", "<f4", 2), ("tag", "<i4")])
"""One corner as the graphics card reads it: 32 bytes. `paint` is colour and material, `tag` what it is of."""
BODY_BITS = 20
"""A tag's low bits are the body's number plus 1, its high bits that of the class."""
OUTSIDE = -1
_BELOW, _SEEN = 50.0, -1.0
_FLAT, _UPWARDS = 0.02, 100
"""Metres above the floor, as in scene.frag, and how much of 127 a normal points upwards."""
_METRES = np.array(METRES, dtype=np.float32)


class Piece(NamedTuple):
    """A stretch of triangles that is drawn, or left out, as one."""

    first: int
    length: int
    """Of indices into `faces`."""
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    room: int
    above: bool
    """Whether it is left out for a camera above the walls."""
    casts: bool
    """Whether it casts a shadow."""
    closed: bool
    """Whether it is drawn from without only, as our own shapes are; what comes from files may be inside out."""
    lies: bool
    """Whether it has a top so near the floor that furniture keeps light from it, as from a rug."""


@dataclass(slots=True)
class Batch:
    """Vertices and faces in one piece of memory each, which may have room for more, with what they are made of."""

    vertices: NDArray[np.void]
    faces: NDArray[np.uint32]
    pieces: list[Piece]
    changed: list[tuple[slice, slice]]
    """Which vertices and which faces are others than in the same memory before."""


@dataclass(slots=True)
class _Slot:
    """A thing that moves: its triangles in its own frame, and where they lie among all."""

    mesh: Mesh
    vertices: NDArray[np.void]
    """Once there is a batch, the part of it that is this thing's."""
    closed: bool
    start: int = 0
    """Its first vertex in the batch."""
    first: int = 0
    """Its first triangle there."""
    placed: tuple[float, ...] = ()
    low: Floats = field(default_factory=lambda: np.zeros(3, dtype=np.float32))
    high: Floats = field(default_factory=lambda: np.zeros(3, dtype=np.float32))
    room: int = OUTSIDE
    lies: bool = False

    def corners(self) -> slice:
        """Which vertices of the batch are its own."""
        return slice(self.start, self.start + len(self.vertices))

    def triangles(self) -> slice:
        """Which faces of the batch are its own."""
        return slice(self.first, self.first + len(self.mesh.faces))


class Scenery:
    """What there is to draw of a home."""

    def __init__(self, scene: Scene, bodies: Mapping[str, int]) -> None:
        """Make the triangles of a home; `bodies` has the number of each room and of each piece of furniture."""
        self.scene = scene
        self.classes: list[str] = ["nothing"]
        self.stirred: list[tuple[Floats, Floats]] | None = None
        """Boxes in which something has come, gone or moved since `moving` was last asked for; None for everywhere."""
        self._slots: dict[str, _Slot] = {}
        self._whole: Batch | None = None
        self._taken = (0, 0)
        """How many vertices and faces of the batch things have, or had."""
        self._stale: dict[str, bool] = {}
        """What has changed since `moving` was last asked for, and whether it has come since then."""
        self.windows = house.windows(scene)
        self.sun = house.sunlight(scene)
        self.fixed = self._fixed(bodies)

    def _fixed(self, bodies: Mapping[str, int]) -> Batch:
        scene, walls = self.scene, self.scene.walls()
        packs: list[tuple[NDArray[np.void], NDArray[np.uint32], int, bool, bool]] = []
        for number, room in enumerate(scene.rooms):
            made = house.shell(scene, room, walls if scene.stage is None else [])
            for above, pairs in ((False, made.low), (True, made.above)):
                for cls in sorted({cls for cls, _ in pairs}):
                    mesh = merged([mesh for name, mesh in pairs if name == cls])
                    tag = self._tag(bodies.get(room.name, -1), cls)
                    packs.append((packed(mesh, tag), mesh.faces, number, above, False))
        if scene.stage is not None:
            mesh = house.loose_walls(walls)
            packs.append((packed(mesh, self._tag(-1, "wall")), mesh.faces, OUTSIDE, False, False))
        numbers = {room.name: number for number, room in enumerate(scene.rooms)}
        for thing in scene.fixed:
            mesh = thing_mesh(scene, thing).moved(thing.position, about_z(thing.yaw))
            room_number = numbers[thing.room]
            vertices = packed(mesh, self._tag(bodies.get(thing.name, -1), thing.cls))
            opaque = not (mesh.material == Material.WINDOW).any()  # daylight comes past the curtains of a window
            packs.append((vertices, mesh.faces, room_number, False, opaque))
        corners: list[NDArray[np.void]] = []
        faces: list[NDArray[np.uint32]] = []
        pieces: list[Piece] = []
        start, first = 0, 0
        for corner, face, room_number, above, casts in packs:
            if not len(face):
                continue
            low, high = corner["at"].min(axis=0).tolist(), corner["at"].max(axis=0).tolist()
            how = above, casts, scene.meshes is None, _lies(corner)
            pieces.append(Piece(first, face.size, tuple(low), tuple(high), room_number, *how))
            corners.append(corner)
            faces.append(face + np.uint32(start))
            start, first = start + len(corner), first + face.size
        return Batch(np.concatenate(corners), np.concatenate(faces).astype(np.uint32), pieces, [])

    def _tag(self, body: int, cls: str) -> int:
        if cls not in self.classes:
            self.classes.append(cls)
        return (self.classes.index(cls) << BODY_BITS) + body + 1

    def room_at(self, x: float, y: float) -> int:
        """Number of the room that holds a point; `OUTSIDE` for none."""
        return next((number for number, room in enumerate(self.scene.rooms) if room.contains(x, y)), OUTSIDE)

    def add(self, name: str, mesh: Mesh, body: int, cls: str, *, closed: bool = True) -> None:
        """Have one more thing that moves, out of sight until it is put somewhere; for `closed` see `Piece`."""
        self._slots[name] = slot = _Slot(mesh, packed(mesh, self._tag(body, cls)), closed)
        slot.vertices["at"][:, 2] -= _BELOW
        slot.low = slot.high = np.full(3, -_BELOW, dtype=np.float32)
        self._stale[name] = True
        self._take_in(slot)

    def remove(self, name: str) -> None:
        """Have a thing that moves no longer."""
        slot = self._slots.pop(name, None)
        if slot is not None:
            self._stir(slot)
            self._stale.pop(name, None)

    def __contains__(self, name: object) -> bool:
        return name in self._slots

    def put(self, name: str, place: Sequence[float], turn: Array) -> None:
        """Set where a moving thing is: the place of its frame, and its turn as a matrix."""
        slot = self._slots[name]
        placed = (*map(float, place), *turn.ravel().tolist())
        if placed != slot.placed:
            self.shape(name, *slot.mesh.moved(place, turn)[:2])
            slot.placed = placed

    def shape(self, name: str, at: Floats, normal: Floats) -> None:
        """Set the places of all corners of a moving thing, and their normals, in the world."""
        slot = self._slots[name]
        slot.placed, here = (), slot.vertices
        self._stir(slot)
        here["at"], here["normal"][:, :3] = at, np.round(normal * 127)
        if len(at):
            slot.low, slot.high = at.min(axis=0), at.max(axis=0)
        slot.lies = bool(slot.low[2] < _FLAT) and _lies(here)
        self._stale.setdefault(name, False)
        middle = (slot.low + slot.high) / 2
        slot.room = self.room_at(float(middle[0]), float(middle[1]))
        self._stir(slot)

    def _stir(self, slot: _Slot) -> None:
        if self.stirred is not None and slot.high[2] > _SEEN:
            self.stirred.append((slot.low, slot.high))

    def moving(self) -> Batch:
        """All that moves, as it now is; what is deep below the floor is left out."""
        batch = self._whole or self._laid_out()
        stale = [(self._slots[name], came) for name, came in self._stale.items()]
        batch.changed = [(slot.corners(), slot.triangles() if came else slice(0, 0)) for slot, came in stale]
        self.stirred, self._stale = [], {}
        batch.pieces = [
            Piece(
                3 * slot.first,
                slot.mesh.faces.size,
                tuple(slot.low),
                tuple(slot.high),
                slot.room,
                above=False,
                casts=True,
                closed=slot.closed,
                lies=slot.lies,
            )
            for slot in self._slots.values()
            if slot.mesh.faces.size and slot.high[2] > _SEEN
        ]
        return batch

    def _laid_out(self) -> Batch:
        """Memory for all that moves, and for half as much again that may come."""
        slots = list(self._slots.values())
        vertices = sum(len(slot.vertices) for slot in slots)
        faces = sum(len(slot.mesh.faces) for slot in slots)
        made = Batch(np.zeros(vertices * 3 // 2, VERTEX), np.zeros((faces * 3 // 2, 3), np.uint32), [], [])
        self._whole, self._taken = made, (0, 0)
        for slot in slots:
            self._take_in(slot)
        return made

    def _take_in(self, slot: _Slot) -> None:
        """Give a thing its part of the memory, where there is some; if there is too little, it is all laid out anew."""
        whole, (start, first) = self._whole, self._taken
        if whole is None:
            return
        end, last = start + len(slot.vertices), first + len(slot.mesh.faces)
        if end > len(whole.vertices) or last > len(whole.faces):
            self._whole = None
            return
        whole.vertices[start:end] = slot.vertices
        whole.faces[first:last] = slot.mesh.faces + np.uint32(start)
        slot.vertices, slot.start, slot.first = whole.vertices[start:end], start, first
        self._taken = end, last


def packed(mesh: Mesh, tag: int) -> NDArray[np.void]:
    """A mesh as the graphics card reads it: shape (n,) of `VERTEX`."""
    found = np.zeros(len(mesh.at), dtype=VERTEX)
    found["at"], found["normal"][:, :3] = mesh.at, np.round(mesh.normal * 127)
    found["paint"][:, :3] = np.clip(np.round(mesh.colour * 255), 0, 255)
    found["paint"][:, 3] = mesh.material
    found["uv"] = mesh.uv / _METRES[mesh.material][:, None]
    found["tag"] = tag
    return found


def _lies(corners: NDArray[np.void]) -> bool:
    """Whether any corner faces upwards just above the floor."""
    return bool(((corners["at"][:, 2] < _FLAT) & (corners["normal"][:, 2] > _UPWARDS)).any())


def thing_mesh(scene: Scene, thing: SceneObject) -> Mesh:
    """The triangles of an object of a home, in its own frame."""
    if thing.mesh and scene.meshes is not None:
        parts = [(read_solid(part_file(scene.meshes, part)), rgb_of(part.colour)) for part in thing.mesh]
        return merged([painted(solid, rgb, of_thing(thing.cls, thing.rgb, rgb)) for solid, rgb in parts])
    return shape_mesh(thing.cls, thing.size, thing.rgb)


@lru_cache(maxsize=256)
def shape_mesh(cls: str, size: Size, colour: Colour) -> Mesh:
    """The triangles of a thing of a class, in its own frame; not to be changed."""
    return parts_mesh(parts_of(cls, size, colour), cls, colour)


def parts_mesh(parts: Sequence[Part], cls: str, colour: Colour) -> Mesh:
    """The triangles of some parts of a thing."""
    return merged([_part(part, of_thing(cls, colour, _rgb(part))) for part in parts])


def _rgb(part: Part) -> Colour:
    return part.rgba[:3]


def _part(part: Part, material: Material) -> Mesh:
    mesh = of_part(part, material)
    if material != Material.WINDOW:
        return mesh
    low, high = mesh.at.min(axis=0), mesh.at.max(axis=0)
    return mesh._replace(uv=((mesh.at - low) / np.maximum(high - low, 1e-6))[:, (0, 2)])


def turned(yaw: float) -> Array:
    """The matrix of a yaw, exact at whole quarters."""
    return about_z(math.remainder(yaw, math.tau))
