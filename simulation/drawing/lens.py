"""Cameras as matrices, and what of a home they can see. A camera looks along -z, as OpenGL's do; y is up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import ConfigError
from coopera.simulation.shapes.rotations import Array

Point3 = tuple[float, float, float]
NEAR, FAR = 0.05, 40.0
_MOST = 8192
"""Pixels that a picture may have a side: those of an 8k screen have 7,680."""


class Camera(NamedTuple):
    """Where a camera is, what it looks at, and its vertical field of view in degrees."""

    eye: Point3
    target: Point3
    fov: float = 58.0
    up: Point3 = (0.0, 0.0, 1.0)


def checked_size(size: tuple[int, int]) -> tuple[int, int]:
    """A picture's width and height in pixels, as they were given.

    Raises:
        ConfigError: If there can be no such picture.
    """
    if not all(isinstance(side, (int, np.integer)) and 1 <= side <= _MOST for side in size):
        raise ConfigError(f"frame_size: a picture has 1 to {_MOST} pixels a side, not {size[0]} x {size[1]}.")
    return size


def view_matrix(camera: Camera) -> Array:
    """World to camera, (4, 4)."""
    eye = np.array(camera.eye)
    back = eye - np.array(camera.target)
    back = back / max(float(np.linalg.norm(back)), 1e-9)
    right = _cross(camera.up, back)
    if float(np.linalg.norm(right)) < 1e-6:
        right = _cross((0.0, 1.0, 0.0), back)
    right = right / np.linalg.norm(right)
    turn = np.stack((right, _cross(back, right), back))
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = turn, -turn @ eye
    return found


def _cross(one: Sequence[float] | Array, other: Array) -> Array:
    """What numpy's `cross` gives for two vectors, in a tenth of its time."""
    (a, b, c), (x, y, z) = one, other
    return np.array((b * z - c * y, c * x - a * z, a * y - b * x))


def projection(
    camera: Camera, size: tuple[int, int], tile: tuple[int, int, int, int], reach: tuple[float, float]
) -> Array:
    """Camera to clip space for a part of a picture: its left, top, width and height in pixels, of `size`; (4, 4)."""
    near, far = reach
    tall = near * math.tan(math.radians(camera.fov) / 2)
    wide = tall * size[0] / size[1]
    left, right = (wide * (2 * x / size[0] - 1) for x in (tile[0], tile[0] + tile[2]))
    top, bottom = (tall * (1 - 2 * y / size[1]) for y in (tile[1], tile[1] + tile[3]))
    found = np.zeros((4, 4))
    found[0, 0], found[0, 2] = 2 * near / (right - left), (right + left) / (right - left)
    found[1, 1], found[1, 2] = 2 * near / (top - bottom), (top + bottom) / (top - bottom)
    found[2, 2], found[2, 3], found[3, 2] = -(far + near) / (far - near), -2 * far * near / (far - near), -1.0
    return found


def reach_of(camera: Camera) -> tuple[float, float]:
    """The nearest and the farthest distance that a camera sees."""
    away = math.dist(camera.eye, camera.target)
    return (NEAR, FAR) if away < 6.0 else (min(1.0, away / 25), max(4 * away, FAR))


def metres_of(depth: NDArray[np.float32], reach: tuple[float, float]) -> Array:
    """How far before the lens each pixel is, from OpenGL's depth under a `projection`; infinite where nothing is."""
    near, far = reach
    metres = 2 * near * far / (far + near - (2.0 * depth.astype(np.float64) - 1.0) * (far - near))
    return np.where(depth >= 1.0, np.inf, metres)
