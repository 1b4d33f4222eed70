"""Meshes in COLLADA, which pycollada reads and trimesh puts together, once we have seen what they would make of it.

Both would unpack an archive, follow a node that shows itself, and copy a shape for each of the times it is shown.
"""

from __future__ import annotations

import io
import logging
from collections import defaultdict
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.xml_files import read_xml
from coopera.simulation.homes.glb import MOST_CORNERS, MOST_PARTS

Element = ElementTree.Element
MOST_BYTES = 32 * 2**20
DEEPEST = 64
"""No element and no chain of nodes is deeper."""
_OFFSETS = tuple("0123456789")
_FACES = ("triangles", "tristrips", "trifans", "polylist", "polygons")


def read_collada(path: Path) -> Any:
    """The one mesh (`trimesh.Trimesh`) of all that a file shows.

    Raises:
        ConfigError: If it is beyond the limits, or pycollada is missing.
        ValueError: If it cannot be read.
    """
    root = read_xml(path, "mesh", MOST_BYTES, DEEPEST)
    _check_count(root)
    if find_spec("collada") is None:
        raise ConfigError(f"{path}: a mesh of this kind needs pycollada (pip install pycollada).")
    import trimesh  # noqa: PLC0415 - heavy

    data = io.BytesIO(ElementTree.tostring(root))  # all that was seen, and nothing besides
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # else it writes tracebacks of what it does without
    try:
        mesh: Any = trimesh.load(data, file_type="dae", force="mesh")
        mesh.vertex_normals  # noqa: B018 - they are made now, if they can be
    except Exception as err:  # whatever is wrong in it comes as an error of its own kind
        raise ValueError(" ".join(str(err).split())[:200] or type(err).__name__) from err
    return mesh


def _check_count(root: Element) -> None:
    """Refuse too many corners before they are copied for each node that shows them."""
    named: dict[str, list[Element]] = defaultdict(list)
    for one in root.iter():
        if _kind(one) in ("node", "geometry"):
            named[one.get("id", "")].append(one)
    known: dict[Element, int] = {}
    shown, corners = 0, 0
    for scene in (one for one in root.iter() if _kind(one) == "visual_scene"):
        for part in _shown(scene, named, DEEPEST):
            if part not in known:
                known[part] = _corners(part) if _kind(part) == "geometry" else 0
            shown, corners = shown + 1, corners + known[part]
            if shown > MOST_PARTS or corners > MOST_CORNERS:
                raise ValueError(f"it shows more than {MOST_PARTS} nodes and parts, or {MOST_CORNERS} corners")


def _shown(node: Element, named: dict[str, list[Element]], deepest: int) -> Iterator[Element]:
    """Each node and each geometry, as often as it is shown."""
    if not deepest:
        raise ValueError(f"its nodes lie more than {DEEPEST} deep within each other")
    yield node
    for one in node:
        parts = [one] if _kind(one) == "node" else []
        if _kind(one) in ("instance_node", "instance_geometry"):
            parts = named.get(one.get("url", "").removeprefix("#"), [])
        for part in parts:
            yield from _shown(part, named, deepest - 1) if _kind(part) == "node" else (part,)


def _corners(geometry: Element) -> int:
    """How many corners its faces name, and how many places it has."""
    count = 0
    for part in (part for mesh in geometry for part in mesh):
        if _kind(part) == "source":
            count += sum(_words(one.text) for one in part if _kind(one) == "float_array") // 3
        elif _kind(part) in _FACES:
            offsets = [one.get("offset", "") for one in part if _kind(one) == "input"]
            each = 1 + max((int(one) for one in offsets if one in _OFFSETS), default=0)
            count += sum(_words(one.text) for one in part if _kind(one) == "p") // each
    return count


def _words(text: str | None) -> int:
    gaps = np.frombuffer(f" {text or ''}".encode(), np.uint8) <= ord(" ")
    return int(np.count_nonzero(gaps[:-1] & ~gaps[1:]))


def _kind(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]
