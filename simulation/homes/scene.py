"""A home as plain data: rooms, doors and objects, in a JSON file that a person can edit.

Units are metres and radians, Z is up, yaw turns about Z. In an object's own frame the origin is the centre
of its base. Its width is along x, its depth along y. Its front looks towards +y, so at yaw 0 it faces +y.
Walls are not written down: they stand on the edges of the rooms, with a gap at each door.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import load_json, read_text
from coopera.core.household import ObjectMap, SceneId
from coopera.core.notebook.cards import card
from coopera.core.people import Frozen
from coopera.simulation.homes.floorplan import PARALLEL, TOUCH, Bounds, Line, Point, Wall, cut, merge, wall_on
from coopera.simulation.homes.measured import Measured
from coopera.simulation.homes.plan_card import Area, Footprint, floor_plan
from coopera.simulation.homes.rooms import Place
from coopera.simulation.homes.rooms import Room as Room

SHIPPED = Path(__file__).parents[1] / "scenes"
SCHEMA_VERSION = 1
DOOR_WIDTH = 0.95
MOST_ROOMS, MOST_THINGS = 500, 10_000

ID = r"^[a-z0-9][a-z0-9_-]{0,63}$"
"""What a home may be called."""
ObjectKind: TypeAlias = Literal["fixed", "movable"]
Length = Annotated[float, Field(gt=0, le=20)]
Label = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$", max_length=80)]


class Doorway(Frozen):
    """An opening in the wall that two rooms share; (x, y) is its middle."""

    between: tuple[str, str]
    x: Place
    y: Place
    width: float = Field(DOOR_WIDTH, ge=0.7, le=3.0)


class MeshPart(Frozen):
    """A mesh of one colour: an OBJ file in the folder <home>.meshes/ beside the home's file, in the object's frame."""

    file: str = Field(pattern=r"^[a-z0-9_-]{1,64}\.obj$")
    colour: str = Field(pattern=r"^#[0-9a-f]{6}$")


class SceneObject(Frozen):
    """One object of the home, in its initial place.

    `position` is the centre of the object's base. `size` is (width, depth, height) in the object's own frame.
    `on` names the fixed object under a movable one. A movable object without `on` stands on the floor.
    `mesh` replaces our own shapes in pictures. `measured` is what that mesh says about its use, and replaces what the
    catalogue says of the class. For everything else the object is the box of its size.
    """

    id: int = Field(ge=0)
    name: Label
    cls: Label
    category: str = Field(min_length=1, max_length=60)
    fixed: bool
    room: str
    position: tuple[Place, Place, Place]
    yaw: Annotated[float, Field(ge=-100, le=100)] = 0.0
    size: tuple[Length, Length, Length]
    colour: str = Field(pattern=r"^#[0-9a-f]{6}$")
    on: str | None = None
    mesh: list[MeshPart] = Field([], max_length=16)
    measured: Measured | None = None

    @property
    def xy(self) -> Point:
        """The base centre on the floor plan."""
        return self.position[0], self.position[1]

    @property
    def top(self) -> float:
        """Height of the highest point above the floor."""
        return self.position[2] + self.size[2]

    @property
    def facing(self) -> float:
        """Direction of the front as a heading (0 looks along +x)."""
        return self.yaw + math.pi / 2

    @property
    def rgb(self) -> tuple[float, float, float]:
        """The main colour, each channel in [0, 1]."""
        return rgb_of(self.colour)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy the object with some fields changed; what was worked out of the old ones is not carried over."""
        copied = super().model_copy(update=update, deep=deep)
        copied.__dict__.pop("bounds", None)
        return copied

    @cached_property
    def bounds(self) -> Bounds:
        """The axis-aligned rectangle around the turned footprint."""
        cos, sin = abs(math.cos(self.yaw)), abs(math.sin(self.yaw))
        half_x = (self.size[0] * cos + self.size[1] * sin) / 2
        half_y = (self.size[0] * sin + self.size[1] * cos) / 2
        x, y = self.xy
        return Bounds(x - half_x, y - half_y, x + half_x, y + half_y)

    def to_world(self, x: float, y: float, z: float = 0.0) -> tuple[float, float, float]:
        """Turn a point of the object's frame into world coordinates."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return self.position[0] + x * cos - y * sin, self.position[1] + x * sin + y * cos, self.position[2] + z

    def to_local(self, x: float, y: float) -> Point:
        """Turn a point of the floor plan into the object's frame."""
        dx, dy = x - self.position[0], y - self.position[1]
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return dx * cos + dy * sin, dy * cos - dx * sin


