"""A robot's description as others publish it: a URDF, read within bounds, and made ready to be loaded and drawn."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path, PurePosixPath
from typing import NamedTuple, TypeAlias
from xml.etree import ElementTree

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import exists
from coopera.core.foreign.xml_files import read_xml
from coopera.core.registry import nearest
from coopera.simulation.shapes.rotations import Array, about_x, about_y, about_z

Element = ElementTree.Element
_Read: TypeAlias = Callable[[str, str, Element, tuple[float, ...]], tuple[float, ...]]
OF_PYBULLET = "pybullet_data/"
"""With this begins a mesh that comes from what ships with pybullet."""
MOST_BYTES = 16 * 2**20
MOST_LINKS = 1000
DEEPEST = 20
"""No element lies deeper: of what URDF has none lies deeper than five, and copying recurses."""
FLOOR = "the_floor_under_the_robot"
"""The link that is put before the root of a description whose origin is not under the robot's middle."""
_MOVES = ("revolute", "continuous", "prismatic")
_OTHERS = {"mujoco": "MJCF", "sdf": "SDF", "COLLADA": "COLLADA"}
_SIZES = {
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "capsule": {"radius": 1, "length": 1},
    "mesh": {"scale": 3},
}
"""The shapes that there are, and how many numbers each of their measures has."""
_LIGHT = '<inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'


class Follows(NamedTuple):
    """A joint that goes with another one: by `factor` times its value, plus `offset`."""

    joint: str
    factor: float
    offset: float


class Hinge(NamedTuple):
    """A joint of a description.

    Attributes:
        name: Its name.
        kind: "revolute", "continuous", "prismatic", "fixed" or what else the file says.
        parent: The link that it is on.
        child: The link that it moves.
        place: Its frame's origin in the parent's frame (metres).
        turn: Its frame's turn there, (3, 3); None where there is none.
        axis: The axis in its own frame, of length 1.
        low: Lower limit (radians or metres); -pi for one that turns on and on.
        high: Upper limit.
        follows: The joint that it goes with.
    """

    name: str
    kind: str
    parent: str
    child: str
    place: Array
    turn: Array | None
    axis: Array
    low: float
    high: float
    follows: Follows | None

    @property
    def moves(self) -> bool:
        """Whether it turns or slides."""
        return self.kind in _MOVES


@dataclass(frozen=True, eq=False)
class Urdf:
    """A URDF whose joints form one tree and whose meshes are there.

    Attributes:
        path: The file.
        root: Its elements; meshes of other files have absolute paths.
        hinges: All joints by name.
        base: The link that no joint moves.
    """

    path: Path
    root: Element
    hinges: dict[str, Hinge]
    base: str

    @cached_property
    def links(self) -> frozenset[str]:
        """Names of all links."""
        return frozenset({self.base, *(hinge.child for hinge in self.hinges.values())})

    @cached_property
    def text(self) -> str:
        """The description as XML."""
        return ElementTree.tostring(self.root, encoding="unicode")

    def way(self, link: str) -> list[Hinge]:
        """The joints from the base to a link, in order."""
        moved_by = {hinge.child: hinge for hinge in self.hinges.values()}
        found: list[Hinge] = []
        while link in moved_by:
            found.append(moved_by[link])
            link = moved_by[link].parent
        return found[::-1]

    def followers(self, joint: str) -> Iterator[Hinge]:
        """The joints that go with one."""
        return (one for one in self.hinges.values() if one.follows is not None and one.follows.joint == joint)

    def on_floor(self, middle: Sequence[float], footprint: float) -> Urdf:
        """The same robot with the origin on the floor under its middle, ready for the engine.

        Masses are one and the same, since nothing here has a weight. Of the shapes for collisions, which nothing but
        the rays that ask what hides what meets, those that are meshes go; a robot left with none gets a drum at its
        base.

        Args:
            middle: That point in the frame of the description (x, y, z), in metres.
            footprint: The drum's radius.
        """
        root, hinges, base = deepcopy(self.root), self.hinges, self.base
        for odd in [one for one in root if one.tag not in ("link", "joint", "material")]:
            root.remove(odd)
        links = {link.get("name", ""): link for link in root.findall("link")}
        for link in links.values():
            for old in [*link.findall("inertial"), *_of_mesh(link)]:
                link.remove(old)
            link.insert(0, ElementTree.fromstring(_LIGHT))
        if next(root.iter("collision"), None) is None:
            links[base].append(_drum(middle, footprint))
        if any(middle):
            place = -np.array(middle, dtype=np.float64)
            root.insert(0, ElementTree.fromstring(f'<link name="{FLOOR}">{_LIGHT}</link>'))
            root.append(_stand(base, place))
            stands = Hinge(FLOOR, "fixed", FLOOR, base, place, None, np.array((1.0, 0.0, 0.0)), 0.0, 0.0, None)
            hinges, base = {**hinges, FLOOR: stands}, FLOOR
        return Urdf(self.path, root, hinges, base)


