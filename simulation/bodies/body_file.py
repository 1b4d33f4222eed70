"""A robot as data: a URDF, and some fifteen lines of YAML that say what its parts are for; see `fetch.yaml`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Self, TypeAlias

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from coopera.core.errors import ConfigError
from coopera.core.people import Frozen
from coopera.simulation.bodies.arm import Chain, chain_of
from coopera.simulation.bodies.manipulator import Eye, MobileManipulator
from coopera.simulation.bodies.urdf import Hinge, Urdf, known, of_package, read_urdf
from coopera.simulation.homes.untrusted import read_yaml
from coopera.simulation.shapes.rotations import Array

RADIUS = 0.30
"""No footprint is larger (metres): the floor that the homes leave free for a body, `ways.floor.RADIUS`."""
Number: TypeAlias = Annotated[float, Field(strict=True, ge=-100, le=100)]
Name: TypeAlias = Annotated[str, Field(min_length=1, max_length=100)]
Point: TypeAlias = tuple[Number, Number, Number]
Posture: TypeAlias = Annotated[dict[Name, Number], Field(max_length=100)]
_SLACK = 1e-6


class _Part(Frozen):
    model_config = ConfigDict(allow_inf_nan=False)


class _Packed(_Part):
    package: Annotated[str, Field(pattern=r"^[A-Za-z0-9][\w.-]*$", max_length=100)]
    file: Annotated[str, Field(min_length=1, max_length=300)]


class _Base(_Part):
    footprint: Annotated[Number, Field(gt=0, le=RADIUS)] = RADIUS
    middle: Point = (0.0, 0.0, 0.0)
    works_at: Annotated[Number, Field(ge=-180, le=180)] = 0.0


class _Pan(_Part):
    joint: Name
    x: Number | None = None
    y: Number | None = None


class _Arm(_Part):
    joints: Annotated[list[Name], Field(min_length=3, max_length=20)]
    pan: _Pan | None = None
    shoulder: Name | None = None
    lift: Number | None = None
    reach: Annotated[Number, Field(gt=0, le=3)]


class _Gripper(_Part):
    link: Name
    offset: Point = (0.0, 0.0, 0.0)
    joints: Annotated[list[Name], Field(max_length=40)] = []


class _Camera(_Part):
    link: Name
    offset: Point = (0.0, 0.0, 0.0)
    pan: Name | None = None
    tilt: Name | None = None


class _Postures(_Part):
    reaching: Posture
    tucked: Posture
    carrying: Posture | None = None


class _Body(_Part):
    about: Annotated[str, Field(max_length=200)] = ""
    urdf: _Packed | Annotated[str, Field(min_length=1, max_length=300)] | None = None
    base: _Base = _Base()
    arm: _Arm
    gripper: _Gripper
    camera: _Camera
    postures: _Postures

    @property
    def moved(self) -> list[str]:
        """The joints that postures are about: the arm's, the camera's, the gripper's."""
        head = [joint for joint in (self.camera.pan, self.camera.tilt) if joint is not None]
        return [*self.arm.joints, *head, *self.gripper.joints]

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        pan = self.arm.pan and self.arm.pan.joint
        for field, name in (("arm.pan.joint", pan), ("arm.shoulder", self.arm.shoulder)):
            if name is not None and name not in self.arm.joints:
                raise ValueError(f"{field} must be one of arm.joints, not {name!r}")
        if twice := next((name for name in self.moved if self.moved.count(name) > 1), None):
            raise ValueError(f"the joint {twice!r} is named twice")
        for what, posture in self.postures:
            for name in posture or ():
                if name not in self.moved:
                    raise ValueError(f"postures.{what} names {name!r}, which is none of the joints named above")
        return self


def about_body(path: Path) -> str:
    """What a body's file says that it is.

    Raises:
        ConfigError: If the file cannot be read.
    """
    return read_yaml(path, _Body).about


def read_body(path: Path) -> MobileManipulator:
    """Read a body's file and the description that it names.

    Raises:
        ConfigError: If either cannot be used; names the file, and the field, joint or link.
    """
    body = read_yaml(path, _Body)
    urdf = read_urdf(_described(path, body)).on_floor(body.base.middle, body.base.footprint)
    for name in body.moved:
        if name not in urdf.hinges:
            raise ConfigError(f"{path}: {known('joint', name, list(urdf.hinges))}.")
        if not urdf.hinges[name].moves:
            raise ConfigError(
                f"{path}: the joint {name!r} is of the type {urdf.hinges[name].kind!r}, which does not move."
            )
    return _Made(path, body, urdf).body()


