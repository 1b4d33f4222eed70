"""What a robot's body must offer, and the bodies that there are: a mobile base with an arm and a head camera.

To add a body: NAME.urdf and NAME.yaml in this folder, the latter with its measures (fetch.yaml explains them). The
tests of tests/simulation/bodies/test_robot.py then hold for it, too. A body may also stand elsewhere and be named by
the path of its YAML file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol

from coopera.core.lazy import made_once
from coopera.core.registry import unknown
from coopera.simulation.bodies.arm import Gripper
from coopera.simulation.bodies.body_file import read_body
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
    def urdf(self) -> Path:
        """Its shapes, with joints of the same names and measures."""
        ...

    @property
    def joints(self) -> Sequence[str]:
        """Names of all joints that a posture sets."""
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
