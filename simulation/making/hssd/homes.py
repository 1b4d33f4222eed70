"""Import homes of HSSD (the Habitat Synthetic Scenes Dataset) from a folder in its published layout.

Habitat's frame is Y up with the front towards -Z; ours is Z up with the front towards +Y, so (x, y, z) becomes
(x, -z, y). Boxes come from the glb files, for no JSON file has them. Every instance is an object of its own, however
often its template is used. What cannot be taken over is reported.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.household import SceneId
from coopera.simulation.homes.categories import DYNAMIC
from coopera.simulation.homes.floorplan import Wall
from coopera.simulation.homes.glb import Array, Mesh, read_glb, rotation_matrix
from coopera.simulation.homes.meshes import look_of, simplified
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.making.hssd.files import Folder, Instance, Region, Template
from coopera.simulation.making.hssd.names import class_of, colour_of, slug
from coopera.simulation.making.hssd.walls import walls_of
from coopera.simulation.making.proof import prove

TO_OURS: Array = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From Habitat's frame to ours: z becomes -y, and y becomes z."""
STOREY = 1.0
"""Floors that differ by more than this, in metres, are different storeys."""
HIGHEST = 2.0
"""What hangs higher above the floor is left out: nobody gets there."""
LONGEST = 20.0
THINNEST = 0.0005
_ON = 0.06


class Skipped(NamedTuple):
    """Something that was not taken over: what it is called in the files, and why."""

    what: str
    why: str


class Imported(NamedTuple):
    """A home, what was left out of it, what `prove` says of it, and the files of its meshes by their names."""

    scene: Scene
    skipped: list[Skipped]
    problems: list[str]
    meshes: dict[str, str]


class Box(NamedTuple):
    """An upright box in our frame: centre of its base, yaw, and size in its own frame."""

    position: tuple[float, float, float]
    yaw: float
    size: tuple[float, float, float]


class Recognised(NamedTuple):
    """An instance that is taken over: its place in the file, what it is made from, and its box."""

    number: int
    template: Template
    instance: Instance
    box: Box


def import_scene(folder: Folder, id: str, *, skip_missing: bool = False) -> Imported:
    """Import one scene of a folder.

    Args:
        folder: An HSSD folder.
        id: Name of the scene, as in scenes/<id>.scene_instance.json.
        skip_missing: Report what refers to a missing file, instead of refusing the scene.

    Raises:
        ConfigError: If a file is missing or wrong; names file and field.
    """
    skipped: list[Skipped] = []
    instances = folder.scene(id)
    regions = folder.regions(id, required=not skip_missing)
    floor = _ground_floor(regions)
    rooms = _rooms(regions, floor, skipped)
    found = list(_objects(folder, id, floor, skip_missing, skipped))
    if not rooms:
        rooms = [_room_around([one.box for one in found], id)]
        skipped.append(Skipped("rooms", "there are no regions, so the whole home is one room"))
    skipped += [
        Skipped(f"articulated_object_instances.{i}", "articulated objects are not taken over")
        for i in range(len(instances.articulated_object_instances))
    ]
    scene = Scene(id=SceneId(scene_id(id)), rooms=rooms, objects=[], stage=_stage(folder, id, floor, skipped))
    objects, meshes = _drawn(_name(scene, found), found, skipped)
    scene = Scene.model_validate(scene.model_copy(update={"objects": objects}).model_dump())
    return Imported(scene, skipped, prove(scene), meshes)


def scene_id(name: str) -> str:
    """The id of an imported home: HSSD's name in small letters."""
    return slug(name, "-_") or "home"


def box_of(template: Template, instance: Instance) -> Box:
    """The box of an instance in our frame, of the least size among those that are turned by its yaw."""
    return _upright(template, instance, _corners(template.asset))[0]