def rgb_of(colour: str) -> tuple[float, float, float]:
    """Turn "#rrggbb" into channels in [0, 1]."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue


class Scene(Frozen):
    """A whole home. Rooms do not overlap; ids and names are unique over all objects."""

    version: Literal[1] = 1
    id: SceneId = Field(pattern=ID)
    seed: int | None = None
    rooms: list[Room] = Field(min_length=1, max_length=MOST_ROOMS)
    doors: list[Doorway] = Field([], max_length=MOST_THINGS)
    objects: list[SceneObject] = Field([], max_length=MOST_THINGS)
    stage: list[Wall] | None = Field(None, max_length=MOST_THINGS)
    """Where the walls of an imported home stand, which need not be on the edges of its rooms."""
    _meshes: Path | None = PrivateAttr(None)

    @property
    def meshes(self) -> Path | None:
        """The folder of its objects' meshes; None where the home was not read from a file, or has none."""
        return self._meshes

    @model_validator(mode="after")
    def _is_consistent(self) -> Scene:
        for what, values in (
            ("room name", [room.name for room in self.rooms]),
            ("object name", [thing.name for thing in self.objects]),
            ("object id", [thing.id for thing in self.objects]),
        ):
            twice = [value for value, count in Counter(values).items() if count > 1]
            if twice:
                raise ValueError(f"each {what} must be unique, but {twice[0]!r} is used more than once")
        rooms = {room.name for room in self.rooms}
        for door in self.doors:
            if door.between[0] == door.between[1] or not rooms.issuperset(door.between):
                raise ValueError(f"a door must join two of this home's rooms, not {' and '.join(door.between)!r}")
        carriers = {thing.name for thing in self.objects if thing.fixed}
        for thing in self.objects:
            if thing.room not in rooms:
                raise ValueError(f"object {thing.name!r}: room must be one of {sorted(rooms)}, not {thing.room!r}")
            if thing.fixed and thing.on is not None:
                raise ValueError(f"object {thing.name!r}: only a movable object may be `on` another")
            if thing.on is not None and thing.on not in carriers:
                raise ValueError(f"object {thing.name!r}: `on` must name a fixed object, not {thing.on!r}")
        return self

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy the home with some fields changed; what was worked out of the old ones is not carried over."""
        copied = super().model_copy(update=update, deep=deep)
        for derived in ("_by_name", "fixed", "movable"):
            copied.__dict__.pop(derived, None)
        return copied

    @cached_property
    def _by_name(self) -> dict[str, SceneObject]:
        return {thing.name: thing for thing in self.objects}

    @cached_property
    def fixed(self) -> tuple[SceneObject, ...]:
        """The furniture, by name."""
        return tuple(sorted((thing for thing in self.objects if thing.fixed), key=lambda thing: thing.name))

    @cached_property
    def movable(self) -> tuple[SceneObject, ...]:
        """The movable things, by name."""
        return tuple(sorted((thing for thing in self.objects if not thing.fixed), key=lambda thing: thing.name))

    @property
    def bounds(self) -> Bounds:
        """The rectangle around all rooms."""
        edges = [room.bounds for room in self.rooms]
        return Bounds(
            min(edge.x0 for edge in edges),
            min(edge.y0 for edge in edges),
            max(edge.x1 for edge in edges),
            max(edge.y1 for edge in edges),
        )

    def object(self, name: str) -> SceneObject | None:
        """The object of that name, or None."""
        return self._by_name.get(name)

    def room(self, name: str) -> Room | None:
        """The room of that name, or None."""
        return next((room for room in self.rooms if room.name == name), None)

    def room_at(self, x: float, y: float) -> Room:
        """The room that holds a point, or else the nearest one (ties: the first listed)."""
        inside = next((room for room in self.rooms if room.contains(x, y)), None)
        return inside or min(self.rooms, key=lambda room: room.distance(x, y))

    def object_map(self, kind: ObjectKind) -> ObjectMap:
        """{name: (id, room)} of the initial places, sorted by name."""
        return {thing.name: (thing.id, thing.room) for thing in (self.fixed if kind == "fixed" else self.movable)}

    def walls(self) -> list[Wall]:
        """Pieces of wall along the rooms' edges, doors left open; a shared edge is one wall. Or those of the stage.

        Sorted by axis, place and start, so that the order does not depend on that of the rooms.
        """
        if self.stage is not None:
            return sorted(self.stage)
        lines: dict[Line, list[tuple[float, float]]] = {}
        for wall in (edge.wall for room in self.rooms for edge in room.edges):
            line = wall.line
            lines.setdefault(line._replace(at=round(line.at, 2)), []).append((wall.start, wall.end))
        walls: list[Wall] = []
        for line, spans in sorted(lines.items()):
            gaps = [_gap(door, line) for door in self.doors if self._stands_on(door, line)]
            walls += [wall_on(line, start, end) for start, end in cut(merge(spans), gaps)]
        return walls

    def _repr_html_(self) -> str:
        """The home as a floor plan in a notebook."""
        about = f"{len(self.rooms)} rooms, {len(self.fixed)} pieces of furniture, {len(self.movable)} movable things"
        drawn = [
            Footprint(f"{one.name}, {one.room}", *one.xy, *one.size[:2], one.yaw, one.colour)
            for one in sorted(self.objects, key=lambda one: one.top)
        ]
        rooms = [Area(one.name, one.outline, one.centre) for one in self.rooms]
        return card(self.id, about, floor_plan(rooms, self.walls(), drawn))

    def _stands_on(self, door: Doorway, line: Line) -> bool:
        """Whether a door stands on a line that has a side of both its rooms."""
        return line.aside(door.x, door.y) <= 2 * TOUCH and all(
            any(_beside(door, line, edge.wall) for edge in room.edges)
            for room in map(self.room, door.between)
            if room is not None
        )


def _beside(door: Doorway, line: Line, side: Wall) -> bool:
    """Whether one side of a room lies on a line and goes past a door."""
    along = door.x if line.axis == "x" else door.y
    if side.axis != line.axis or not side.start <= along <= side.end:
        return False
    own = side.line
    return abs(own.slope - line.slope) < PARALLEL and abs(own.across(along) - line.across(along)) <= 2 * TOUCH


def _gap(door: Doorway, line: Line) -> tuple[float, float]:
    middle, half = door.x if line.axis == "x" else door.y, door.width / 2 / math.hypot(1.0, line.slope)
    return middle - half, middle + half


def list_scenes(folders: Sequence[Path] = ()) -> list[str]:
    """Ids of the homes that ship with coopera and of those in `folders` (imported ones), sorted."""
    return sorted(_scene_files(folders))


def load_scene(id_or_path: str | Path, folders: Sequence[Path] = ()) -> Scene:
    """Read a home by its id (shipped, or a file <id>.json in `folders`) or from a JSON file.

    Raises:
        ConfigError: If there is no such home, or its file cannot be used; names the file and the field.
    """
    known = _scene_files(folders)
    given = str(id_or_path)
    path = known.get(given, Path(given))
    if given not in known and not (path.suffix == ".json" or _is_file(path)):
        raise ConfigError(f"There is no scene {given!r}; known are {', '.join(sorted(known)) or 'none'}.")
    scene = parse_scene(read_text(path, "scene file"), str(path))
    if given in known and scene.id != given:
        raise ConfigError(f"The scene file {path}, field id: must be {given!r} as the file's name, not {scene.id!r}.")
    return _with_meshes(scene, path)


def _with_meshes(scene: Scene, path: Path) -> Scene:
    """Say where the meshes of a home lie that was read from a file."""
    folder = path.with_suffix(".meshes")
    for number, thing in enumerate(scene.objects):
        for part in thing.mesh:
            if not (folder / part.file).is_file():
                raise ConfigError(
                    f"The scene file {path}, field objects.{number}.mesh: there is no file {folder / part.file}."
                )
            scene._meshes = folder
    return scene


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # such as a name that is too long
        return False


def parse_scene(text: str, source: str) -> Scene:
    """Read a home from JSON text; `source` names it in errors.

    Raises:
        ConfigError: If the text is no JSON or no home; names the field and what was expected.
    """
    try:
        return Scene.model_validate(load_json(text))
    except ValidationError as err:
        first = err.errors()[0]
        field = ".".join(str(part) for part in first["loc"]) or "the whole file"
        raise ConfigError(f"The scene file {source}, field {field}: {first['msg']}.") from err
    except json.JSONDecodeError as err:
        raise ConfigError(f"The scene file {source}, line {err.lineno}, is not valid JSON: {err.msg}.") from err
    except ValueError as err:
        raise ConfigError(f"The scene file {source} is not valid JSON: {err}.") from err


def dump_scene(scene: Scene) -> str:
    """Write a home as JSON text with one room, door or object per line."""
    data = scene.model_dump(mode="json", exclude_defaults=False)
    parts = []
    for key, value in data.items():
        if key == "stage" and value is None:
            continue
        if isinstance(value, list):
            if key in ("rooms", "objects"):
                value = [{name: one for name, one in row.items() if name not in _OFTEN_NONE or one} for row in value]
            elif key == "stage":
                value = [row if row[-1] else row[:-1] for row in value]
            rows = ",\n".join("    " + json.dumps(row, ensure_ascii=False) for row in value)
            parts.append(f'  "{key}": [\n{rows}\n  ]' if value else f'  "{key}": []')
        else:
            parts.append(f'  "{key}": {json.dumps(value)}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


_OFTEN_NONE = ("polygon", "mesh", "measured")


def _scene_files(folders: Sequence[Path]) -> dict[str, Path]:
    return {path.stem: path for folder in (SHIPPED, *folders) for path in sorted(folder.glob("*.json"))}
