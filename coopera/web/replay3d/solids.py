"""What is shown in 3D, as coloured triangles: the home, its things, the robot's links, the person's parts.

Lengths are metres, z is up. What stands fast is one mesh in the world's frame; all else is in a frame of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import trimesh
from numpy.typing import NDArray

from coopera.core.people import Persona
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.catalogue import catalogue, parts_of
from coopera.simulation.homes.floorplan import WALL_THICKNESS
from coopera.simulation.homes.meshes import part_file
from coopera.simulation.homes.scene import Scene, SceneObject, rgb_of
from coopera.simulation.people.appearance import Outfit, appearance_of
from coopera.simulation.people.skin import Skin, skinned
from coopera.simulation.people.weights import PARTS
from coopera.simulation.shapes.kit import Part
from coopera.simulation.shapes.rotations import matrix
from coopera.simulation.sight.engine import load_urdf, pybullet

Mesh: TypeAlias = trimesh.Trimesh
Colour = Sequence[float]
WALLS = 1.15
"""Height of the walls: low, so that one looks in."""
_FLOOR, _PAINT = (0.7, 0.66, 0.6), (0.93, 0.92, 0.9)
_SIDES = 16  # of what is round
_SHARE = 0.12  # of a part in a face that it shows: neighbours overlap, so that a bent limb has no gap


def home_mesh(scene: Scene) -> Mesh:
    """Floors, walls and furniture."""
    made: list[Mesh] = []
    for room in scene.rooms:
        kind = catalogue().rooms.get(room.kind)
        for b in room.rectangles():
            size = (b.x1 - b.x0, b.y1 - b.y0, 0.05)
            made.append(
                _box(size, ((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, -0.03), rgb_of(kind.floor) if kind else _FLOOR)
            )
    for wall in scene.walls():
        x, y, half_x, half_y, yaw = wall.block
        size = (max(2 * half_x, WALL_THICKNESS), max(2 * half_y, WALL_THICKNESS), WALLS)
        made.append(_placed(_box(size, (0.0, 0.0, 0.0), _PAINT), (x, y, WALLS / 2), _about_z(yaw)))
    for thing in scene.fixed:
        made.append(_placed(thing_mesh(scene, thing), thing.position, _about_z(thing.yaw)))
    return _together(made)


def thing_mesh(scene: Scene, thing: SceneObject) -> Mesh:
    """One object in its own frame."""
    if thing.mesh and scene.meshes is not None:
        found = [_coloured(_read(part_file(scene.meshes, part)), rgb_of(part.colour)) for part in thing.mesh]
        return _together(found)
    return _together([_of_part(part) for part in parts_of(thing.cls, thing.size, thing.rgb)])


def robot_links(body: RobotBody) -> dict[int, Mesh]:
    """Each of a robot's links that can be seen, by pybullet's number of it (-1 is the base), in the link's frame."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        loaded = load_urdf(body.urdf, client)
        links: dict[int, list[Mesh]] = {}
        for _, link, kind, size, file, place, turn, colour, *_ in pybullet.getVisualShapeData(
            loaded, physicsClientId=client
        ):
            mesh = _of_shape(kind, size, file)
            links.setdefault(link, []).append(_placed(_coloured(mesh, colour[:3]), place, matrix(turn)))
        return {link: _together(meshes) for link, meshes in links.items()}
    finally:
        pybullet.disconnect(client)


def person_skin(person: Persona, outfit: Outfit = "day") -> Skin:
    """The skin of a person as the profile describes them, and their file says."""
    return skinned(appearance_of(person.profile, person.id, person.appearance), outfit)


def person_parts(skin: Skin) -> Iterator[tuple[int, Mesh]]:
    """The skin in one piece for each part of the body that carries some of it, by the number in `PARTS`, at rest."""
    share = np.zeros((len(skin.vertices), len(PARTS)), dtype=np.float32)
    np.put_along_axis(share, skin.parts.astype(np.int64), skin.weights, axis=1)
    for number in range(len(PARTS)):
        faces = skin.faces[(share[skin.faces, number] > _SHARE).any(axis=1)]
        if len(faces):
            used, faces = np.unique(faces, return_inverse=True)
            yield number, _mesh(skin.vertices[used], faces.reshape(-1, 3), skin.colours[used], skin.normals[used])


def _together(meshes: Sequence[Mesh]) -> Mesh:
    joined: Any = trimesh.util.concatenate(list(meshes))
    made: Mesh = joined
    return made


def _of_part(part: Part) -> Mesh:
    if part.kind == "box":
        mesh = trimesh.creation.box(extents=[2 * one for one in part.half])
    elif part.kind == "sphere":
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=part.radius)
    elif part.kind == "cylinder":
        mesh = trimesh.creation.cylinder(radius=part.radius, height=part.length, sections=_SIDES)
    else:
        mesh = trimesh.creation.capsule(radius=part.radius, height=part.length, count=[_SIDES, 8])
        mesh.apply_translation((0, 0, -mesh.bounds.mean(axis=0)[2]))
    return _placed(_coloured(mesh, part.rgba[:3]), part.position, matrix(part.orientation))


def _of_shape(kind: int, size: Sequence[float], file: bytes) -> Mesh:
    """A visual shape as pybullet tells of it."""
    mesh: Any
    if kind == pybullet.GEOM_BOX:
        mesh = trimesh.creation.box(extents=list(size))
    elif kind == pybullet.GEOM_SPHERE:
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=size[0])
    elif kind == pybullet.GEOM_CYLINDER:
        mesh = trimesh.creation.cylinder(radius=size[1], height=size[0], sections=_SIDES)
    elif kind == pybullet.GEOM_CAPSULE:
        mesh = trimesh.creation.capsule(radius=size[1], height=size[0], count=[_SIDES, 8])
        mesh.apply_translation((0, 0, -mesh.bounds.mean(axis=0)[2]))
    else:
        mesh = _read(Path(file.decode()))
        mesh.apply_scale(list(size))
    made: Mesh = mesh
    return made


def _read(path: Path) -> Mesh:
    loaded: Any = trimesh.load(path, force="mesh", process=False)
    return Mesh(loaded.vertices, loaded.faces, process=False)


def _box(size: Sequence[float], at: Sequence[float], colour: Colour) -> Mesh:
    mesh = _coloured(trimesh.creation.box(extents=size), colour)
    mesh.apply_translation(at)
    return mesh


def _coloured(mesh: Mesh, colour: Colour) -> Mesh:
    """A mesh in one colour, with an edge wherever it turns sharply."""
    mesh = trimesh.graph.smooth_shade(mesh, angle=0.6) if len(mesh.faces) > 12 else _faceted(mesh)
    return _mesh(mesh.vertices, mesh.faces, np.tile(colour, (len(mesh.vertices), 1)), mesh.vertex_normals)


def _faceted(mesh: Mesh) -> Mesh:
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    return Mesh(corners, np.arange(len(corners)).reshape(-1, 3), process=False)


def _mesh(vertices: Any, faces: Any, colours: Any, normals: Any) -> Mesh:
    paint = np.column_stack([np.asarray(colours), np.ones(len(colours))])
    return Mesh(vertices, faces, vertex_normals=normals, vertex_colors=(255 * paint).astype(np.uint8), process=False)


def _placed(mesh: Mesh, place: Sequence[float], turn: NDArray[np.float64]) -> Mesh:
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = turn, place
    mesh.apply_transform(frame)
    return mesh


def _about_z(yaw: float) -> NDArray[np.float64]:
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
