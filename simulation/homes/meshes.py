"""What imported things look like: their meshes, made small enough to be drawn often, as OBJ files.

A thing is drawn in a few colours, each part of it that has one being a file of its own. Files are named by what they
hold, so that equal things share them.
"""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.simulation.homes.glb import Array, Indices, Mesh
from coopera.simulation.homes.scene import MeshPart, rgb_of

MOST_TRIANGLES = 1500
_CELLS = (64, 48, 32, 24, 16, 12, 8, 5)
_SHADES = 8
_MOST_COLOURS = 6


_LINE = re.compile(r"(?:v|vn)(?: -?\d{1,6}\.\d{1,6}){3}|f(?: \d{1,6}//\d{1,6}){3}", re.ASCII)
_FACE = re.compile(r"(\d{1,6})//(\d{1,6})", re.ASCII)
_MOST_BYTES = 2**20  # of a part's file: `MOST_TRIANGLES` need a fifth of it


class Look(NamedTuple):
    """The parts of a thing, and the text of the files that they name."""

    parts: list[MeshPart]
    files: dict[str, str]


def look_of(mesh: Mesh, colour: str) -> Look:
    """How a mesh is drawn; without any part where it has no triangles.

    Args:
        mesh: Metres, Z up, the middle of the base at the origin.
        colour: "#rrggbb", for what has no colour of its own.
    """
    mesh = simplified(mesh)
    colours = np.where(np.isnan(mesh.colours), np.array(rgb_of(colour)), mesh.colours)
    shades = np.round(colours * _SHADES) / _SHADES
    parts, files = [], {}
    for rows in _grouped(shades, _areas(mesh)):
        text = _obj(mesh.corners, mesh.triangles[rows])
        name = f"{hashlib.sha256(text.encode()).hexdigest()[:20]}.obj"
        red, green, blue = (round(float(channel) * 255) for channel in colours[rows].mean(axis=0))
        parts.append(MeshPart(file=name, colour=f"#{red:02x}{green:02x}{blue:02x}"))
        files[name] = text
    return Look(parts, files)


def part_file(folder: Path, part: MeshPart) -> Path:
    """A part's file, after a look at it: a home may come from anywhere, and what draws it trusts every number.

    Raises:
        ConfigError: If it is no file as `look_of` makes them.
    """
    path = folder / part.file
    lines = read_text(path, "mesh", _MOST_BYTES).splitlines()
    points, normals = (sum(line.startswith(f"{kind} ") for line in lines) for kind in ("v", "vn"))
    corners = [(int(point), int(normal)) for line in lines for point, normal in _FACE.findall(line)]
    whole = all(_LINE.fullmatch(line) for line in lines)
    if not (whole and corners and all(0 < p <= points and 0 < n <= normals for p, n in corners)):
        raise ConfigError(f"{path}: this is no mesh that coopera made (lines v, vn and f, faces of known corners).")
    return path


def simplified(mesh: Mesh, most: int = MOST_TRIANGLES) -> Mesh:
    """A mesh of no more than so many triangles: corners that are near each other become one, on ever coarser grids."""
    for cells in _CELLS:
        if len(mesh.triangles) <= most:
            break
        mesh = _merged(mesh, cells)
    flat = _areas(mesh) < 1e-12
    return mesh._replace(triangles=mesh.triangles[~flat][:most], colours=mesh.colours[~flat][:most])


def _merged(mesh: Mesh, cells: int) -> Mesh:
    low, high = mesh.corners.min(axis=0), mesh.corners.max(axis=0)
    cell = np.round((mesh.corners - low) / max(float((high - low).max()) / cells, 1e-9)).astype(np.int64)
    _, number = np.unique(cell, axis=0, return_inverse=True)
    number = number.ravel()
    count = np.bincount(number)
    middles = np.stack([np.bincount(number, mesh.corners[:, axis]) / count for axis in range(3)], axis=1)
    faces = number[mesh.triangles]
    ordered = np.sort(faces, axis=1)
    whole = np.flatnonzero((ordered[:, 0] < ordered[:, 1]) & (ordered[:, 1] < ordered[:, 2]))
    _, first = np.unique(ordered[whole], axis=0, return_index=True)
    kept = whole[np.sort(first)]
    return Mesh(middles, faces[kept], mesh.colours[kept])


def _areas(mesh: Mesh) -> Array:
    a, b, c = (mesh.corners[mesh.triangles[:, i]] for i in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def _grouped(shades: Array, areas: Array) -> list[Indices]:
    """Triangles by shade, at most `_MOST_COLOURS` groups: what has a rare shade goes with the one most like it."""
    if not len(shades):
        return []
    found, group = np.unique(shades, axis=0, return_inverse=True)
    group = group.ravel()
    main = np.argsort(-np.bincount(group, areas, minlength=len(found)), kind="stable")[:_MOST_COLOURS]
    like = np.linalg.norm(found[:, None] - found[main], axis=2).argmin(axis=1)
    return [np.flatnonzero(like[group] == number) for number in range(len(main))]


def _obj(corners: Array, triangles: Indices) -> str:
    """A Wavefront OBJ text; every triangle has its own normal, so that edges stay sharp."""
    used, faces = np.unique(triangles, return_inverse=True)
    points = corners[used]
    faces = faces.reshape(-1, 3)
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    lines = [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in points.tolist()]
    lines += [f"vn {x:.3f} {y:.3f} {z:.3f}" for x, y, z in normals.tolist()]
    lines += [f"f {a}//{n} {b}//{n} {c}//{n}" for n, (a, b, c) in enumerate((faces + 1).tolist(), start=1)]
    return "\n".join(lines) + "\n"
