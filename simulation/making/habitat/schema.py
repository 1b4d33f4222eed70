"""What the files of a Habitat data set say, as far as we read them.

https://aihabitat.org/docs/habitat-sim/attributesJSON.html
"""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field, field_validator

from coopera.simulation.homes.glb import Array
from coopera.simulation.homes.rooms import MOST_CORNERS, Place
from coopera.simulation.homes.scene import MOST_ROOMS, MOST_THINGS
from coopera.simulation.homes.untrusted import Loose

Three = tuple[float, float, float]
Positive = Annotated[float, Field(gt=0, le=1e4)]
Length = Annotated[float, Field(ge=-1e4, le=1e4)]
_MOST_INSTANCES = 1_500
"""Objects of a scene. Each is proved to be of use beside all others: 4,800 took a minute and more of a processor."""


class Placed(Loose):
    """What stands somewhere: the template it is made from, and its pose in Habitat's frame."""

    template_name: str
    translation: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    translation_origin: str | None = None
    non_uniform_scale: tuple[Positive, Positive, Positive] | None = None
    uniform_scale: Positive | None = None

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

    @property
    def scale(self) -> Three:
        """The factor along each axis."""
        if self.non_uniform_scale is not None:
            return self.non_uniform_scale
        return (self.uniform_scale or 1.0,) * 3


class Instance(Placed):
    """One object of a scene."""

    motion_type: str | None = None

    @property
    def stays(self) -> bool:
        """Whether the file says that it does not move."""
        return (self.motion_type or "").lower() == "static"


class SceneInstance(Loose):
    """scenes/<id>.scene_instance.json."""

    translation_origin: str | None = None
    stage_instance: Placed | None = None
    object_instances: list[Instance] = Field([], max_length=_MOST_INSTANCES)
    articulated_object_instances: list[Any] = []


class AssetConfig(Loose):
    """<template>.object_config.json, or <template>.stage_config.json."""

    render_asset: str | None = None
    collision_asset: str | None = None
    up: Three = (0.0, 1.0, 0.0)
    front: Three = (0.0, 0.0, -1.0)
    com: Three | None = Field(None, alias="COM")
    scale: tuple[Positive, Positive, Positive] = (1.0, 1.0, 1.0)
    units_to_meters: Positive = 1.0
    semantic_id: int | None = None


class Region(Loose):
    """A room of semantics/scenes/<id>.semantic_config.json; lengths in metres, Y up."""

    name: str | None = None
    label: str | None = None
    poly_loop: list[tuple[Place, Place, Place]] = Field([], max_length=MOST_CORNERS)
    floor_height: float | None = None
    min_bounds: tuple[Place, Place, Place] | None = None
    max_bounds: tuple[Place, Place, Place] | None = None

    @property
    def title(self) -> str:
        """What the region is: its label, else its name."""
        return self.label or self.name or "room"

    @property
    def floor(self) -> float:
        """Height of its floor."""
        if self.floor_height is not None:
            return self.floor_height
        return float(self._corners[:, 1].min()) if self.has_place else 0.0

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


class Semantics(Loose):
    """<id>.semantic_config.json: the rooms of a scene."""

    region_annotations: list[Region] = Field([], max_length=MOST_ROOMS)


class Entry(Loose):
    """A template that a data set changes or adds."""

    original_file: str | None = None
    template_handle: str | None = None
    attributes: dict[str, Any] = {}


class Group(Loose):
    """What a data set says of its stages, or of its objects."""

    default_attributes: dict[str, Any] = {}
    paths: dict[str, list[str]] = {}
    configs: list[Entry] = Field([], max_length=MOST_THINGS)


class Dataset(Loose):
    """<name>.scene_dataset_config.json."""

    stages: Group = Group()
    objects: Group = Group()


class Word(Loose):
    """What a semantic id means."""

    id: int
    name: str


class Lexicon(Loose):
    """<name>_semantic_lexicon.json."""

    classes: list[Word] = Field([], max_length=MOST_THINGS)


class CatalogueRow(NamedTuple):
    """What semantics/objects.csv says of a template; empty where it says nothing."""

    name: str = ""
    wnsynsetkey: str = ""
    super_category: str = ""
    support: str = ""
