"""Read a mesh from a file of any of the usual formats.

Binary glTF, the format of nearly all homes, is read by our own reader (`glb`), since it comes from strangers: trimesh
takes corners that are no numbers, circles of nodes and one mesh shown without end. The other formats are read by
trimesh, from bytes that we have counted; it opens no further file but those beside a *.gltf.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_limited
from coopera.simulation.homes.glb import FARTHEST, MOST_CORNERS, Mesh, read_glb

FORMATS = (".glb", ".gltf", ".obj", ".ply", ".stl")
MOST_BYTES = 64 * 2**20
"""No file that trimesh reads is larger."""


def read_mesh(path: Path) -> Mesh:
    """Read all triangles of a file, in its own frame.

    Raises:
        ConfigError: If it cannot be read or used; names the file.
    """
    kind = path.suffix.lower()
    if kind == ".glb":
        return read_glb(path)
    if kind not in FORMATS:
        raise ConfigError(f"{path}: a mesh is a file of {', '.join(FORMATS)}.")
    return _checked(path, _read(path, kind))


def _read(path: Path, kind: str) -> list[Any]:
    import trimesh  # noqa: PLC0415  (half a second, and most homes are of glb files)

    data = read_limited(path, MOST_BYTES, "mesh")
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # else it writes tracebacks of what it does without
    try:
        beside = _Beside(path.parent)
        scene = trimesh.load_scene(io.BytesIO(data), file_type=kind[1:], resolver=beside, process=False)
        shown = [scene.geometry[scene.graph[node][1]] for node in scene.graph.nodes_geometry]
        _check_count(path, [one for one in shown if isinstance(one, trimesh.Trimesh)])
        return [one for one in scene.dump() if isinstance(one, trimesh.Trimesh)]
    except ConfigError:
        raise
    except Exception as err:
        said = " ".join(str(err).split())[:200]
        raise ConfigError(f"{path}: the mesh cannot be read ({type(err).__name__}: {said}).") from err


class _Beside(Mapping[str, bytes]):
    """The parts that a *.gltf names, in its own folder alone, read when asked for; no other file is there."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __getitem__(self, name: str) -> bytes:
        if Path(name).name != name or not name.endswith(".bin"):
            raise KeyError(name)
        return read_limited(self._folder / name, MOST_BYTES, "part of the mesh")

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def _check_count(path: Path, shown: list[Any]) -> None:
    """Refuse too many corners before they are copied for each node that shows them."""
    if max(sum(len(one.vertices) for one in shown), sum(len(one.faces) for one in shown)) > MOST_CORNERS:
        raise ConfigError(f"{path}: the mesh has more than {MOST_CORNERS} corners or triangles.")


def _checked(path: Path, found: list[Any]) -> Mesh:
    corners, triangles, colours, count = [], [], [], 0
    for one in found:
        corners.append(np.asarray(one.vertices, dtype=np.float64))
        triangles.append(np.asarray(one.faces, dtype=np.int64) + count)
        colours.append(_colours(one))
        count += len(corners[-1])
    if not sum(map(len, triangles)):
        raise ConfigError(f"{path}: the mesh shows nothing.")
    mesh = Mesh(np.concatenate(corners), np.concatenate(triangles), np.concatenate(colours))
    if not np.isfinite(mesh.corners).all():
        raise ConfigError(f"{path}: the mesh holds a number that is not finite.")
    if (np.abs(mesh.corners) >= FARTHEST).any():
        raise ConfigError(f"{path}: the mesh is out of all bounds.")
    if mesh.triangles.min() < 0 or mesh.triangles.max() >= count:
        raise ConfigError(f"{path}: the mesh has a triangle of a corner that is not there.")
    return mesh


def _colours(one: Any) -> Any:
    """The colours of its triangles, shape (m, 3); NaN where it has none."""
    if one.visual.kind == "face" or one.visual.kind == "vertex":
        return np.asarray(one.visual.face_colors, dtype=np.float64)[:, :3] / 255
    return np.full((len(one.faces), 3), np.nan)
