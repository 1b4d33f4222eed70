"""Hands, relaxed and half closed, and feet, bare or in shoes; each in the frame of its part."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from coopera.simulation.bodies.humanoid import ANKLE
from coopera.simulation.people.fields import Array, ball, join, loft
from coopera.simulation.people.nets import Index
from coopera.simulation.people.sweeps import finger, ordered

Footwear = Literal["bare", "shoes", "trainers", "slippers"]

_PALM = loft(
    (
        (0.080, 0.000, 0.0270, 0.0270, 0.0190),
        (0.050, 0.001, 0.0300, 0.0300, 0.0175),
        (0.015, 0.002, 0.0385, 0.0380, 0.0160),
        (-0.012, 0.002, 0.0390, 0.0375, 0.0130),
    ),
    2.2,
    (0.010, 0.020),
)
_KNUCKLES = ((0.0305, 0.066, 0.0088), (0.0105, 0.074, 0.0090), (-0.0090, 0.069, 0.0086), (-0.0270, 0.054, 0.0076))
"""Of the four fingers: place across the hand, length and thickness."""
_CURL = (28.0, 72.0, 104.0)
"""How far each bone of a finger is bent from the palm, in degrees."""
_BONES = (0.46, 0.29, 0.25)


def palm(points: Array) -> Array:
    """The middle of the left hand, of points in its frame: its palm looks to the right, its thumb forward."""
    heel = ball(points, (0.020, -0.009, 0.045), (0.017, 0.012, 0.030))
    return join(_PALM.at(points), heel, 0.012)


def fingers(size: float) -> Iterator[tuple[Array, Array, Index]]:
    """The fingers and the thumb of the left hand."""
    for x, length, thick in _KNUCKLES:
        point, path = np.array((x, 0.0, -0.004)), []
        path.append(point)
        for bend, share in zip(_CURL, _BONES, strict=True):
            along = np.array((-0.10 * x / 0.03 * 0.5, -math.sin(math.radians(bend)), -math.cos(math.radians(bend))))
            point = point + along * length * share
            path.append(point)
        radii = thick * np.array((1.05, 0.98, 0.90, 0.80))
        yield ordered(finger(np.array(path) * size, radii * size))
    thumb = np.array(
        (
            (0.014, -0.006, 0.050),
            (0.030, -0.012, 0.030),
            (0.042, -0.020, 0.008),
            (0.044, -0.031, -0.010),
            (0.040, -0.043, -0.022),
        )
    )
    yield ordered(finger(thumb * size, np.array((0.0135, 0.0125, 0.0105, 0.0098, 0.0088)) * size))


_FOOT = (
    (-0.058, -0.018, 0.036, 0.034, 0.026),
    (-0.030, -0.008, 0.052, 0.044, 0.033),
    (0.020, -0.006, 0.050, 0.046, 0.034),
    (0.070, -0.018, 0.034, 0.036, 0.037),
    (0.115, -0.030, 0.020, 0.024, 0.040),
    (0.150, -0.034, 0.013, 0.018, 0.034),
)


def foot(points: Array, wear: Footwear) -> Array:
    """The left foot or its shoe, of points in the ankle's frame."""
    thick = {"bare": 0.0, "shoes": 0.006, "trainers": 0.0085, "slippers": 0.007}[wear]
    rows = [[x, z, up + thick, down + thick, side + thick] for x, z, up, down, side in _FOOT]
    rows[0][0] -= thick
    rows[-1][0] += 2 * thick
    turned = points[:, [2, 1, 0]]
    found = loft(rows, 2.3, (0.020, 0.022)).at(turned)
    height = points[:, 2] + ANKLE
    found = np.maximum(found, -height)
    if wear == "slippers":
        found = np.maximum(found, points[:, 2] - 0.004 - np.maximum(points[:, 0] - 0.06, 0))
    else:
        top = {"bare": 0.07, "shoes": 0.022, "trainers": 0.034}[wear]
        found = np.maximum(found, points[:, 2] - top)
    return found


def toes(size: float = 1.0) -> Iterator[tuple[Array, Array, Index]]:
    """The toes of a bare left foot."""
    for y, x, thick in (
        (-0.024, 0.160, 0.0120),
        (-0.005, 0.164, 0.0095),
        (0.009, 0.158, 0.0088),
        (0.021, 0.150, 0.0082),
        (0.031, 0.140, 0.0076),
    ):
        path = np.array(
            ((x - 0.03, y * 0.9, -ANKLE + 0.018), (x - 0.01, y, -ANKLE + 0.014), (x + 0.008, y, -ANKLE + thick))
        )
        yield ordered(finger(path * size, np.array((thick, thick, thick * 0.95)) * size))
