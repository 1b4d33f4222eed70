"""The surface before a person at work, and what follows from it: where the hands go and where a thing lies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np

from coopera.core.household import plain
from coopera.simulation.acts.state import BoxThing, HomeState, PersonState, ThingState, from_box
from coopera.simulation.homes.catalogue import surfaces
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.holding import CARRIED, LAP, Grip, Worktop, grip
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import Setting
from coopera.simulation.shapes.fixtures import BURNERS
from coopera.simulation.shapes.rotations import about_z, wrapped

_LEVEL = 0.03
_EDGE = 0.28
"""Who stands at a surface has its edge this far before the middle of the body (metres)."""
_STEP = 0.35
_AHEAD = 0.8
_TICK = 0.01
_NEAR = 1.5

Standing: TypeAlias = Sequence[tuple[SceneObject, ThingState]]
"""Things, and where they are."""


def worktop_before(scene: Scene, person: PersonState, standing: Standing = ()) -> tuple[Worktop, float] | None:
    """The surface that a person works at, in the body frame, and how far ahead its edge is; None if there is none."""
    at = scene.object(person.at) if person.at is not None else None
    if at is None or person.worktop is None:
        return None
    found = next((s for s in surfaces(at) if abs(at.position[2] + s.z - person.worktop) < _LEVEL), None)
    if found is None:
        return None
    middle = at.to_world((found.x0 + found.x1) / 2, (found.y0 + found.y1) / 2, found.z)
    half = ((found.x1 - found.x0) / 2, (found.y1 - found.y0) / 2)
    marks = [(x * at.size[0], y * at.size[1]) for x, y in BURNERS] if at.cls == "stove" else []
    things = [(thing, where) for thing, where in standing if abs(where.position[2] - middle[2]) < _LEVEL]
    places = [middle, *(at.to_world(*mark, 0.0) for mark in marks), *(where.position for _, where in things)]
    turned = (np.array(places)[:, :2] - np.array(person.place)) @ about_z(person.yaw)[:2, :2]
    (x, y), *rest = [(float(x), float(y)) for x, y in turned]
    taken = [(*place, max(thing.size[:2]) / 2) for place, (thing, _) in zip(rest[len(marks) :], things, strict=True)]
    yaw = wrapped(at.yaw - person.yaw)
    top = Worktop(x, y, yaw, *half, tuple(rest[: len(marks)]), tuple(taken))
    edge = _edge(top)
    return None if edge is None else (top, edge)


def _edge(top: Worktop) -> float | None:
    """How far straight ahead a surface begins; None where it is not ahead, or too far."""
    ahead = np.arange(0.0, _AHEAD, _TICK)
    local = np.stack((ahead - top.x, np.full_like(ahead, -top.y)), axis=1) @ about_z(top.yaw)[:2, :2]
    over = np.flatnonzero((np.abs(local) <= (top.half_x, top.half_y)).all(axis=1))
    return float(ahead[over[0]]) if len(over) else None


def at_work(
    scene: Scene,
    person: PersonState,
    motion: Motion,
    thing: SceneObject | None = None,
    *,
    text: str | None = None,
    standing: Standing = (),
) -> tuple[Setting, Grip]:
    """In which setting a person does a motion, and how they hold a thing meanwhile.

    Args:
        scene: The home.
        person: Where and how the body is.
        motion: What is done.
        thing: What is in hand.
        text: What that was called, if it came out of the magic box.
        standing: The other things of the home, and where they are.
    """
    setting = Setting(person.support, person.worktop, person.posture)
    found = worktop_before(scene, person, standing)
    top: Worktop | None = None
    if found is not None:
        top, edge = found
        if person.posture == "stand" and edge > _EDGE:
            step = min(edge - _EDGE, _STEP)
            setting, top = setting._replace(step=step), top.stepped(step)
    elif person.posture == "sit":  # what stands beside or behind who sits is no use to the hands
        top, setting = LAP, setting._replace(worktop=None)
    if thing is None:
        return setting, CARRIED
    names = [thing.cls] if text is None else [text, thing.cls]
    setting, how = grip(motion, setting, names, thing.size, top)
    if how.laid is not None and setting.step:
        how = how._replace(laid=how.laid._replace(x=how.laid.x + setting.step))
    return setting, how


def working(
    scene: Scene, state: HomeState, person: PersonState, motion: Motion, moved: Mapping[str, ThingState] | None = None
) -> tuple[Setting, Grip]:
    """The same for a person with what they have in hand; `moved` is what was put elsewhere since that state."""
    if person.thing is None:
        return at_work(scene, person, motion)
    since = moved or {}
    others = [thing for thing in state.objects(scene) if thing.name != person.thing]
    standing = [(thing, since.get(thing.name) or state.thing(thing)) for thing in others]
    standing += [(piece, ThingState(position=piece.position, yaw=piece.yaw, on=None)) for piece in scene.fixed]
    near = [(thing, where) for thing, where in standing if math.dist(where.position[:2], person.place) < _NEAR]
    known = state.box.get(person.thing)
    text = known.text if known else None
    return at_work(scene, person, motion, thing_of(scene, state, person.thing), text=text, standing=near)


def thing_of(scene: Scene, state: HomeState, name: str) -> SceneObject:
    """A thing by its name, or, where it comes out of the magic box only now, by what it is called."""
    return state.find(scene, name) or from_box(name, BoxThing(id=0, text=plain(name)))
