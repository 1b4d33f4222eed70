"""Meshes from files, as the robots' descriptions and imported homes bring them: Wavefront OBJ, STL and COLLADA."""

from __future__ import annotations

import io
import re
from functools import lru_cache
from pathlib import Path

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_limited, read_text
from coopera.simulation.drawing.collada import read_collada
from coopera.simulation.drawing.geometry import Faces, Floats, Solid, flat_uv
from coopera.simulation.homes.glb import FARTHEST

MOST_BYTES = 64 * 2**20
MOST = 1_000_000
"""No file has more places, normals or triangles."""
_LONGEST = 65_536  # characters of a line of an OBJ
_VERTEX = re.compile(r"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")
_STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])


@lru_cache(maxsize=512)
def read_solid(path: Path) -> Solid:
    """The shape in a file.

    Raises:
        ConfigError: If it cannot be read, is too large, or of another kind.
    """
    readers = {".obj": _obj, ".stl": _stl, ".dae": _dae}
    if path.suffix.lower() not in readers:
        raise ConfigError(f"{path}: the renderer gl reads meshes as .obj, .stl or .dae.")
    try:
        solid = readers[path.suffix.lower()](path)
    except (OSError, ValueError, IndexError) as err:
        raise ConfigError(f"{path}: this mesh cannot be read: {err}.") from err
    if not (np.abs(solid.at) < FARTHEST).all():
        raise ConfigError(f"{path}: the mesh is out of all bounds, or has a number that is none.")
    return solid


def _stl(path: Path) -> Solid:
    data = read_limited(path, MOST_BYTES, "mesh")
    count = int.from_bytes(data[80:84], "little")
    binary = len(data) == 84 + count * _STL.itemsize
    _check_count(count if binary else data.count(b"vertex") // 3)
    if binary:
        return _faceted(np.frombuffer(data, _STL, count, 84)["corners"])
    numbers = (float(word) for found in _VERTEX.finditer(data.decode("ascii")) for word in found.groups())
    return _faceted(np.fromiter(numbers, np.float32).reshape(-1, 3, 3))


def _check_count(*counts: int) -> None:
    if max(counts) > MOST:
        raise ValueError(f"it has more than {MOST} places, normals or triangles")


def _faceted(corners: Floats) -> Solid:
    """Triangles (n, 3, 3) each with its own flat normal."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)
    at = np.ascontiguousarray(corners.reshape(-1, 3), dtype=np.float32)
    normals = np.repeat(normal, 3, axis=0).astype(np.float32)
    faces = np.arange(len(at), dtype=np.uint32).reshape(-1, 3)
    return Solid(at, normals, flat_uv(at, normals, 0), faces)


def _dae(path: Path) -> Solid:
    mesh = read_collada(path)
    at, normal = mesh.vertices.astype(np.float32), mesh.vertex_normals.astype(np.float32)
    return Solid(at, normal, flat_uv(at, normal, 0), mesh.faces.astype(np.uint32))


def _obj(path: Path) -> Solid:
    points: list[list[float]] = []
    normals: list[list[float]] = []
    corners: list[tuple[int, int]] = []
    for line in io.StringIO(read_text(path, "mesh", MOST_BYTES), newline=None):
        _check_count(len(points), len(normals), len(corners) // 3)
        if len(line) > _LONGEST:
            raise ValueError(f"a line has more than {_LONGEST} characters")
        kind, _, rest = line.partition(" ")
        if kind == "v":
            points.append([float(word) for word in rest.split()[:3]])
        elif kind == "vn":
            normals.append([float(word) for word in rest.split()[:3]])
        elif kind == "f":
            face = [_corner(word, len(points), len(normals)) for word in rest.split()]
            for i in range(1, len(face) - 1):
                corners += [face[0], face[i], face[i + 1]]
    _check_count(len(points), len(normals), len(corners) // 3)
    at = np.array(points, dtype=np.float32).reshape(-1, 3)
    try:
        pairs = np.array(corners, dtype=np.int64).reshape(-1, 2)
    except OverflowError as err:
        raise ValueError("a face names a corner that is not there") from err
    if pairs.size and not (pairs[:, 0].min() >= 0 and pairs[:, 0].max() < len(at)):
        raise ValueError("a face names a corner that is not there")
    if not normals or (pairs.size and (pairs[:, 1].min() < 0 or pairs[:, 1].max() >= len(normals))):
        return _faceted(at[pairs[:, 0]].reshape(-1, 3, 3))
    used, faces = np.unique(pairs, axis=0, return_inverse=True)
    normal: Floats = np.array(normals, dtype=np.float32)[used[:, 1]]
    place = at[used[:, 0]]
    triangles: Faces = faces.reshape(-1, 3).astype(np.uint32)
    return Solid(place, normal, flat_uv(place, normal, 0), triangles)


def _corner(word: str, points: int, normals: int) -> tuple[int, int]:
    """Numbers of a corner's place and normal, from 0; -1 for no normal."""
    parts = word.split("/")
    place, normal = int(parts[0]), int(parts[2]) if len(parts) > 2 and parts[2] else 0
    return place - 1 if place > 0 else points + place, normal - 1 if normal > 0 else normals + normal if normal else -1
