"""From Habitat's frame to ours: where an instance of a template stands, and its mesh in its own frame.

Habitat's frame is Y up with the front towards -Z; ours is Z up with the front towards +Y, so (x, y, z) becomes
(x, -z, y).
"""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coopera.simulation.homes.glb import Array, Mesh, rotation_matrix
from coopera.simulation.homes.mesh_files import read_mesh
from coopera.simulation.homes.meshes import simplified
from coopera.simulation.making.habitat.files import Template
from coopera.simulation.making.habitat.schema import Instance, Placed

TO_OURS: Array = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From Habitat's frame to ours: z becomes -y, and y becomes z."""
THINNEST = 0.0005


class Box(NamedTuple):
    """An upright box in our frame: centre of its base, yaw, and size in its own frame."""

    position: tuple[float, float, float]
    yaw: float
    size: tuple[float, float, float]


def box_of(template: Template, instance: Instance) -> Box:
    """The box of an instance in our frame, of the least size among those that are turned by its yaw."""
    return upright(template, instance, _corners(template.asset))[0]


def upright(template: Template, instance: Instance, corners: Array) -> tuple[Box, Array]:
    """The box of an instance around corners of its asset, and these corners in the box's own frame."""
    points, ours = _placed(template, instance, corners)
    along_x, along_y = ours[:2, 0], ours[:2, 1]
    yaw = (
        math.atan2(along_x[1], along_x[0])
        if np.hypot(*along_x) >= np.hypot(*along_y)
        else math.atan2(-along_y[0], along_y[1])
    )
    cos, sin = math.cos(yaw), math.sin(yaw)
    back = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    own = points @ back.T
    low, high = own.min(axis=0), own.max(axis=0)
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    x, y, z = back.T @ middle + TO_OURS @ np.array(instance.translation)
    w, d, h = (max(float(side), THINNEST) for side in high - low)
    box = Box(
        (round(float(x), 4), round(float(y), 4), round(float(z), 4)),
        round(math.remainder(yaw, math.tau), 6),
        (round(w, 4), round(d, 4), round(h, 4)),
    )
    return box, own - middle


def own_mesh(template: Template, instance: Instance, *, whole: bool) -> Mesh:
    """The mesh of an instance in its own frame: the whole of it, or made small enough to be drawn often."""
    mesh = _whole(template.asset) if whole else _small(template.asset)
    return mesh._replace(corners=upright(template, instance, mesh.corners)[1])


def stage_mesh(template: Template, placed: Placed) -> Mesh:
    """The mesh of a stage, in our frame."""
    mesh = read_mesh(template.asset)
    points, _ = _placed(template, placed, mesh.corners)
    return mesh._replace(corners=points + TO_OURS @ np.array(placed.translation))


def _placed(template: Template, placed: Placed, corners: Array) -> tuple[Array, Array]:
    """Corners as they are scaled and turned, in our frame, and the turn; they are not yet moved."""
    scale = np.array(placed.scale) * np.array(template.config.scale) * template.config.units_to_meters
    corners = corners @ template.frame.T
    if placed.by_mass:
        given = template.config.com
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2 if given is None else np.array(given)
        corners = corners - middle
    turn = rotation_matrix(placed.rotation)
    return (corners * scale) @ turn.T @ TO_OURS.T, TO_OURS @ turn @ TO_OURS.T


@lru_cache(maxsize=16)
def _whole(asset: Path) -> Mesh:
    return read_mesh(asset)


@lru_cache(maxsize=64)
def _small(asset: Path) -> Mesh:
    """What an asset looks like, made small before it is turned and scaled for each instance."""
    return simplified(_whole(asset))


@lru_cache(maxsize=512)
def _corners(asset: Path) -> Array:
    """The corners that can bound a box in any direction: those of the asset, without repetition."""
    return np.unique(_whole(asset).corners, axis=0)
