"""The knowledge of each class of thing: its size, its colours, its usual places and its uses.

The knowledge itself is in catalogue.yaml, for a user to read and edit. A class outside it is an unknown thing: a
box with a flat top and a letter on it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, NamedTuple, TypeAlias

import yaml
from pydantic import Field, ValidationError, model_validator

from coopera.core.errors import ConfigError
from coopera.core.household import plain
from coopera.core.lazy import made_once
from coopera.core.people import Frozen
from coopera.simulation.homes.categories import DYNAMIC, STATIC
from coopera.simulation.homes.measured import Resting
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.chores import CHORE_THINGS
from coopera.simulation.shapes.fixtures import FIXTURES
from coopera.simulation.shapes.furniture import FURNITURE
from coopera.simulation.shapes.household import HOUSEHOLD_THINGS
from coopera.simulation.shapes.kit import Colour, Kit, Part, Recipe, Size
from coopera.simulation.shapes.kitchen import KITCHEN_THINGS
from coopera.simulation.shapes.leisure import LEISURE_THINGS
from coopera.simulation.shapes.lettering import labelled_box
from coopera.simulation.shapes.pantry import PANTRY_THINGS
from coopera.simulation.shapes.personal import PERSONAL_THINGS
from coopera.simulation.shapes.staging import STAGED
from coopera.simulation.shapes.workshop import WORKSHOP_THINGS

FILE = Path(__file__).parent / "catalogue.yaml"
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where PyYAML has its C part
RECIPES: dict[str, Recipe] = {**FURNITURE, **FIXTURES, **KITCHEN_THINGS, **LEISURE_THINGS, **HOUSEHOLD_THINGS}
SHAPES: dict[str, Recipe] = {**RECIPES, **PANTRY_THINGS, **WORKSHOP_THINGS, **PERSONAL_THINGS, **CHORE_THINGS, **STAGED}
"""All recipes: those of the classes, and those of what comes out of the magic box."""
FLAT = 0.05
"""Fixed things lower than this (rugs) are walked over."""
_OPAQUE = 0.99
STANDS = ("wall", "outer", "centre", "floor")
RELATIONS = ("around", "front", "beside", "opposite", "on")

Metres = Annotated[float, Field(gt=0, le=5)]
Row: TypeAlias = tuple[float, float, float, float, float, float]
"""A rectangle for things, as catalogue.yaml writes it: see its head."""
Hex = Annotated[str, Field(pattern=r"^#[0-9a-f]{6}$")]


class FixedClass(Frozen):
    """A class of furniture; the fields are explained at the top of catalogue.yaml."""

    category: str
    size: tuple[Metres, Metres, Metres]
    colours: list[Hex] = Field(min_length=1)
    rooms: list[str] = Field(min_length=1)
    stands: str
    surfaces: list[Row] = Field(min_length=1)
    inside: list[Row] = []
    seat: float | None = Field(None, gt=0, le=1)
    lie: float | None = Field(None, gt=0, le=1)

    @model_validator(mode="after")
    def _stands_somewhere(self) -> FixedClass:
        relation, _, other = self.stands.partition(":")
        if not (self.stands in STANDS or (relation in RELATIONS and other)):
            raise ValueError(f"stands must be one of {STANDS} or <{'|'.join(RELATIONS)}>:<class>, not {self.stands!r}")
        return self


class MovableClass(Frozen):
    """A class of things that are carried about; `ycb` is the object of the YCB set that it stands for."""

    category: str
    size: tuple[Metres, Metres, Metres]
    colours: list[Hex] = Field(min_length=1)
    put: list[str] = Field(min_length=1)
    inside: list[Row] = []
    ycb: str | None = None


class RoomKind(Frozen):
    """How a kind of room is built: area in square metres, colours, furniture by need."""

    area: float = Field(gt=2)
    floor: Hex
    wall: Hex
    furniture: list[str]


class Catalogue(Frozen):
    """All classes and kinds of rooms."""

    fixed: dict[str, FixedClass]
    movable: dict[str, MovableClass]
    rooms: dict[str, RoomKind]

    @model_validator(mode="after")
    def _refers_to_itself_only(self) -> Catalogue:
        for cls, kind in self.fixed.items():
            other = kind.stands.partition(":")[2]
            if other and other not in self.fixed:
                raise ValueError(f"fixed.{cls}.stands names the unknown class {other!r}")
            unknown = sorted(set(kind.rooms) - set(self.rooms))
            if unknown:
                raise ValueError(f"fixed.{cls}.rooms names the unknown room {unknown[0]!r}")
            if kind.category not in STATIC:
                raise ValueError(f"fixed.{cls}.category must be one of {', '.join(STATIC)}, not {kind.category!r}")
        for cls, thing in self.movable.items():
            if thing.category not in DYNAMIC:
                raise ValueError(f"movable.{cls}.category must be one of {', '.join(DYNAMIC)}, not {thing.category!r}")
            strange = sorted(set(thing.put) - set(self.fixed) - {"floor"})
            if strange:
                raise ValueError(f"movable.{cls}.put names the unknown class {strange[0]!r}")
        for name, room in self.rooms.items():
            missing = sorted(set(room.furniture) - set(self.fixed))
            if missing:
                raise ValueError(f"rooms.{name}.furniture names the unknown class {missing[0]!r}")
        return self

    def category(self, cls: str) -> str:
        """Super-category of a class; an unknown class is its own."""
        known = self.fixed.get(cls) or self.movable.get(cls)
        return known.category if known else plain(cls)


class Surface(NamedTuple):
    """A place for things on or in an object, in that object's frame: a rectangle at height z above its base.

    `clear` is the free height above it, in metres.
    """

    z: float
    x0: float
    x1: float
    y0: float
    y1: float
    clear: float


class Solid(NamedTuple):
    """A solid part of furniture, as the upright box around it in the furniture's frame: its middle and half extents."""

    middle: tuple[float, float, float]
    half: tuple[float, float, float]
    opaque: bool


