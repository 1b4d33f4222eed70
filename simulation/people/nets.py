"""Surfaces of fields: surface nets (S. Gibson, "Constrained elastic surface nets", 1998), and cuts along a line.

A net has one vertex in each cell of a grid through which the surface goes, at the mean of where it crosses the cell's
edges; it is then moved onto the surface along the field's slope.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.people.fields import Array, Field, slopes

Index = NDArray[np.int64]

_BLOCK = 4
"""The field is first looked at in every fourth point of the grid, and in between only near the surface."""
_STEPS = 3
_HALVINGS = 6
_NEAR = 5.0
"""Steps from the surface to the middle of a block that may hold some of it, fields being somewhat steeper than 1."""


class Mesh(NamedTuple):
    """Vertices (V, 3) and faces (F, 3), counter-clockwise from without."""

    vertices: Array
    faces: Index


class Box(NamedTuple):
    """The corners between which a surface is looked for, and the grid's spacing (metres)."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    step: float


def surface(field: Field, box: Box) -> Mesh:
    """The surface where a field is zero, within a box that holds it whole or cuts it open."""
    low = np.asarray(box.low)
    blocks = np.ceil((np.asarray(box.high) - low) / (box.step * _BLOCK)).astype(int)
    values = _sampled(field, low, box.step, blocks)
    found = _net(values)
    vertices = low + found.vertices * box.step
    for _ in range(_STEPS):
        slope = slopes(field, vertices)
        steep = np.maximum((slope * slope).sum(axis=1), 0.1)
        move = (field(vertices) / steep)[:, None] * slope
        size = np.sqrt((move * move).sum(axis=1))
        vertices = vertices - move * np.minimum(1.0, 0.7 * box.step / np.maximum(size, 1e-9))[:, None]
    return Mesh(vertices, found.faces)