def read_urdf(path: Path) -> Urdf:
    """Read a description.

    Raises:
        ConfigError: If it cannot be used; names the file, and the joint, link or mesh.
    """
    root = read_xml(path, "URDF", MOST_BYTES, DEEPEST)
    if root.tag != "robot":
        kind = _OTHERS.get(root.tag)
        said = f"this is {kind}; only URDF is read" if kind else f"a URDF begins with <robot>, not <{root.tag}>"
        raise ConfigError(f"{path}: {said}.")
    if any("xacro" in element.tag for element in root.iter()):
        raise ConfigError(f"{path}: this is xacro; make a URDF of it first (xacro FILE > robot.urdf).")
    names = [link.get("name", "") for link in root.findall("link")]
    if len(names) > MOST_LINKS:
        raise ConfigError(f"{path}: it has {len(names)} links, and at most {MOST_LINKS} are read.")
    _refuse_twice(path, "links", names)
    _refuse_twice(path, "joints", [joint.get("name", "") for joint in root.findall("joint")])
    hinges = [_hinge(path, joint, set(names)) for joint in root.findall("joint")]
    base = _base(path, names, hinges)
    _check_materials(path, root)
    for link in root.findall("link"):
        _check_shapes(path, link)
    return Urdf(path, root, {hinge.name: hinge for hinge in hinges}, base)


def of_package(named_by: Path, package: str, file: str) -> Path:
    """A file of a package that is installed, by pip's name of the package and the file's path in site-packages.

    Raises:
        ConfigError: If the package is not installed or has no such file; `named_by` is the file that asks.
    """
    inside = PurePosixPath(file)
    if inside.is_absolute() or ".." in inside.parts:
        raise ConfigError(f"{named_by}, field urdf.file: the path must lead down from site-packages.")
    try:
        found = Path(str(distribution(package).locate_file(inside)))
    except (PackageNotFoundError, ValueError):
        raise ConfigError(
            f"{named_by}: this robot's description is in the package {package}, which is not installed "
            f"(pip install --no-deps {package})."
        ) from None
    if not found.is_file():
        raise ConfigError(f"{named_by}, field urdf.file: the package {package} has no file {file}.")
    return found


def known(of: str, name: str, names: Sequence[str] | frozenset[str]) -> str:
    """The end of a sentence about a name that a description does not have."""
    hint = nearest(name, sorted(names)).strip()
    return f"the URDF has no {of} {name!r}" + (f" ({hint})" if hint else "")


