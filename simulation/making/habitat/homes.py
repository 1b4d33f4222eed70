"""Import homes of a Habitat data set: of HSSD, and of its general layout, such as ReplicaCAD's.

Boxes, surfaces, insides, seats and beds come from the meshes, for no JSON file has them. Every instance is an object
of its own, however often its template is used. What cannot be taken over, and what is guessed, is reported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from coopera.core.errors import ConfigError
from coopera.core.household import SceneId
from coopera.simulation.homes.categories import DYNAMIC
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.making.habitat.carrying import put_on
from coopera.simulation.making.habitat.files import Folder, Template
from coopera.simulation.making.habitat.names import Guesser, Nearest, carried, class_of, colour_of, slug
from coopera.simulation.making.habitat.poses import Box, box_of
from coopera.simulation.making.habitat.rooms import STOREY, ground_of
from coopera.simulation.making.habitat.schema import Instance
from coopera.simulation.making.habitat.shaping import shaped
from coopera.simulation.making.proof import prove
from coopera.simulation.making.report import HIGHEST, Imported, Report

LONGEST = 20.0


class Recognised(NamedTuple):
    """An instance that is taken over: its place in the file, what it is made from, and its box."""

    number: int
    template: Template
    instance: Instance
    box: Box

    @property
    def what(self) -> str:
        """How the report calls it."""
        return f"object_instances.{self.number} ({self.instance.template_name})"


def import_scene(folder: Folder, id: str, *, skip_missing: bool = False, nearest: Nearest | None = None) -> Imported:
    """Import one scene of a folder.

    Args:
        folder: A folder with a Habitat data set.
        id: Name of the scene, as in <id>.scene_instance.json.
        skip_missing: Report what refers to a missing file, instead of refusing the scene.
        nearest: Knows the words that come nearest to a text in meaning; without it, only known words are.

    Raises:
        ConfigError: If a file is missing or wrong; names file and field.
    """
    report = Report()
    ground = ground_of(folder, id, report)
    found = list(_objects(folder, id, ground.floor, skip_missing, report))
    for number in range(len(folder.scene(id).articulated_object_instances)):
        report.left_out.append(f"articulated_object_instances.{number}: articulated objects are not taken over")
    if not found and not ground.rooms:
        why = f", for all was left out, first of all {report.left_out[0]}" if report.left_out else ""
        raise ConfigError(f"The scene {id!r} of {folder.root} has neither regions nor objects{why}.")
    rooms = ground.rooms or [ground.around([one.box for one in found])]
    scene = Scene(id=SceneId(scene_id(id)), rooms=rooms, objects=[], stage=ground.walls)
    named = _name(scene, found, folder, report, nearest)
    objects, meshes = shaped(named, [(one.template, one.instance) for one in found], report)
    scene = Scene.model_validate(
        scene.model_copy(update={"objects": _carried(scene, objects, found, report)}).model_dump()
    )
    counts = f"{len(scene.rooms)} rooms, {len(scene.fixed)} pieces of furniture, {len(scene.movable)} movable things"
    report.understood.append(f"{id}: {counts}")
    return Imported(scene, report, prove(scene), meshes)


def scene_id(name: str) -> str:
    """The id of an imported home: the scene's name in small letters."""
    return slug(name, "-_") or "home"


def _objects(folder: Folder, id: str, floor: float, skip_missing: bool, report: Report) -> Iterator[Recognised]:
    """The instances that are taken over."""
    for number, instance in enumerate(folder.scene(id).object_instances):
        what = f"object_instances.{number} ({instance.template_name})"
        try:
            template = folder.template(id, number, instance.template_name)
            if template.opening:
                report.left_out.append(f"{what}: a door or window: ways through walls stand open")
                continue
            instance = folder.with_origin(id, instance)
            box = box_of(template, instance)
        except FileNotFoundError as err:
            if not skip_missing:
                raise ConfigError(str(err)) from err
            report.left_out.append(f"{what}: {str(err)}")
            continue
        x, y, z = box.position
        box = box._replace(position=(x, y, round(z - floor, 4)))
        if box.position[2] > HIGHEST:
            report.left_out.append(f"{what}: hangs {box.position[2]:.2f} m above the floor, out of reach")
        elif box.position[2] + box.size[2] < -STOREY / 2:
            report.left_out.append(f"{what}: lies below the floor")
        elif max(box.size) > LONGEST or max(abs(x), abs(y)) > 100:
            report.left_out.append(f"{what}: is larger than {LONGEST:.0f} m, or farther than 100 m away")
        else:
            yield Recognised(number, template, instance, box)


class _Kind(NamedTuple):
    cls: str
    category: str
    fixed: bool
    why: str


def _name(
    scene: Scene, found: list[Recognised], folder: Folder, report: Report, nearest: Nearest | None
) -> list[SceneObject]:
    """Objects with names of their own; ids are the places in the file."""
    guesser = Guesser((one.template.name for one in found), nearest)
    some_move = not all(one.instance.stays for one in found)
    count: Counter[str] = Counter()
    objects: list[SceneObject] = []
    for one in found:
        kind = _said(one) if one.template.row.super_category else _guessed(one, guesser, some_move)
        count[kind.cls] += 1
        name = f"{kind.cls}_{count[kind.cls]}"
        if kind.why:
            report.guessed.append(f"{one.what}: {name}: {kind.why}")
        objects.append(
            SceneObject(
                id=one.number,
                name=name,
                cls=kind.cls,
                category=kind.category[:60],
                fixed=kind.fixed,
                room=scene.room_at(*one.box.position[:2]).name,
                position=one.box.position,
                yaw=one.box.yaw,
                size=one.box.size,
                colour=colour_of(kind.cls, kind.category),
            )
        )
    return objects


def _said(one: Recognised) -> _Kind:
    """What the table of HSSD says."""
    row = one.template.row
    category = row.super_category.replace("_", " ").strip() or "unknown"
    return _Kind(class_of(row), category, not (category in DYNAMIC and not row.support), "")  # PAPER App. B


def _guessed(one: Recognised, guesser: Guesser, some_move: bool) -> _Kind:
    """What its name and size say; where some things of the scene move, those do not of which the file says so."""
    guess = guesser.guess(one.template.name, one.template.label, one.box.size)
    moves = guess.category in DYNAMIC and carried(guess.cls, one.box.size) and not (some_move and one.instance.stays)
    return _Kind(guess.cls, guess.category, not moves, guess.why)


def _carried(scene: Scene, objects: list[SceneObject], found: list[Recognised], report: Report) -> list[SceneObject]:
    """The objects, each movable one on what carries it; what nothing carries stays where it is."""
    carriers = [thing for thing in objects if thing.fixed]
    seen: list[SceneObject] = []
    for thing, one in zip(objects, found, strict=True):
        settled = thing if thing.fixed else put_on(thing, carriers)
        if settled is None:
            report.guessed.append(f"{one.what}: {thing.name}: nothing carries it, so it hangs there and does not move")
            settled = thing.model_copy(update={"fixed": True})
        elif settled.position != thing.position:
            far = max(abs(a - b) for a, b in zip(settled.position, thing.position, strict=True))
            where = f"the {settled.on}" if settled.on else "the floor"
            report.guessed.append(f"{one.what}: {thing.name}: moved by {100 * far:.0f} cm so that it lies on {where}")
        seen.append(settled)
    return seen