def _upright(template: Template, instance: Instance, corners: Array) -> tuple[Box, Array]:
    """The box of an instance around corners of its asset, and these corners in the box's own frame."""
    scale = np.array(instance.scale) * np.array(template.config.scale) * template.config.units_to_meters
    corners = corners @ template.frame.T
    if instance.by_mass:
        given = template.config.com
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2 if given is None else np.array(given)
        corners = corners - middle
    turn = rotation_matrix(instance.rotation)
    points = (corners * scale) @ turn.T @ TO_OURS.T
    ours = TO_OURS @ turn @ TO_OURS.T
    along_x, along_y = ours[:2, 0], ours[:2, 1]
    yaw = (
        math.atan2(along_x[1], along_x[0])
        if np.hypot(*along_x) >= np.hypot(*along_y)
        else math.atan2(-along_y[0], along_y[1])
    )
    cos, sin = math.cos(yaw), math.sin(yaw)
    back = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    own = points @ back.T
    low, high = own.min(axis=0), own.max(axis=0)
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    x, y, z = back.T @ middle + TO_OURS @ np.array(instance.translation)
    w, d, h = (max(float(side), THINNEST) for side in high - low)
    box = Box(
        (round(float(x), 4), round(float(y), 4), round(float(z), 4)),
        round(math.remainder(yaw, math.tau), 6),
        (round(w, 4), round(d, 4), round(h, 4)),
    )
    return box, own - middle


@lru_cache(maxsize=64)
def _mesh(asset: Path) -> Mesh:
    """What an asset looks like, made small before it is turned and scaled for each instance."""
    return simplified(read_glb(asset))


@lru_cache(maxsize=512)
def _corners(asset: Path) -> Array:
    """The corners that can bound a box in any direction: those of the asset, without repetition."""
    return np.unique(read_glb(asset).corners, axis=0)


def _ground_floor(regions: list[Region]) -> float:
    """Height of the storey with most regions (ties: the lowest); 0 without regions."""
    heights = [region.floor for region in regions]
    if not heights:
        return 0.0
    return min(heights, key=lambda height: (-sum(abs(height - other) < STOREY for other in heights), height))


def _rooms(regions: list[Region], floor: float, skipped: list[Skipped]) -> list[Room]:
    """Rectangles around the regions of one storey; small ones first, since a point belongs to the first room."""
    rooms: list[Room] = []
    count: Counter[str] = Counter()
    for region in regions:
        if abs(region.floor - floor) >= STOREY:
            skipped.append(Skipped(region.title, "the region is on another storey"))
            continue
        x0, x1, y0, y1 = region.x0, region.x1, -region.z1, -region.z0
        if min(x1 - x0, y1 - y0) < 0.8:
            skipped.append(Skipped(region.title, "the region is narrower than 0.8 m"))
            continue
        kind = slug(region.title.partition("_")[0] or region.title, " ") or "room"
        kind = kind.strip(" 0123456789") or "room"
        count[kind] += 1
        name = kind if count[kind] == 1 else f"{kind} {count[kind]}"
        rooms.append(Room(name=name, kind=kind, x0=round(x0, 4), y0=round(y0, 4), x1=round(x1, 4), y1=round(y1, 4)))
    return sorted(rooms, key=lambda room: (room.x1 - room.x0) * (room.y1 - room.y0))


def _room_around(boxes: list[Box], id: str) -> Room:
    if not boxes:
        raise ConfigError(f"The HSSD scene {id!r} has neither regions nor objects: there is nothing to import.")
    x, y = np.array([box.position[0] for box in boxes]), np.array([box.position[1] for box in boxes])
    edges = (float(x.min()) - 1.0, float(y.min()) - 1.0, float(x.max()) + 1.0, float(y.max()) + 1.0)
    return Room(name="home", kind="home", x0=edges[0], y0=edges[1], x1=edges[2], y1=edges[3])