def _sampled(field: Field, low: Array, step: float, blocks: NDArray[np.int_]) -> NDArray[np.float32]:
    """The field on a grid; far from the surface only its sign is right."""
    coarse = np.stack(np.meshgrid(*(np.arange(n) for n in blocks), indexing="ij"), axis=-1).reshape(-1, 3)
    middle = low + (coarse + 0.5 - 0.5 / _BLOCK) * (step * _BLOCK)
    rough = field(middle)
    near = np.abs(rough) < step * _NEAR
    values = np.repeat(rough.astype(np.float32), _BLOCK**3).reshape(*blocks, _BLOCK, _BLOCK, _BLOCK)
    inner = np.stack(np.meshgrid(*(np.arange(_BLOCK),) * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    fine = (coarse[near][:, None] * _BLOCK + inner[None]).reshape(-1, 3)
    values.reshape(-1, _BLOCK**3)[near] = field(low + fine * step).reshape(-1, _BLOCK**3)
    size = blocks * _BLOCK
    found: NDArray[np.float32] = values.transpose(0, 3, 1, 4, 2, 5).reshape(size)
    return found


def _net(values: NDArray[np.float32]) -> Mesh:
    """The net of a grid's values, in units of the grid."""
    inside = values < 0
    shape = np.array(values.shape) - 1
    total, count = np.zeros((*shape, 3), dtype=np.float32), np.zeros(shape, dtype=np.float32)
    for axis in range(3):
        first, last = _ends(values, axis)
        crosses = (first < 0) != (last < 0)
        share = np.where(crosses, first / np.where(crosses, first - last, 1.0), 0.0)
        others = [one for one in range(3) if one != axis]
        for i in (0, 1):
            for j in (0, 1):
                corner: list[slice] = [slice(None)] * 3
                corner[others[0]], corner[others[1]] = slice(i, i + shape[others[0]]), slice(j, j + shape[others[1]])
                where = tuple(corner)
                count += crosses[where]
                total[..., axis] += share[where]
                total[..., others[0]] += i * crosses[where]
                total[..., others[1]] += j * crosses[where]
    used = count > 0
    number = np.full(shape, -1, dtype=np.int64)
    number[used] = np.arange(int(used.sum()))
    vertices = np.argwhere(used) + total[used] / count[used][:, None]
    return Mesh(vertices.astype(np.float64), _quads(inside, number))


def _ends(values: NDArray[np.float32], axis: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    count = values.shape[axis]
    return np.take(values, range(count - 1), axis), np.take(values, range(1, count), axis)


def _quads(inside: NDArray[np.bool_], number: Index) -> Index:
    """Two triangles for each edge of the grid that the surface crosses."""
    faces = []
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        inner: list[slice] = [slice(None)] * 3
        inner[b], inner[c] = slice(1, -1), slice(1, -1)
        first = np.take(inside, range(inside.shape[axis] - 1), axis)[tuple(inner)]
        last = np.take(inside, range(1, inside.shape[axis]), axis)[tuple(inner)]
        for starts, turned in ((first & ~last, False), (~first & last, True)):
            at = np.argwhere(starts)
            at[:, b] += 1
            at[:, c] += 1
            corners = []
            for down_b, down_c in ((1, 1), (0, 1), (0, 0), (1, 0)):
                cell = at.copy()
                cell[:, b] -= down_b
                cell[:, c] -= down_c
                corners.append(number[tuple(cell.T)])
            p, q, r, s = reversed(corners) if turned else corners
            faces += [np.stack((p, q, r), axis=1), np.stack((p, r, s), axis=1)]
    return np.concatenate(faces)


def clip(mesh: Mesh, field: Field) -> tuple[Mesh, Mesh]:
    """Cut a mesh along the line where a field is zero: what is below zero, and the rest."""
    values = field(mesh.vertices) if len(mesh.vertices) else np.zeros(0)
    values = np.where(np.abs(values) < 1e-6, 1e-6, values)
    low = values < 0
    count = low[mesh.faces].sum(axis=1)
    whole_low, whole_high = mesh.faces[count == 3], mesh.faces[count == 0]
    mixed = mesh.faces[(count == 1) | (count == 2)]
    if not len(mixed):
        return _used(Mesh(mesh.vertices, whole_low)), _used(Mesh(mesh.vertices, whole_high))
    alone = np.where(low[mixed].sum(axis=1) == 1, np.argmax(low[mixed], axis=1), np.argmin(low[mixed], axis=1))
    rows = np.arange(len(mixed))
    tip, left, right = (mixed[rows, (alone + k) % 3] for k in range(3))
    edges = np.sort(np.concatenate((np.stack((tip, left), axis=1), np.stack((tip, right), axis=1))), axis=1)
    unique, where = np.unique(edges, axis=0, return_inverse=True)
    added = _crossings(field, mesh.vertices[unique[:, 0]], mesh.vertices[unique[:, 1]], low[unique[:, 0]])
    vertices = np.concatenate((mesh.vertices, added))
    to_left, to_right = (part + len(mesh.vertices) for part in np.split(where.reshape(-1), 2))
    tips = np.stack((tip, to_left, to_right), axis=1)
    rests = np.concatenate((np.stack((to_left, left, right), axis=1), np.stack((to_left, right, to_right), axis=1)))
    tip_low = low[tip]
    rest_low = np.concatenate((~tip_low, ~tip_low))
    below = np.concatenate((whole_low, tips[tip_low], rests[rest_low]))
    above = np.concatenate((whole_high, tips[~tip_low], rests[~rest_low]))
    return _used(Mesh(vertices, below)), _used(Mesh(vertices, above))


def _crossings(field: Field, first: Array, last: Array, first_low: NDArray[np.bool_]) -> Array:
    """Where edges cross a field's zero, by halving; clear of their ends."""
    near, far = np.zeros(len(first)), np.ones(len(first))
    for _ in range(_HALVINGS):
        middle = (near + far) / 2
        same = (field(first + middle[:, None] * (last - first)) < 0) == first_low
        near, far = np.where(same, middle, near), np.where(same, far, middle)
    share = np.clip((near + far) / 2, 0.02, 0.98)
    found: Array = first + share[:, None] * (last - first)
    return found


def _used(mesh: Mesh) -> Mesh:
    """A mesh without vertices that no face has."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(mesh.faces.shape))
