"""Triangles: the primitives that things are built of, put together and moved. Lengths are metres."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.shapes.kit import Colour, Part
from coopera.simulation.shapes.rotations import Array, matrix

Floats = NDArray[np.float32]
Faces = NDArray[np.uint32]


class Mesh(NamedTuple):
    """Triangles with all that decides what they look like; faces run counter-clockwise seen from outside."""

    at: Floats
    """(n, 3) places."""
    normal: Floats
    """(n, 3) unit vectors."""
    uv: Floats
    """(n, 2) places on the surface, in metres, the first along the grain."""
    colour: Floats
    """(n, 3) from 0 to 1."""
    material: NDArray[np.uint8]
    """(n,) numbers of `materials.Material`."""
    faces: Faces
    """(m, 3) numbers of corners."""

    def moved(self, place: Array | Sequence[float], turn: Array) -> Mesh:
        """The mesh turned by a matrix, then shifted."""
        spun = np.asarray(turn, dtype=np.float32).T
        return self._replace(at=self.at @ spun + np.asarray(place, dtype=np.float32), normal=self.normal @ spun)


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes as one."""
    if not meshes:
        none = np.zeros((0, 3), dtype=np.float32)
        return Mesh(none, none, none[:, :2], none, np.zeros(0, dtype=np.uint8), np.zeros((0, 3), dtype=np.uint32))
    starts = np.cumsum([0, *(len(mesh.at) for mesh in meshes[:-1])]).astype(np.uint32)
    faces = np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)])
    at, normal, uv, colour, material = (np.concatenate([mesh[i] for mesh in meshes]) for i in range(5))
    return Mesh(at, normal, uv, colour, material, faces.astype(np.uint32))


def painted(solid: Solid, colour: Colour, material: int) -> Mesh:
    """A solid in one colour and of one material."""
    count = len(solid.at)
    colours = np.tile(np.asarray(colour, dtype=np.float32), (count, 1))
    return Mesh(solid.at, solid.normal, solid.uv, colours, np.full(count, material, dtype=np.uint8), solid.faces)


class Solid(NamedTuple):
    """A shape without its paint: see `Mesh`."""

    at: Floats
    normal: Floats
    uv: Floats
    faces: Faces


def of_part(part: Part, material: int) -> Mesh:
    """The triangles of a thing's part, in the thing's frame."""
    if part.kind == "box":
        solid = box(part.half)
    elif part.kind == "cylinder":
        solid = cylinder(part.radius, part.length)
    else:
        solid = capsule(part.radius, 0.0 if part.kind == "sphere" else part.length)
    mesh = painted(solid, part.rgba[:3], material)
    return mesh.moved(part.position, matrix(part.orientation))


def box(half: Sequence[float]) -> Solid:
    """A box around the origin; the grain runs along its longest side."""
    corner, normal, faces = _unit_box()
    size = np.asarray(half, dtype=np.float32)
    at = corner * size
    return Solid(at, normal, flat_uv(at, normal, int(np.argmax(size))), faces)


