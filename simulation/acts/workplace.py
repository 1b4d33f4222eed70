"""The surface before a person at work, and what follows from it: where the hands go and where a thing lies."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from coopera.core.affordances import affordances
from coopera.core.household import plain
from coopera.simulation.homes.catalogue import Surface, surfaces
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.opened import opened
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.holding import CARRIED, LAP, Grip, Worktop, grip, to_tools
from coopera.simulation.motions.library import Motion
from coopera.simulation.motions.poses import Setting
from coopera.simulation.shapes.fixtures import BURNERS
from coopera.simulation.shapes.rotations import about_z, wrapped
from coopera.simulation.state.home_state import BoxThing, HomeState, PersonState, ThingState, from_box

_LEVEL = 0.03
_LOW, _HIGH = 0.45, 1.3
"""Surfaces that one works at are this high (metres above the floor)."""
_EDGE = 0.28
"""Who stands at a surface has its edge this far before the middle of the body (metres)."""
_STEP = 0.35
_AHEAD = 0.8
_TICK = 0.01
_NEAR = 1.5
_NO_NAME = re.compile(r"[^a-z0-9]+")

Standing: TypeAlias = Sequence[tuple[SceneObject, ThingState]]
"""Things, and where they are."""


class Before(NamedTuple):
    """The surface that a person works at, its height above the floor, and how far ahead its edge is (metres)."""

    top: Worktop
    height: float
    edge: float


def worktop_before(
    scene: Scene, person: PersonState, standing: Standing = (), motion: Motion | None = None
) -> Before | None:
    """The surface before a person: that of the height they work at, or another one of the same furniture.

    None if nothing is straight ahead within reach. What a motion is done with is among its tools.
    """
    at = scene.object(person.at) if person.at is not None else None
    if at is None or person.worktop is None:
        return None
    height = person.worktop
    tops = [_keys(at, height)] if at.cls == "piano" else surfaces(at)
    levels = sorted(tops, key=lambda surface: round(abs(at.position[2] + surface.z - height), 3) > _LEVEL)
    for surface in levels:
        z = at.position[2] + surface.z
        there = [(thing, where) for thing, where in standing if _stands(where, z)]
        top = _seen_from(person, at, surface, there, motion)
        edge = _edge(top)
        if edge is not None and (abs(z - height) <= _LEVEL or (_LOW <= z <= _HIGH)):
            return Before(top, z, edge)
    return None


def _keys(piano: SceneObject, height: float) -> Surface:
    """The keyboard of a piano, at a height above the floor."""
    w, d, _ = piano.size
    return Surface(height - piano.position[2], -0.44 * w, 0.44 * w, 0.13 * d, 0.47 * d, 9.0)


def _stands(where: ThingState, height: float) -> bool:
    return abs(where.position[2] - height) < _LEVEL


def _seen_from(
    person: PersonState, at: SceneObject, surface: Surface, standing: Standing, motion: Motion | None
) -> Worktop:
    """A surface with its marks and what stands on it, in the frame of a person's body."""
    middle = at.to_world((surface.x0 + surface.x1) / 2, (surface.y0 + surface.y1) / 2, surface.z)
    half = ((surface.x1 - surface.x0) / 2, (surface.y1 - surface.y0) / 2)
    marks = [(x * at.size[0], y * at.size[1]) for x, y in BURNERS] if at.cls == "stove" else []
    places = [middle, *(at.to_world(*mark, 0.0) for mark in marks), *(where.position for _, where in standing)]
    turned = (np.array(places)[:, :2] - np.array(person.place)) @ about_z(person.yaw)[:2, :2]
    (x, y), *rest = [(float(x), float(y)) for x, y in turned]
    things = [(place, thing) for place, (thing, _) in zip(rest[len(marks) :], standing, strict=True)]
    return Worktop(
        *(x, y, wrapped(at.yaw - person.yaw), *half),
        marks=tuple(rest[: len(marks)]),
        taken=tuple((*place, max(thing.size[:2]) / 2) for place, thing in things),
        tools=tuple(place for place, thing in things if motion is not None and _is_tool_of(motion, thing)),
    )


