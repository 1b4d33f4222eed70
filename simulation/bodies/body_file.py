"""A robot's body as data: the file NAME.yaml beside NAME.urdf. `fetch.yaml` explains the fields."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, Self, TypeAlias
from xml.etree import ElementTree

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_text
from coopera.core.people import Frozen
from coopera.simulation.bodies.arm import Chain, Joint
from coopera.simulation.bodies.manipulator import Head, MobileManipulator
from coopera.simulation.homes.untrusted import read_yaml
from coopera.simulation.shapes.rotations import Array

Number: TypeAlias = Annotated[float, Field(strict=True, ge=-100, le=100)]
Name: TypeAlias = Annotated[str, Field(pattern=r"^\w+$", max_length=60)]
Point: TypeAlias = tuple[Number, Number, Number]
Pair: TypeAlias = tuple[Number, Number]

HEAD = ("head_pan", "head_tilt")
OF_PYBULLET = "pybullet_data/"
"""With this begins a mesh of a URDF that comes from what ships with pybullet."""


class _Part(Frozen):
    model_config = ConfigDict(allow_inf_nan=False)


class _Joint(_Part):
    name: Name
    origin: Point
    axis: Literal["x", "y", "z"]
    low: Number
    high: Number
    roll: Number = 0.0
    slides: bool = False

    @model_validator(mode="after")
    def _can_move(self) -> Self:
        if self.low >= self.high:
            raise ValueError(f"low must be below high, and {self.low:g} is not below {self.high:g}")
        return self


class _Pan(_Part):
    joint: Name
    x: Number


class _Head(_Part):
    pan: Point
    tilt: Point
    camera: Point
    lifted: bool
    pan_limit: Annotated[Number, Field(gt=0)] = 1.57
    tilt_limits: Pair = (-0.76, 1.45)


class _Posture(_Part):
    joints: list[Number]
    head: Pair
    fingers: Pair

    def array(self) -> Array:
        return np.array((*self.joints, *self.head, *self.fingers), dtype=np.float64)


class _Postures(_Part):
    reaching: _Posture
    tucked: _Posture
    carrying: _Posture


class _Body(_Part):
    about: Annotated[str, Field(max_length=200)] = ""
    joints: Annotated[list[_Joint], Field(min_length=3, max_length=20)]
    tip: Point
    pan: _Pan
    lift: Number = 0.0
    shoulder: Name
    farthest: Annotated[Number, Field(gt=0)]
    head: _Head
    fingers: tuple[Name, Name]
    postures: _Postures

    @property
    def names(self) -> list[str]:
        return [joint.name for joint in self.joints]

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for field, name in (("pan.joint", self.pan.joint), ("shoulder", self.shoulder)):
            if name not in self.names:
                raise ValueError(f"{field} must be one of the joints, not {name!r}")
        every = [*self.names, *HEAD, *self.fingers]
        if twice := next((name for name in every if every.count(name) > 1), None):
            raise ValueError(f"two joints are called {twice!r}")
        if self.head.lifted and not self.joints[0].slides:
            raise ValueError("head.lifted needs a first joint that slides")
        return self

    @model_validator(mode="after")
    def _can_be_taken(self) -> Self:
        for what in _Postures.model_fields:
            values = getattr(self.postures, what).joints
            if len(values) != len(self.joints):
                raise ValueError(f"postures.{what}.joints must have {len(self.joints)} numbers, not {len(values)}")
            for joint, value in zip(self.joints, values, strict=True):
                if not joint.low <= value <= joint.high:
                    raise ValueError(f"postures.{what} has {joint.name} at {value:g}, beyond its limits")
        return self


def read_body(path: Path) -> MobileManipulator:
    """Read a body's file, and see that the URDF beside it has its joints.

    Raises:
        ConfigError: If either file cannot be used; names the file, and the field or the joint.
    """
    body, urdf = read_yaml(path, _Body), path.with_suffix(".urdf")
    made = MobileManipulator(
        name=path.stem,
        about=body.about,
        urdf=urdf,
        chain=Chain(
            joints=tuple(Joint(**joint.model_dump()) for joint in body.joints),
            tip=body.tip,
            pan=(body.names.index(body.pan.joint), body.pan.x),
            lift=body.lift,
        ),
        shoulder=body.names.index(body.shoulder),
        head=Head(**body.head.model_dump()),
        fingers=body.fingers,
        reaching=body.postures.reaching.array(),
        tucked=body.postures.tucked.array(),
        carrying=body.postures.carrying.array(),
        farthest=body.farthest,
    )
    _check_shapes(urdf, made, path.name)
    return made


def _check_shapes(urdf: Path, body: MobileManipulator, named_by: str) -> None:
    """See that a URDF has the body's joints, and that the meshes that it names are there."""
    try:
        root = ElementTree.fromstring(read_text(urdf))
    except ElementTree.ParseError as err:
        raise ConfigError(f"{urdf}, line {err.position[0]}: this is not valid XML.") from err
    lacking = set(body.joints) - {joint.get("name", "") for joint in root.findall("joint")}
    if lacking:
        raise ConfigError(f"{urdf}: the joint {min(lacking)!r}, which {named_by} names, is missing.")
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        if not name.startswith(OF_PYBULLET) and not (urdf.parent / name).is_file():
            raise ConfigError(f"{urdf}: the mesh {name!r} is missing; it must be in this file's folder.")