def fine_box(half: Sequence[float], step: float) -> Solid:
    """A box around the origin, its sides divided into rectangles of at most `step` a side."""
    size = np.asarray(half, dtype=np.float32)
    places, normals, faces, start = [], [], [], 0
    for axis in range(3):
        across = [other for other in range(3) if other != axis]
        counts = [max(math.ceil(float(2 * size[other]) / step), 1) for other in across]
        u, v = (np.linspace(-1.0, 1.0, count + 1, dtype=np.float32) for count in counts)
        grid = np.zeros((counts[0] + 1, counts[1] + 1, 3), dtype=np.float32)
        grid[:, :, across[0]], grid[:, :, across[1]] = u[:, None], v[None, :]
        i, j = np.meshgrid(np.arange(counts[0]), np.arange(counts[1]), indexing="ij")
        a = (i * (counts[1] + 1) + j).ravel()
        b, c, d = a + counts[1] + 1, a + counts[1] + 2, a + 1
        quads = np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))
        for sign in (-1.0, 1.0):
            outwards = sign if axis != 1 else -sign  # x and z in this order turn about -y
            at, normal = grid.reshape(-1, 3).copy(), np.zeros((grid.size // 3, 3), dtype=np.float32)
            at[:, axis] = normal[:, axis] = sign
            places.append(at * size)
            normals.append(normal)
            faces.append((quads if outwards > 0 else quads[:, ::-1]) + start)
            start += len(at)
    at, normal = np.concatenate(places), np.concatenate(normals)
    return Solid(at, normal, flat_uv(at, normal, int(np.argmax(size))), np.concatenate(faces).astype(np.uint32))


def flat_uv(at: Floats, normal: Floats, grain: int) -> Floats:
    """Places on flat surfaces: projected along the nearest axis, first along the axis `grain` where it lies in them."""
    across = np.abs(normal).argmax(axis=1)
    first = np.where(across == grain, (across + 1) % 3, grain)
    second = 3 - across - first
    rows = np.arange(len(at))
    return np.stack((at[rows, first], at[rows, second]), axis=1)


@lru_cache(maxsize=1)
def _unit_box() -> tuple[Floats, Floats, Faces]:
    corners: list[list[float]] = []
    normals: list[list[float]] = []
    faces: list[list[int]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            start = len(corners)
            for u, v in ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)):
                corner, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
                corner[axis], corner[a], corner[b] = sign, u, v
                normal[axis] = sign
                corners.append(corner)
                normals.append(normal)
            quad = [(0, 1, 2), (0, 2, 3)] if sign > 0 else [(0, 2, 1), (0, 3, 2)]
            faces += [[start + i for i in triangle] for triangle in quad]
    return np.array(corners, dtype=np.float32), np.array(normals, dtype=np.float32), np.array(faces, dtype=np.uint32)


def _around(radius: float) -> int:
    """How many sides something round has."""
    return 10 if radius < 0.012 else 16 if radius < 0.06 else 28


def cylinder(radius: float, length: float) -> Solid:
    """A cylinder around the origin, along z."""
    at, normal, turn, faces = _unit_cylinder(_around(radius))
    scaled = at * np.array((radius, radius, length / 2), dtype=np.float32)
    side = np.abs(normal[:, 2]) < 0.5
    uv = np.where(side[:, None], np.stack((scaled[:, 2], turn * radius), axis=1), scaled[:, :2])
    return Solid(scaled, normal, uv.astype(np.float32), faces)


@lru_cache(maxsize=4)
def _unit_cylinder(count: int) -> tuple[Floats, Floats, Floats, Faces]:
    angle = np.linspace(0.0, 2 * math.pi, count + 1, dtype=np.float32)
    ring = np.stack((np.cos(angle), np.sin(angle), np.zeros_like(angle)), axis=1)
    up = np.array((0.0, 0.0, 1.0), dtype=np.float32)
    at = np.concatenate((ring - up, ring + up, ring - up, ring + up))
    normal = np.concatenate((ring, ring, np.tile(-up, (count + 1, 1)), np.tile(up, (count + 1, 1))))
    low, high, below, above = (np.arange(count + 1) + k * (count + 1) for k in range(4))
    faces = [
        np.stack((low[:-1], low[1:], high[1:]), axis=1),
        np.stack((low[:-1], high[1:], high[:-1]), axis=1),
        np.stack((np.full(count - 2, below[0]), below[2:-1], below[1:-2]), axis=1),
        np.stack((np.full(count - 2, above[0]), above[1:-2], above[2:-1]), axis=1),
    ]
    return at, normal, np.tile(angle, 4), np.concatenate(faces).astype(np.uint32)


def capsule(radius: float, length: float) -> Solid:
    """A capsule around the origin, along z; a ball where the length, which does not count the caps, is 0."""
    normal, angle, faces = _unit_ball(_around(radius))
    shift = np.sign(np.round(normal[:, 2], 5)) * length / 2
    shift[: len(shift) // 2] = -length / 2
    shift[len(shift) // 2 :] = length / 2
    at = normal * radius
    at[:, 2] += shift
    uv = np.stack((at[:, 2], angle * radius), axis=1)
    return Solid(at.astype(np.float32), normal, uv.astype(np.float32), faces)


@lru_cache(maxsize=4)
def _unit_ball(count: int) -> tuple[Floats, Floats, Faces]:
    """A ball as an even number of rings from below to above, the equator twice."""
    half = max(count // 4, 3)
    tilt = np.concatenate((np.linspace(-math.pi / 2, 0, half + 1), np.linspace(0, math.pi / 2, half + 1)))
    angle = np.linspace(0.0, 2 * math.pi, count + 1)
    normal = np.stack(
        (
            np.outer(np.cos(tilt), np.cos(angle)),
            np.outer(np.cos(tilt), np.sin(angle)),
            np.outer(np.sin(tilt), angle**0),
        ),
        axis=2,
    ).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(tilt) - 1), np.arange(count), indexing="ij")
    a = (i * (count + 1) + j).ravel()
    b, c, d = a + 1, a + count + 2, a + count + 1
    faces = np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))
    whole = normal[faces]
    keep = np.linalg.norm(np.cross(whole[:, 1] - whole[:, 0], whole[:, 2] - whole[:, 0]), axis=1) > 1e-9
    middle = (i == half).ravel()
    keep |= np.concatenate((middle, middle))
    return normal.astype(np.float32), np.tile(angle, len(tilt)).astype(np.float32), faces[keep].astype(np.uint32)