def _objects(folder: Folder, id: str, floor: float, skip_missing: bool, skipped: list[Skipped]) -> Iterator[Recognised]:
    """The instances that are taken over."""
    for number, instance in enumerate(folder.scene(id).object_instances):
        what = f"object_instances.{number} ({instance.template_name})"
        try:
            template = folder.template(id, number, instance.template_name)
            if template.opening:
                skipped.append(Skipped(what, "a door or window: ways through walls stand open"))
                continue
            instance = folder.with_origin(id, instance)
            box = box_of(template, instance)
        except FileNotFoundError as err:
            if not skip_missing:
                raise ConfigError(str(err)) from err
            skipped.append(Skipped(what, str(err)))
            continue
        x, y, z = box.position
        box = box._replace(position=(x, y, round(z - floor, 4)))
        if box.position[2] > HIGHEST:
            skipped.append(Skipped(what, f"hangs {box.position[2]:.2f} m above the floor, out of reach"))
        elif box.position[2] + box.size[2] < -STOREY / 2:
            skipped.append(Skipped(what, "lies below the floor"))
        elif max(box.size) > LONGEST or max(abs(x), abs(y)) > 100:
            skipped.append(Skipped(what, f"is larger than {LONGEST:.0f} m, or farther than 100 m away"))
        else:
            yield Recognised(number, template, instance, box)


def _name(scene: Scene, found: list[Recognised]) -> list[SceneObject]:
    """Objects with names of their own and what carries them; ids are the places in HSSD's file."""
    count: Counter[str] = Counter()
    objects: list[SceneObject] = []
    for number, template, _, box in found:
        row = template.row
        category = row.super_category.replace("_", " ").strip() or "unknown"
        cls = class_of(row)
        count[cls] += 1
        objects.append(
            SceneObject(
                id=number,
                name=f"{cls}_{count[cls]}",
                cls=cls,
                category=category[:60],
                fixed=not (category in DYNAMIC and not row.support),  # PAPER App. B
                room=scene.room_at(*box.position[:2]).name,
                position=box.position,
                yaw=box.yaw,
                size=box.size,
                colour=colour_of(cls, category),
            )
        )
    carriers = [thing for thing in objects if thing.fixed]
    return [thing if thing.fixed else _put_on(thing, carriers) for thing in objects]


def _drawn(
    objects: list[SceneObject], found: list[Recognised], skipped: list[Skipped]
) -> tuple[list[SceneObject], dict[str, str]]:
    """The objects with their meshes, and the meshes' files; what has no triangles is drawn from our own shapes."""
    files: dict[str, str] = {}
    seen: list[SceneObject] = []
    for thing, one in zip(objects, found, strict=True):
        mesh = _mesh(one.template.asset)
        look = look_of(mesh._replace(corners=_upright(one.template, one.instance, mesh.corners)[1]), thing.colour)
        files |= look.files
        seen.append(thing.model_copy(update={"mesh": look.parts}))
    without = sum(not thing.mesh for thing in seen)
    if without:
        skipped.append(Skipped("meshes", f"{without} are compressed in a way that is not read; drawn from our shapes"))
    return seen, files


def _put_on(thing: SceneObject, carriers: list[SceneObject]) -> SceneObject:
    """Say what carries a movable thing: what it stands on, or else what it stands in."""
    if thing.position[2] <= _ON:
        return thing
    under = []
    for carrier in carriers:
        x, y = carrier.to_local(*thing.xy)
        over = abs(x) <= carrier.size[0] / 2 and abs(y) <= carrier.size[1] / 2
        if over and carrier.position[2] - _ON <= thing.position[2] <= carrier.top + _ON:
            under.append((abs(carrier.top - thing.position[2]), carrier.id, carrier))
    if not under:
        return thing
    carrier = min(under, key=lambda row: row[:2])[2]
    return thing.model_copy(update={"on": carrier.name, "room": carrier.room})


def _stage(folder: Folder, id: str, floor: float, skipped: list[Skipped]) -> list[Wall]:
    template = folder.stage(id)
    if template is None:
        skipped.append(Skipped("stage_instance", "there is no stage, and so there are no walls"))
        return []
    mesh = read_glb(template.asset)
    walls, slanted = walls_of(mesh._replace(corners=mesh.corners @ template.frame.T @ TO_OURS.T), floor)
    if slanted:
        skipped.append(Skipped("stage_instance", f"{slanted} pieces of wall run neither along x nor along y"))
    return walls
