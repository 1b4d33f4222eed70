"""Where a thing can be put down now: free places on a piece of furniture, nothing overlapping, nothing floating."""

from __future__ import annotations

from core.household import plain
from simulation.catalogue import surfaces
from simulation.scene import Scene, SceneObject
from simulation.spots import Spot, furniture_on, spots, taken_at
from simulation.state import HomeState


def free_places(scene: Scene, state: HomeState, thing: SceneObject, receptacle: SceneObject) -> list[Spot]:
    """Free places for a thing on a piece of furniture: usual surface first, then those nearest to its front."""
    around = receptacle.bounds.grown(0.1)
    taken = furniture_on(scene, receptacle)
    for other in scene.movable:
        where = state.thing(other)
        space = taken_at(Spot(*where.position, where.yaw), other.size)
        if other.name != thing.name and space.bounds.overlaps(around):
            taken.append(space)
    levels = [round(receptacle.position[2] + surface.z, 3) for surface in surfaces(receptacle)]

    def order(spot: Spot) -> tuple[int, float, float, float]:
        x, y = receptacle.to_local(spot.x, spot.y)
        level = min(range(len(levels)), key=lambda i: abs(levels[i] - spot.z))
        return level, round(-y, 3), round(abs(x), 3), round(x, 3)

    return sorted(spots(receptacle, thing.size, taken), key=order)


def full(receptacle: SceneObject, thing: SceneObject) -> str:
    """Say that a thing has no place there."""
    return f"there is no free place for the {plain(thing.name)} on the {plain(receptacle.name)}"
