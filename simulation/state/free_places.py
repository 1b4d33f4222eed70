"""Where a thing can be put down now: free places on or inside a receptacle, nothing overlapping, nothing floating."""

from __future__ import annotations

import math

import numpy as np

from coopera.core.affordances import Relation
from coopera.core.household import plain
from coopera.simulation.homes.catalogue import interiors, surfaces
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.homes.spots import Spot, Taken, furniture_on, spots, taken_at
from coopera.simulation.state.home_state import HomeState, ThingState


def free_places(
    scene: Scene, state: HomeState, thing: SceneObject, receptacle: SceneObject, relation: Relation = "on"
) -> list[Spot]:
    """Free places for a thing on or inside a receptacle: usual surface first, then those nearest to its front.

    Furniture is a receptacle, and so is a thing that holds others; that one is where it stands now.
    """
    inside = relation == "inside"
    receptacle = where_it_is(state, receptacle)
    around = receptacle.bounds.grown(max(thing.size[:2]))  # a long thing hangs over the edge
    taken = [] if inside else furniture_on(scene, receptacle)
    others = [other for other in _beside(scene, state, receptacle, inside) if other.name != thing.name]
    taken += [filled(other, state.thing(other)) for other in others]
    taken = [space for space in taken if inside or space.bounds.overlaps(around)]
    free = spots(receptacle, thing.size, taken, inside=inside)
    if not free:
        return []
    x, y, z, _ = np.array(free).T
    rows = interiors(receptacle) if inside else surfaces(receptacle)
    levels = np.round([receptacle.position[2] + surface.z for surface in rows], 3)
    level = np.abs(z[:, None] - levels).argmin(axis=1)
    cos, sin = math.cos(receptacle.yaw), math.sin(receptacle.yaw)
    dx, dy = x - receptacle.position[0], y - receptacle.position[1]
    aside, ahead = np.round(dx * cos + dy * sin, 3), np.round(dy * cos - dx * sin, 3)
    return [free[i] for i in np.lexsort((aside, np.abs(aside), -ahead, level))]


def where_it_is(state: HomeState, thing: SceneObject) -> SceneObject:
    """An object as it stands now: furniture as it is, a thing at its present place."""
    if thing.fixed:
        return thing
    now = state.thing(thing)
    return thing.model_copy(update={"position": now.position, "yaw": now.yaw})


def filled(thing: SceneObject, where: ThingState) -> Taken:
    """The space that a thing fills at a place."""
    return taken_at(Spot(*where.position, where.yaw), thing.size)


def _beside(scene: Scene, state: HomeState, receptacle: SceneObject, inside: bool) -> list[SceneObject]:
    """The things that may be in the way: what is inside with it, or what is not inside of anything."""
    if inside:
        return state.contents(scene, receptacle.name)
    things = state.objects(scene)
    return [thing for thing in things if state.thing(thing).inside is None and state.bearer(thing.name) is None]


def full(receptacle: SceneObject, thing: SceneObject, relation: Relation = "on") -> str:
    """Say that a thing has no place there."""
    return f"there is no free place for the {plain(thing.name)} {_where(relation)} the {plain(receptacle.name)}"


def _where(relation: Relation) -> str:
    return "on" if relation == "on" else "inside"