class Rest(NamedTuple):
    """Where a body rests: seat point (or middle of the lying place) in the world, and the heading it faces."""

    x: float
    y: float
    z: float
    heading: float


@made_once()
def catalogue() -> Catalogue:
    """Return the shipped catalogue.

    Raises:
        ConfigError: If catalogue.yaml was edited into something unusable; names the field.
    """
    return read_catalogue(FILE)


def read_catalogue(path: Path) -> Catalogue:
    """Read a catalogue file.

    Raises:
        ConfigError: If it cannot be used; names file, field and what was expected.
    """
    try:
        return Catalogue.model_validate(yaml.load(path.read_text(encoding="utf-8"), _Loader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as err:
        raise ConfigError(f"The catalogue {path} cannot be read: {err}.") from err
    except ValidationError as err:
        first = err.errors()[0]
        field = ".".join(str(part) for part in first["loc"]) or "the whole file"
        raise ConfigError(f"The catalogue {path}, field {field}: {first['msg']}.") from err


def surfaces(thing: SceneObject) -> list[Surface]:
    """Places where things are put on a fixed object, the usual one first, as measured on its mesh where it has one.

    An unknown class without a mesh has its top.
    """
    if thing.measured is not None:
        return [Surface(*row) for row in thing.measured.surfaces]
    known = catalogue().fixed.get(thing.cls)
    return _in_metres(known.surfaces if known else [(1.0, -0.48, 0.48, -0.48, 0.48, 9.0)], thing.size)


def interiors(thing: SceneObject) -> list[Surface]:
    """Places where things are put within furniture or a thing, the usual one first; empty where nothing is."""
    if thing.measured is not None:
        return [Surface(*row) for row in thing.measured.inside]
    known = catalogue().fixed.get(thing.cls) or catalogue().movable.get(thing.cls)
    return _in_metres(known.inside if known else [], thing.size)


def _in_metres(rows: list[Row], size: Size) -> list[Surface]:
    w, d, h = size
    return [Surface(z * h, x0 * w, x1 * w, y0 * d, y1 * d, clear) for z, x0, x1, y0, y1, clear in rows]


def seat(thing: SceneObject) -> Rest | None:
    """Where one sits on a thing, facing its front or away from its back; None where one does not sit."""
    if thing.measured is not None:
        return _rest(thing, thing.measured.seat)
    known = catalogue().fixed.get(thing.cls)
    if known is None or known.seat is None:
        return None
    first = known.surfaces[0]
    depth = thing.size[1]
    y = depth * 0.15 if thing.cls in ("toilet", "bathtub") else depth * (first[3] + first[4]) / 2
    if thing.cls == "bed":
        y = depth * 0.36
    x, y_world, z = thing.to_world(0.0, y, known.seat * thing.size[2])
    return Rest(x, y_world, z, thing.facing)


def lying_place(thing: SceneObject) -> Rest | None:
    """Where one lies on a thing: middle of the body, the head towards the back; None where one does not lie.

    The heading is the direction from head to feet.
    """
    if thing.measured is not None:
        return _rest(thing, thing.measured.lie)
    known = catalogue().fixed.get(thing.cls)
    if known is None or known.lie is None:
        return None
    x, y, z = thing.to_world(0.0, 0.0, known.lie * thing.size[2])
    along_width = thing.size[0] > thing.size[1]
    return Rest(x, y, z, thing.yaw if along_width else thing.facing)


def _rest(thing: SceneObject, place: Resting | None) -> Rest | None:
    return None if place is None else Rest(*thing.to_world(place.x, place.y, place.z), thing.yaw + place.turn)


def solids(thing: SceneObject) -> list[Solid]:
    """Where furniture is solid: as measured on its mesh, else the parts that it is drawn with."""
    if thing.measured is None:
        parts = parts_of(thing.cls, thing.size, thing.rgb)
        return [Solid(part.position, part.around, part.rgba[3] > _OPAQUE) for part in parts]
    return [
        Solid(((x0 + x1) / 2, (y0 + y1) / 2, (low + high) / 2), ((x1 - x0) / 2, (y1 - y0) / 2, (high - low) / 2), True)
        for x0, y0, x1, y1, low, high in thing.measured.solids
    ]


def blocks(thing: SceneObject) -> bool:
    """Whether one must walk around a fixed thing: rugs are walked over, and what stands high is no obstacle."""
    return thing.fixed and thing.position[2] < 1.0 and thing.size[2] > FLAT


def parts_of(cls: str, size: Size, colour: Colour) -> list[Part]:
    """Return the primitives that show a thing of this class and size; a labelled box where it is unknown."""
    kit = Kit(size, colour)
    recipe = SHAPES.get(cls)
    if recipe is not None:
        recipe(kit)
    else:
        labelled_box(kit, cls)
    return kit.parts
