"""Where a thing can be put down now: free places on a piece of furniture, nothing overlapping, nothing floating."""

from __future__ import annotations

import math

import numpy as np

from coopera.core.household import plain
from coopera.simulation.acts.state import HomeState
from coopera.simulation.homes.catalogue import surfaces
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.homes.spots import Spot, furniture_on, spots, taken_at


def free_places(scene: Scene, state: HomeState, thing: SceneObject, receptacle: SceneObject) -> list[Spot]:
    """Free places for a thing on a piece of furniture: usual surface first, then those nearest to its front."""
    around = receptacle.bounds.grown(max(thing.size[:2]))  # a long thing hangs over the edge
    taken = furniture_on(scene, receptacle)
    for other in scene.movable:
        where = state.thing(other)
        space = taken_at(Spot(*where.position, where.yaw), other.size)
        if other.name != thing.name and space.bounds.overlaps(around):
            taken.append(space)
    free = spots(receptacle, thing.size, taken)
    if not free:
        return []
    x, y, z, _ = np.array(free).T
    levels = np.round([receptacle.position[2] + surface.z for surface in surfaces(receptacle)], 3)
    level = np.abs(z[:, None] - levels).argmin(axis=1)
    cos, sin = math.cos(receptacle.yaw), math.sin(receptacle.yaw)
    dx, dy = x - receptacle.position[0], y - receptacle.position[1]
    aside, ahead = np.round(dx * cos + dy * sin, 3), np.round(dy * cos - dx * sin, 3)
    return [free[i] for i in np.lexsort((aside, np.abs(aside), -ahead, level))]


def full(receptacle: SceneObject, thing: SceneObject) -> str:
    """Say that a thing has no place there."""
    return f"there is no free place for the {plain(thing.name)} on the {plain(receptacle.name)}"