def _is_tool_of(motion: Motion, thing: SceneObject) -> bool:
    said = affordances().of(motion.caption)
    return affordances().is_one_of(thing.cls, (*said.lies, *said.tools))


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
    found = worktop_before(scene, person, standing, motion)
    top: Worktop | None = None
    if found is not None:
        top, setting = found.top, setting._replace(worktop=found.height)
        if person.posture == "stand" and found.edge > _EDGE:
            step = min(found.edge - _EDGE, _STEP)
            setting, top = setting._replace(step=step), top.stepped(step)
    elif person.posture in ("sit", "floor"):  # what stands beside or behind who sits is no use to the hands
        top, setting = LAP, setting._replace(worktop=None)
    if thing is None:
        return to_tools(motion, setting, top), CARRIED
    names = [thing.cls] if text is None else [text, thing.cls]
    setting, how = grip(motion, setting, names, thing.size, top)
    if how.laid is not None and setting.step:
        how = how._replace(laid=how.laid._replace(x=how.laid.x + setting.step))
    return setting, how


def working(
    scene: Scene, state: HomeState, person: PersonState, motion: Motion, moved: Mapping[str, ThingState] | None = None
) -> tuple[Setting, Grip]:
    """The same for a person with what they have in hand; `moved` is what was put elsewhere since that state."""
    near = _near(scene, state, person, moved or {})
    if person.thing is None:
        return at_work(scene, person, motion, standing=near)
    known = state.box.get(person.thing)
    text = known.text if known else None
    return at_work(scene, person, motion, thing_of(scene, state, person.thing), text=text, standing=near)


def surface_at_work(
    scene: Scene,
    state: HomeState,
    person: PersonState,
    motion: Motion,
    moved: Mapping[str, ThingState],
    setting: Setting,
) -> Worktop | None:
    """The surface that a person works at in a setting, in the frame of the body that has stepped up to it."""
    found = worktop_before(scene, person, _near(scene, state, person, moved), motion)
    return None if found is None else found.top.stepped(setting.step)


def reaching_in(scene: Scene, person: PersonState, motion: Motion) -> Motion | None:
    """The motion as it is done inside the furniture at which a person stands, behind its doors.

    None for a motion that is not done inside things, and at furniture without doors.
    """
    at = scene.object(person.at) if person.at is not None else None
    if at is None or motion.keys.inside is None or not opened(at).leaves:
        return None
    return motion.model_copy(update={"keys": motion.keys.model_copy(update={"right": motion.keys.inside})})


def kept_from_sight(
    scene: Scene, state: HomeState, person: PersonState, moved: Mapping[str, ThingState], brought: Sequence[str]
) -> frozenset[str]:
    """Things near a person that pictures leave out, since a thing of the same kind is shown in use there.

    Of each kind that is brought it is the nearest thing that stands about and bears no other.

    Args:
        scene: The home.
        state: What is where in it.
        person: Where and how the body is.
        moved: What was put elsewhere since that state.
        brought: What is shown besides the home's own things, by its class or its text.
    """
    kinds = {shape_of(plain(one)).cls for one in brought}
    if not kinds:
        return frozenset()
    placed = {thing.name: moved.get(thing.name) or state.thing(thing) for thing in state.objects(scene)}
    bearing = {name for where in placed.values() for name in (where.on, where.inside)}
    found: dict[str, tuple[float, str]] = {}
    for thing, where in _near(scene, state, person, moved):
        known, away = state.box.get(thing.name), round(math.dist(where.position[:2], person.place), 6)
        cls = thing.cls if known is None else shape_of(known.text).cls
        about = not thing.fixed and thing.name not in bearing and where.inside is None
        if cls in kinds and about and state.bearer(thing.name) is None:
            found[cls] = min(found.get(cls, (math.inf, "")), (away, thing.name))
    return frozenset(name for _, name in found.values())


def _near(scene: Scene, state: HomeState, person: PersonState, since: Mapping[str, ThingState]) -> Standing:
    """The other things that are near a person, and the furniture."""
    others = [thing for thing in state.objects(scene) if thing.name != person.thing]
    standing = [(thing, since.get(thing.name) or state.thing(thing)) for thing in others]
    standing += [(piece, ThingState(position=piece.position, yaw=piece.yaw, on=None)) for piece in scene.fixed]
    return [(thing, where) for thing, where in standing if math.dist(where.position[:2], person.place) < _NEAR]


def thing_of(scene: Scene, state: HomeState, name: str) -> SceneObject:
    """A thing by its name, or, where it comes out of the magic box only now, by what it is called."""
    known = state.find(scene, name)
    return known or from_box(_NO_NAME.sub("_", f"thing {name}".lower()), BoxThing(id=0, text=plain(name)))
