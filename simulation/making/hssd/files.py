"""The files of an HSSD folder as they are published, each read once and checked."""

from __future__ import annotations

import os
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field, field_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.foreign.tables import read_table
from coopera.simulation.homes.glb import Array
from coopera.simulation.homes.scene import MOST_ROOMS, MOST_THINGS
from coopera.simulation.homes.untrusted import Loose, read_json

Three = tuple[float, float, float]
Positive = Annotated[float, Field(gt=0, le=1e4)]
Length = Annotated[float, Field(ge=-1e4, le=1e4)]
_INSTANCE = ".scene_instance.json"
_OBJECT = ".object_config.json"


class Placed(Loose):
    """What stands somewhere: the template it is made from, and its pose in Habitat's frame."""

    template_name: str
    translation: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    translation_origin: str | None = None

    @field_validator("rotation")
    @classmethod
    def _is_a_rotation(cls, value: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
        if not 1e-6 < sum(part * part for part in value) < 1e12:
            raise ValueError("a rotation is a quaternion [w, x, y, z] of length 1")
        return value

    @property
    def by_mass(self) -> bool:
        """Whether the translation is that of the centre of mass, not of the asset's origin."""
        return (self.translation_origin or "").lower() == "com"


class Instance(Placed):
    """One object of a scene."""

    non_uniform_scale: tuple[Positive, Positive, Positive] | None = None
    uniform_scale: Positive | None = None

    @property
    def scale(self) -> Three:
        """The factor along each axis."""
        if self.non_uniform_scale is not None:
            return self.non_uniform_scale
        return (self.uniform_scale or 1.0,) * 3


class SceneInstance(Loose):
    """scenes/<id>.scene_instance.json."""

    translation_origin: str | None = None
    stage_instance: Placed | None = None
    object_instances: list[Instance] = Field([], max_length=MOST_THINGS)
    articulated_object_instances: list[Any] = []


class AssetConfig(Loose):
    """objects/…/<template>.object_config.json, and stages/<id>.stage_config.json."""

    render_asset: str | None = None
    collision_asset: str | None = None
    up: Three = (0.0, 1.0, 0.0)
    front: Three = (0.0, 0.0, -1.0)
    com: Three | None = Field(None, alias="COM")
    scale: tuple[Positive, Positive, Positive] = (1.0, 1.0, 1.0)
    units_to_meters: Positive = 1.0


class Region(Loose):
    """A room of semantics/scenes/<id>.semantic_config.json; lengths in metres, Y up."""

    name: str | None = None
    label: str | None = None
    poly_loop: list[Three] = Field([], max_length=MOST_THINGS)
    floor_height: float | None = None
    extrusion_height: float | None = None
    min_bounds: Three | None = None
    max_bounds: Three | None = None

    @property
    def title(self) -> str:
        """What the region is: its label, else its name."""
        return self.label or self.name or "room"

    @property
    def floor(self) -> float:
        """Height of its floor."""
        if self.floor_height is not None:
            return self.floor_height
        return self._corners[:, 1].min() if self.has_place else 0.0

    @property
    def has_place(self) -> bool:
        """Whether the region says where it is."""
        return bool(self.poly_loop) or (self.min_bounds is not None and self.max_bounds is not None)

    @property
    def _corners(self) -> Array:
        return np.array([self.min_bounds, self.max_bounds] if self.min_bounds and self.max_bounds else self.poly_loop)

    @property
    def x0(self) -> float:
        """Least x."""
        return float(self._corners[:, 0].min())

    @property
    def x1(self) -> float:
        """Greatest x."""
        return float(self._corners[:, 0].max())

    @property
    def z0(self) -> float:
        """Least z."""
        return float(self._corners[:, 2].min())

    @property
    def z1(self) -> float:
        """Greatest z."""
        return float(self._corners[:, 2].max())


class _Semantics(Loose):
    region_annotations: list[Region] = Field([], max_length=MOST_ROOMS)


class CatalogueRow(NamedTuple):
    """What semantics/objects.csv says of a template; empty where it says nothing."""

    name: str = ""
    wnsynsetkey: str = ""
    super_category: str = ""
    support: str = ""


class Template(NamedTuple):
    """What an object or a stage is made from."""

    config: AssetConfig
    asset: Path
    frame: Array
    """Rotation from the asset's own frame to Habitat's, shape (3, 3)."""
    row: CatalogueRow
    opening: bool


class Folder:
    """An HSSD folder: holds scenes/, objects/ and semantics/."""

    def __init__(self, root: Path) -> None:
        """Look at a folder; nothing is read yet.

        Raises:
            ConfigError: If it does not have the layout of HSSD.
        """
        self.root = root
        for name in ("scenes", "objects"):
            if not (root / name).is_dir():
                raise ConfigError(f"{root}: this is no HSSD folder, for it has no folder {name}/.")
        self.scene = lru_cache(maxsize=8)(self._scene)

    def ids(self) -> list[str]:
        """Names of all scenes, sorted."""
        return sorted(path.name.removesuffix(_INSTANCE) for path in (self.root / "scenes").glob(f"*{_INSTANCE}"))

    def _scene(self, id: str) -> SceneInstance:
        return read_json(self._scene_file(id), SceneInstance)

    def with_origin(self, id: str, instance: Instance) -> Instance:
        """The instance, with the scene's origin of translations where it has none of its own."""
        origin = instance.translation_origin or self.scene(id).translation_origin
        return instance.model_copy(update={"translation_origin": origin})

    def regions(self, id: str, *, required: bool) -> list[Region]:
        """The rooms of a scene; none where their file is missing and not required.

        Raises:
            ConfigError: If the file is missing or wrong.
        """
        path = self.root / "semantics" / "scenes" / f"{id}.semantic_config.json"
        if not path.exists() and not required:
            return []
        found = read_json(path, _Semantics).region_annotations
        for number, region in enumerate(found):
            if not region.has_place:
                raise ConfigError(f"{path}, field region_annotations.{number}: must have poly_loop, or both bounds.")
        return found

    def template(self, id: str, number: int, name: str) -> Template:
        """What an object of a scene is made from.

        Raises:
            FileNotFoundError: If one of its files is missing; its text is one sentence for the user.
            ConfigError: If one of them is wrong.
        """
        key = Path(name).name.removesuffix(_OBJECT)
        path = self._configs.get(key)
        if path is None:
            field = f"object_instances.{number}.template_name"
            raise FileNotFoundError(
                f"{self._scene_file(id)}, field {field}: there is no file {key}{_OBJECT} below {self.root / 'objects'}."
            )
        row = self._rows.get(key) or self._rows.get(key.partition("_part_")[0]) or CatalogueRow()
        return self._template(path, row)

    def stage(self, id: str) -> Template | None:
        """What the walls and floors are made from; None where the scene has no stage or its files are missing."""
        placed = self.scene(id).stage_instance
        if placed is None:
            return None
        name = Path(placed.template_name).name.removesuffix(".stage_config.json")
        path = self.root / "stages" / f"{name}.stage_config.json"
        try:
            return self._template(path, CatalogueRow()) if _exists(path) else None
        except FileNotFoundError:
            return None

    def _scene_file(self, id: str) -> Path:
        return self.root / "scenes" / f"{id}{_INSTANCE}"

    def _template(self, path: Path, row: CatalogueRow) -> Template:
        config = read_json(path, AssetConfig)
        asset = config.render_asset or config.collision_asset
        field = "render_asset" if config.render_asset or not config.collision_asset else "collision_asset"
        if not asset:
            raise ConfigError(f"{path}, field render_asset: must name a glb file.")
        file = Path(os.path.normpath(path.parent / asset))
        if not file.is_relative_to(os.path.normpath(self.root)):
            raise ConfigError(f"{path}, field {field}: must name a file within {self.root}, not {asset!r}.")
        if not _exists(file):
            raise FileNotFoundError(f"{path}, field {field}: there is no file {file}.")
        return Template(config, file, _frame(config, path), row, "openings" in path.parts)

    @cached_property
    def _configs(self) -> dict[str, Path]:
        return {path.name.removesuffix(_OBJECT): path for path in sorted(self.root.glob(f"objects/**/*{_OBJECT}"))}

    @cached_property
    def _rows(self) -> dict[str, CatalogueRow]:
        path = self.root / "semantics" / "objects.csv"
        lines = read_table(path, read_text(path))
        names = next(lines).cells
        if "id" not in names or "super_category" not in names:
            raise ConfigError(f"{path}, line 1: the columns must have the names id and super_category.")
        rows = (dict(zip(names, cells, strict=False)) for _, cells in lines)
        return {
            row["id"]: CatalogueRow(*(row.get(name, "").strip() for name in CatalogueRow._fields))
            for row in rows
            if "id" in row
        }


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that no file can have
        return False


def _frame(config: AssetConfig, path: Path) -> Array:
    """The rotation that takes the asset's up to +Y and its front to -Z."""
    up, front = np.array(config.up), np.array(config.front)
    right = np.cross(front, up)
    if not np.isclose([np.linalg.norm(up), np.linalg.norm(front), np.linalg.norm(right)], 1.0, atol=1e-3).all():
        raise ConfigError(f"{path}, field up: up and front must be directions of length 1 at right angles.")
    return np.array([right, up, -front])
