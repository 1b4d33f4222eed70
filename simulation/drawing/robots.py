"""What a robot, or any body that a URDF describes, looks like: the triangles of each of its links."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from coopera.core.errors import ConfigError
from coopera.simulation.bodies.urdf import Urdf
from coopera.simulation.drawing.files import read_solid
from coopera.simulation.drawing.geometry import Mesh, Solid, box, capsule, cylinder, merged, painted
from coopera.simulation.drawing.materials import Material
from coopera.simulation.shapes.rotations import about_x, about_y, about_z

_GREY = (0.7, 0.7, 0.7)


def links_of(urdf: Urdf) -> dict[str, Mesh]:
    """The visible triangles of each link that has any, in the link's own frame.

    Raises:
        ConfigError: If a mesh that the file names cannot be read.
    """
    colours = {name: rgb for name, rgb in map(_colour, urdf.root.findall("material")) if rgb is not None}
    found = {}
    for link in urdf.root.findall("link"):
        meshes = [_visual(urdf.path, visual, colours) for visual in link.findall("visual")]
        if meshes:
            found[link.get("name", "")] = merged(meshes)
    return found


def _visual(urdf: Path, visual: ElementTree.Element, colours: dict[str, tuple[float, float, float]]) -> Mesh:
    material = visual.find("material")
    name, rgb = ("", None) if material is None else _colour(material)
    colour = rgb or colours.get(name, _GREY)
    solid = next((_solid(urdf, shape) for shape in visual.iterfind("geometry/*")), None)
    if solid is None:
        return merged([])
    made = Material.METAL if _steely(colour) else Material.PLAIN
    origin = visual.find("origin")
    if origin is None:
        return painted(solid, colour, made)
    roll, pitch, yaw = _numbers(origin.get("rpy"), 3, 0.0)
    turn = about_z(yaw) @ about_y(pitch) @ about_x(roll)
    return painted(solid, colour, made).moved(_numbers(origin.get("xyz"), 3, 0.0), turn)


def _steely(colour: Sequence[float]) -> bool:
    return max(colour) - min(colour) < 0.06 and 0.3 < max(colour) < 0.75


def _colour(material: ElementTree.Element) -> tuple[str, tuple[float, float, float] | None]:
    colour = material.find("color")
    if colour is None:
        return material.get("name", ""), None
    red, green, blue, _ = _numbers(colour.get("rgba"), 4, 1.0)
    return material.get("name", ""), (red, green, blue)


def _solid(urdf: Path, shape: ElementTree.Element) -> Solid:
    if shape.tag == "box":
        return box([side / 2 for side in _numbers(shape.get("size"), 3, 0.01)])
    if shape.tag in ("cylinder", "sphere", "capsule"):
        radius, length = (float(shape.get(name) or 0.0) for name in ("radius", "length"))
        return cylinder(radius, length) if shape.tag == "cylinder" else capsule(radius, length)
    if shape.tag == "mesh":
        return _scaled(read_solid(Path(shape.get("filename") or "")), _numbers(shape.get("scale"), 3, 1.0))
    raise ConfigError(f"{urdf}: the renderer gl knows no shape {shape.tag!r}.")


def _scaled(solid: Solid, scale: Sequence[float]) -> Solid:
    factor = np.asarray(scale, dtype=np.float32)
    normal = solid.normal / np.where(np.abs(factor) < 1e-9, 1.0, factor)
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    faces = solid.faces if math.prod(scale) > 0 else solid.faces[:, ::-1]
    return Solid(solid.at * factor, normal.astype(np.float32), solid.uv * float(np.abs(factor).mean()), faces)


def _numbers(text: str | None, count: int, other: float) -> list[float]:
    """The numbers of an attribute; each `other` where there is none."""
    found: Iterator[float] = map(float, (text or "").split())
    numbers = list(found)
    return numbers if len(numbers) == count else [other] * count