def _described(path: Path, body: _Body) -> Path:
    if isinstance(body.urdf, _Packed):
        return of_package(path, body.urdf.package, body.urdf.file)
    return path.with_suffix(".urdf") if body.urdf is None else path.parent / body.urdf


class _Made:
    """A body out of its file and its description."""

    def __init__(self, path: Path, body: _Body, urdf: Urdf) -> None:
        self._path, self._file, self._urdf = path, body, urdf
        followers = [hinge.name for name in body.moved for hinge in urdf.followers(name)]
        self._joints = (*body.moved, *(name for name in followers if name not in body.moved))

    def body(self) -> MobileManipulator:
        file = self._file
        postures = file.postures
        carrying = postures.tucked if postures.carrying is None else postures.carrying
        reaching = self._posture("reaching", postures.reaching)
        shoulder = file.arm.shoulder
        return MobileManipulator(
            name=self._path.stem,
            about=file.about,
            urdf=self._urdf,
            chain=self._chain(reaching),
            shoulder=self._first_that_turns() if shoulder is None else file.arm.joints.index(shoulder),
            eye=self._eye(),
            joints=self._joints,
            reaching=reaching,
            tucked=self._posture("tucked", postures.tucked),
            carrying=self._posture("carrying", carrying),
            farthest=file.arm.reach,
            side=math.radians(file.base.works_at),
        )

    def _chain(self, reaching: Array) -> Chain:
        arm, gripper = self._file.arm, self._file.gripper
        way = self._way("gripper.link", gripper.link)
        for name in arm.joints:
            self._check_on("arm.joints", name, way, gripper.link)
            hinge = self._urdf.hinges[name]
            if not hinge.low < hinge.high:
                limits = f"its limits are {hinge.low:g} and {hinge.high:g}"
                raise ConfigError(f"{self._urdf.path}: the joint {name!r} cannot move: {limits}.")
        on_way = [hinge.name for hinge in way if hinge.name in arm.joints]
        if on_way != arm.joints:
            raise ConfigError(f"{self._path}, field arm.joints: from the base on they are {', '.join(on_way)}.")
        joints, tip, end = chain_of(way, arm.joints, gripper.offset)
        chain = Chain(joints, tip, end, lift=arm.lift)
        if arm.pan is None:
            return chain
        turning = arm.joints.index(arm.pan.joint)
        x, y, _ = chain.forward(reaching).joints[turning].tolist()
        x, y = (given if given is not None else found for given, found in ((arm.pan.x, x), (arm.pan.y, y)))
        return Chain(joints, tip, end, (turning, x, y), arm.lift)

    def _eye(self) -> Eye:
        camera = self._file.camera
        way = self._way("camera.link", camera.link)
        for field, name in (("camera.pan", camera.pan), ("camera.tilt", camera.tilt)):
            if name is not None:
                self._check_on(field, name, way, camera.link)
        joints, tip, end = chain_of(way, self._file.moved, camera.offset)
        names = [joint.name for joint in joints]
        pan, tilt = (None if name is None else names.index(name) for name in (camera.pan, camera.tilt))
        return Eye(Chain(joints, tip, end), tuple(self._joints.index(name) for name in names), pan, tilt)

    def _way(self, field: str, link: str) -> list[Hinge]:
        if link not in self._urdf.links:
            raise ConfigError(f"{self._path}, field {field}: {known('link', link, self._urdf.links)}.")
        return self._urdf.way(link)

    def _check_on(self, field: str, name: str, way: Sequence[Hinge], link: str) -> None:
        if name not in [hinge.name for hinge in way]:
            raise ConfigError(f"{self._path}, field {field}: the joint {name!r} is not between the base and {link!r}.")

    def _first_that_turns(self) -> int:
        turns = [self._urdf.hinges[name].kind != "prismatic" for name in self._file.arm.joints]
        return turns.index(True) if any(turns) else 0

    def _posture(self, what: str, given: Posture) -> Array:
        """A posture of all joints; those that are not given are at 0, or as near as their limits let them."""
        values: dict[str, float] = {}
        for name in self._file.moved:
            hinge = self._urdf.hinges[name]
            value = given.get(name, 0.0)
            if hinge.low < hinge.high and hinge.kind != "continuous":
                if name in given and not hinge.low - _SLACK <= value <= hinge.high + _SLACK:
                    raise ConfigError(f"{self._path}: postures.{what} has {name} at {value:g}, beyond its limits.")
                value = min(max(value, hinge.low), hinge.high)
            values[name] = value
        for name in self._joints:
            follows = self._urdf.hinges[name].follows
            if name not in values and follows is not None:
                values[name] = values[follows.joint] * follows.factor + follows.offset
        return np.array([values[name] for name in self._joints], dtype=np.float64)
