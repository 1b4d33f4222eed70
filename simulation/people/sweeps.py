"""Small meshes swept along lines: tubes, such as fingers and spectacles, and patches that lie on a surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coopera.simulation.people.fields import Array, Field, slopes
from coopera.simulation.people.nets import Index


class Piece(NamedTuple):
    """A mesh with its normals, of one colour and one material."""

    vertices: Array
    normals: Array
    faces: Index
    colour: tuple[float, float, float]
    material: str


def grid_faces(rows: int, columns: int, *, closed: bool) -> Index:
    """The faces between the points of a grid, row by row; `closed` joins the last column to the first."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij")
    after = (j + 1) % columns
    a, b, c, d = i * columns + j, i * columns + after, (i + 1) * columns + after, (i + 1) * columns + j
    found: Index = np.stack((a, b, c, a, c, d), axis=-1).reshape(-1, 3)
    return found


def ordered(found: tuple[Array, Array, Index]) -> tuple[Array, Array, Index]:
    """The same, its faces turned to where its normals point."""
    vertices, normals, faces = found
    corners = vertices[faces]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    away = (facing * normals[faces].mean(axis=1)).sum(axis=1) < 0
    return vertices, normals, np.where(away[:, None], faces[:, ::-1], faces)


def tube(path: Array, radii: Array, sides: int, *, closed: bool = False) -> tuple[Array, Array, Index]:
    """Vertices, normals and faces of a tube along a path (N, 3); a closed path comes back to its beginning."""
    along = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0) if closed else np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    spread = np.abs(along).max(axis=0)
    across = np.cross(along, np.eye(3)[int(np.argmin(spread))])
    across /= np.linalg.norm(across, axis=1)[:, None]
    third = np.cross(along, across)
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    normals = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * third[:, None]
    vertices = path[:, None] + radii[:, None, None] * normals
    if closed:
        vertices, normals = (np.concatenate((one, one[:1])) for one in (vertices, normals))
    rows = len(vertices)
    return vertices.reshape(-1, 3), normals.reshape(-1, 3), grid_faces(rows, sides, closed=True)


def finger(path: Array, radii: Array, sides: int = 6) -> tuple[Array, Array, Index]:
    """A tube with a round end."""
    tip, last = path[-1], path[-1] - path[-2]
    last /= np.linalg.norm(last)
    round_ = radii[-1] * np.array((0.55, 0.85, 1.0))
    path = np.concatenate((path, tip + round_[:, None] * last))
    radii = np.concatenate((radii, radii[-1] * np.array((0.84, 0.50, 0.02))))
    vertices, normals, faces = tube(path, radii, sides)
    normals = normals.reshape(-1, sides, 3)
    for back, share in ((3, 0.6), (2, 1.6), (1, 30.0)):
        normals[-back] += share * last
    normals /= np.linalg.norm(normals, axis=2)[:, :, None]
    return vertices, normals.reshape(-1, 3), faces


def patch(field: Field, middle: Array, half: Array, lift: float) -> tuple[Array, Array, Index]:
    """A low cushion that lies on the surface of a field before it, such as a brow or a lip.

    Args:
        field: Whose surface it lies on; looked at from ahead, along -x.
        middle: The cushion's middle line, (N, 2), as y and z; from the left to the right of who looks.
        half: Half its height along that line (N,).
        lift: How far its middle stands out.
    """
    rows = np.array((1.0, 0.55, 0.0, -0.55, -1.0))
    lifts = np.array((-0.0015, 0.7, 1.0, 0.7, -0.0015))
    lifts = np.where(lifts < 0, lifts, lifts * lift)
    y = np.tile(middle[:, 0], (5, 1))
    z = middle[None, :, 1] + rows[:, None] * half[None]
    flat = np.stack((np.zeros(y.size), y.ravel(), z.ravel()), axis=1)
    near, far = np.full(len(flat), 0.14), np.full(len(flat), 0.02)
    for _ in range(12):
        flat[:, 0] = (near + far) / 2
        inside = field(flat) < 0
        far, near = np.where(inside, flat[:, 0], far), np.where(inside, near, flat[:, 0])
    slope = slopes(field, flat)
    slope /= np.linalg.norm(slope, axis=1)[:, None]
    ends = np.ones(len(middle))
    ends[[0, -1]] = 0.1
    vertices = flat + (lifts[:, None] * ends[None]).ravel()[:, None] * slope
    tilt = np.repeat(rows * lift / 0.008, len(middle))[:, None] * np.array((0.0, 0.0, 1.0))
    normals = slope + tilt
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return vertices, normals, grid_faces(5, len(middle), closed=False)[:, ::-1]
