"""What a camera sees, as data for those who learn from pictures: colours, depth, and what each pixel is of."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing.lens import Camera, view_matrix
from coopera.simulation.shapes.rotations import Array

NOTHING = -1
"""The instance of a pixel in which nothing of the home is."""


@dataclass(frozen=True, eq=False)
class View:
    """One picture of a home; rows run from the top, columns from the left."""

    camera: Camera
    colour: NDArray[np.uint8]
    """(height, width, 3)."""
    depth: NDArray[np.float32]
    """(height, width): metres along the viewing direction, infinite where nothing is."""
    instances: NDArray[np.int64]
    """(height, width): which body, a key of `names`; `NOTHING` where nothing is."""
    classes: NDArray[np.int64]
    """(height, width): of which class, an index into `class_names`; 0 where nothing is."""
    names: dict[int, str]
    """Body by number: a room (its floor, walls and ceiling), a piece of furniture, a thing, a person or a robot."""
    class_names: list[str]
    """Such as "floor", "wall", "mug", "person" and "robot"; the first is "nothing"."""

    @property
    def intrinsics(self) -> Array:
        """The camera's matrix K, (3, 3): pixels from directions with x to the right, y down and z ahead."""
        height, width = self.depth.shape
        focal = height / 2 / math.tan(math.radians(self.camera.fov) / 2)
        return np.array(((focal, 0.0, width / 2), (0.0, focal, height / 2), (0.0, 0.0, 1.0)))

    @property
    def extrinsics(self) -> Array:
        """World to camera, (4, 4): x to the right, y down and z ahead, as OpenCV has it."""
        return np.diag((1.0, -1.0, -1.0, 1.0)) @ view_matrix(self.camera)

    @cached_property
    def points(self) -> Array:
        """The place in the world of each pixel's middle, (height, width, 3) metres; infinite where nothing is."""
        height, width = self.depth.shape
        y, x = np.mgrid[0:height, 0:width] + 0.5
        ahead = np.stack((x, y, np.ones_like(x)), axis=2) @ np.linalg.inv(self.intrinsics).T
        turn = self.extrinsics[:3, :3]
        with np.errstate(invalid="ignore"):
            found: Array = (ahead @ turn) * self.depth[..., None].astype(np.float64) + np.array(self.camera.eye)
        found[~np.isfinite(self.depth)] = np.inf
        return found

    def point_cloud(self) -> tuple[Array, NDArray[np.uint8], NDArray[np.int64]]:
        """All that is seen as points of the world.

        Returns:
            Places (n, 3) in metres, colours (n, 3), and the body of each (n,).
        """
        there = np.isfinite(self.depth)
        return self.points[there], self.colour[there], self.instances[there]

    def pixels_of(self, name: str) -> int:
        """How many pixels show the body of that name."""
        return int(sum((self.instances == number).sum() for number, one in self.names.items() if one == name))
