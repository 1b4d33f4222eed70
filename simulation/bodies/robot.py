"""What a robot's body must offer, and the bodies that there are: a mobile base with an arm and a head camera.

To add a body: NAME.yaml in this folder (fetch.yaml explains it) and a URDF, beside it or in a package of PyPI. The
tests of tests/simulation/bodies/test_robot.py then hold for it, too. A body may also stand elsewhere and be named by
the path of its YAML file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.registry import unknown
from coopera.simulation.bodies.arm import Gripper
from coopera.simulation.bodies.body_file import about_body, read_body
from coopera.simulation.bodies.urdf import Urdf
from coopera.simulation.shapes.rotations import Array

_FOLDER = Path(__file__).parent


class RobotBody(Protocol):
    """A robot's body. All that the skills, the recordings and the cameras ask of it.

    A posture is an array of numbers in the order of `joints`. The body drives as a disc of the homes' navigation
    radius (`navigation.RADIUS`).
    """

    @property
    def name(self) -> str:
        """What a configuration calls it."""
        ...

    @property
    def about(self) -> str:
        """What it is, in a line."""
        ...

    @property
    def urdf(self) -> Urdf:
        """Its shapes; the origin is on the floor under its middle."""
        ...

    @property
    def joints(self) -> Sequence[str]:
        """Names of all joints that a posture sets."""
        ...

    @property
    def side(self) -> float:
        """Where it works best: the heading of what it reaches for in the body frame, 0 straight ahead."""
        ...

    @property
    def tucked(self) -> Array:
        """For driving and looking, the arm over the base."""
        ...

    @property
    def carrying(self) -> Array:
        """With a thing in the gripper, out of the camera's way."""
        ...

    def reach(self, target: Array) -> Iterator[Array]:
        """Yield postures within the joints' limits that put the gripper within 5 mm of a point of the body frame."""
        ...

    def gripper(self, posture: Array) -> Gripper:
        """Where the gripper and the arm's joints are."""
        ...

    def arm(self, posture: Array) -> Array:
        """Points along the arm from the shoulder to the wrist, at most 15 cm apart; shape (n, 3)."""
        ...

    def camera(self, posture: Array) -> tuple[Array, Array]:
        """The head camera's place and viewing direction in the body frame."""
        ...

    def look_at(self, posture: Array, target: Array) -> Array:
        """The posture with the head turned so that the camera faces a point of the body frame, within its limits."""
        ...


def known_robots() -> list[str]:
    """Names of the bodies that ship, sorted."""
    return sorted(path.stem for path in _FOLDER.glob("*.yaml"))


def usable_robots() -> list[str]:
    """Those of the bodies that ship whose descriptions are here, sorted; of others a package is not installed."""
    return [name for name in known_robots() if lacking(name) is None]


def lacking(name: str) -> str | None:
    """Why a body that ships cannot be used here; None if it can."""
    try:
        _shipped(name)
    except ConfigError as err:
        return str(err)
    return None


def about_robot(name: str) -> str:
    """What a body that ships is, in a line."""
    return about_body(_FOLDER / f"{name}.yaml")


def load_robot(name: str) -> RobotBody:
    """A body by its name, or by the path of its file, which ends in ".yaml".

    Raises:
        ConfigError: If there is no such body, naming those there are, or its files cannot be used.
    """
    if name.endswith(".yaml"):
        return read_body(Path(name))
    if name not in known_robots():
        raise unknown("robot", name, known_robots())
    return _shipped(name)


@made_once()
def _shipped(name: str) -> RobotBody:
    return read_body(_FOLDER / f"{name}.yaml")