def _refuse_twice(path: Path, what: str, names: Sequence[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if not name or name in seen:
            raise ConfigError(f"{path}: two {what} are called {name!r}." if name else f"{path}: {what} need a name.")
        seen.add(name)


def _hinge(path: Path, joint: Element, links: set[str]) -> Hinge:
    name, kind = joint.get("name", ""), joint.get("type", "")
    ends = {}
    for tag in ("parent", "child"):
        end = joint.find(tag)
        link = "" if end is None else end.get("link", "")
        if link not in links:
            raise ConfigError(f"{path}: the {tag} of the joint {name!r} is the link {link!r}, which is missing.")
        ends[tag] = link
    read = _reader(path, f"the joint {name!r}")
    turn = read("origin", "rpy", joint, (0.0, 0.0, 0.0))
    axis = np.array(read("axis", "xyz", joint, (1.0, 0.0, 0.0)))
    length = float(np.linalg.norm(axis))
    if kind in _MOVES and length < 1e-6:
        raise ConfigError(f"{path}: the joint {name!r} moves, but its axis has no length.")
    limited = kind in ("revolute", "prismatic")
    return Hinge(
        name,
        kind,
        ends["parent"],
        ends["child"],
        place=np.array(read("origin", "xyz", joint, (0.0, 0.0, 0.0))),
        turn=_turned(turn) if any(turn) else None,
        axis=axis if length in (0.0, 1.0) else axis / length,
        low=read("limit", "lower", joint, (0.0,))[0] if limited else -math.pi,
        high=read("limit", "upper", joint, (0.0,))[0] if limited else math.pi,
        follows=_follows(joint, read),
    )


def _follows(joint: Element, read: _Read) -> Follows | None:
    mimic = joint.find("mimic")
    if mimic is None:
        return None
    factor, offset = read("mimic", "multiplier", joint, (1.0,))[0], read("mimic", "offset", joint, (0.0,))[0]
    return Follows(mimic.get("joint", ""), factor, offset)


def _check_materials(path: Path, root: Element) -> None:
    for material in root.iter("material"):
        for colour in material.findall("color"):
            if len(_finite(colour.get("rgba", ""))) != 4:  # red, green, blue, how opaque
                name = material.get("name", "")
                raise ConfigError(f"{path}: the colour of the material {name!r} must be 4 finite numbers.")


def _check_shapes(path: Path, link: Element) -> None:
    """See that what is visible of a link can be drawn, and find its meshes."""
    for visual in link.findall("visual"):
        read = _reader(path, f"a shape in the link {link.get('name')!r}")
        for part in ("xyz", "rpy"):
            read("origin", part, visual, (0.0, 0.0, 0.0))
        for shape in visual.iterfind("geometry/*"):
            if shape.tag not in _SIZES:
                raise ConfigError(
                    f"{path}: the link {link.get('name')!r} has a shape {shape.tag!r}, which URDF has not."
                )
            within = _reader(path, f"a {shape.tag} in the link {link.get('name')!r}")
            for attribute, count in _SIZES[shape.tag].items():
                within("", attribute, shape, (1.0,) * count)
            if shape.tag == "mesh":
                shape.set("filename", _mesh(path, shape.get("filename", "")))


def _finite(text: str) -> tuple[float, ...]:
    """The numbers of a text; none where it has anything else, or one that is not finite."""
    try:
        found = tuple(float(word) for word in text.split())
    except ValueError:
        return ()
    return found if all(math.isfinite(value) for value in found) else ()


def _reader(path: Path, whose: str) -> _Read:
    """Read finite numbers of an attribute of a part of an element, or of itself; what is not there is as given."""

    def read(tag: str, attribute: str, element: Element, other: tuple[float, ...]) -> tuple[float, ...]:
        part = element.find(tag) if tag else element
        text = None if part is None else part.get(attribute)
        if text is None:
            return other
        found = _finite(text)
        if len(found) != len(other):
            how = "a finite number" if len(other) == 1 else f"{len(other)} finite numbers"
            raise ConfigError(f"{path}: {f'{tag} {attribute}'.strip()} of {whose} must be {how}, not {text[:60]!r}.")
        return found

    return read


def _turned(angles: Sequence[float]) -> Array:
    roll, pitch, yaw = angles
    found: Array = about_z(yaw) @ about_y(pitch) @ about_x(roll)
    return found


def _base(path: Path, links: Sequence[str], hinges: Sequence[Hinge]) -> str:
    """The one link that nothing moves, having seen that all hang on it."""
    moved = [hinge.child for hinge in hinges]
    if twice := next((link for link in moved if moved.count(link) > 1), None):
        raise ConfigError(f"{path}: the link {twice!r} is the child of two joints.")
    free = [link for link in links if link not in set(moved)]
    if len(free) != 1:
        said = " and ".join(repr(link) for link in free[:2]) or "none"
        raise ConfigError(f"{path}: exactly one link must be no joint's child, the base; here it is {said}.")
    reached, level = {free[0]}, {free[0]}
    while level:
        level = {hinge.child for hinge in hinges if hinge.parent in level}
        reached |= level
    if lost := sorted(set(links) - reached):
        raise ConfigError(f"{path}: the link {lost[0]!r} does not hang on the base {free[0]!r}.")
    return free[0]


def _mesh(path: Path, name: str) -> str:
    """A mesh's absolute path. It lies within the description's own tree, or, if its name says so, in pybullet's data.

    A description from elsewhere is not to have any file of this disk read as a mesh, by us or by pybullet.
    """
    tree = _tree(path)
    if name.startswith(OF_PYBULLET):
        tree = Path(str(import_module("pybullet_data").getDataPath()))
        found = tree / name.removeprefix(OF_PYBULLET)
    elif name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        homes = [folder for folder in path.absolute().parents if folder.name == package]
        if not homes:
            raise ConfigError(f"{path}: the mesh {name!r} is missing; no folder above this file is called {package!r}.")
        found = next((home / rest for home in homes if exists(home / rest)), homes[0] / rest)
    else:
        found = path.absolute().parent / name.removeprefix("file://")
    if not exists(found):
        where = "" if "://" in name else "; it must be in this file's folder"
        raise ConfigError(f"{path}: the mesh {name!r} is missing{where}.")
    if not found.resolve().is_relative_to(tree.resolve()):
        raise ConfigError(
            f"{path}: the mesh {name!r} must lie in {tree}, the folder of this robot (or of its package.xml)."
        )
    return str(found)


def _tree(path: Path) -> Path:
    """The folder that a description's files lie in: that of the ROS package that it is of, or its own."""
    own = path.absolute().parent
    return next((folder for folder in (own, *own.parents) if (folder / "package.xml").is_file()), own)


def _of_mesh(link: Element) -> list[Element]:
    return [one for one in link.findall("collision") if one.find("geometry/mesh") is not None]


def _drum(middle: Sequence[float], radius: float) -> Element:
    place = f"{middle[0]} {middle[1]} {middle[2] + 0.2}"
    return ElementTree.fromstring(
        f'<collision><origin xyz="{place}" rpy="0 0 0"/><geometry><cylinder radius="{radius}" length="0.36"/>'
        "</geometry></collision>"
    )


def _stand(base: str, place: Array) -> Element:
    joint = ElementTree.Element("joint", {"name": FLOOR, "type": "fixed"})
    ElementTree.SubElement(joint, "parent", {"link": FLOOR})
    ElementTree.SubElement(joint, "child", {"link": base})
    ElementTree.SubElement(joint, "origin", {"xyz": " ".join(map(repr, place.tolist())), "rpy": "0 0 0"})
    return joint
