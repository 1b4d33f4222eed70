"""What a body rests on: the seat or the bed that serves a piece of furniture, and whether somebody is on it already."""

from __future__ import annotations

import math

from coopera.core.affordances import affordances
from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Ground, on_furniture
from coopera.simulation.homes.catalogue import Rest, lying_place, seat
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.rotations import wrapped
from coopera.simulation.state.home_state import HomeState
from coopera.simulation.ways.navigation import Disc

SEAT_NEAR = 0.9
"""A seat this near to a table or an instrument serves it (metres between their rectangles)."""
SEAT_FAR = 5.0
"""A seat this near serves what is only looked at or listened to."""
_LOOKS_AT = math.radians(70)
"""A seat serves a table only if one looks at it from there."""
_LIE_ON_WIDTH = ("sofa", "bench")
_LONG = 1.5
_SITTING, _LYING = 0.5, 0.9
"""Nobody else sits nearer than this to who sits, or lies (metres between the bodies' middles)."""
_ASIDE = 0.6
"""How far beside the middle of a wide seat another one sits (metres)."""


def used_by_others(state: HomeState, agent: AgentId) -> list[Disc]:
    """The furniture that other people are on: the places of their bodies, and how near to them nobody else fits."""
    people = [state.person(one) for one in state.ids("person") if one != agent]
    on_it = [person for person in people if on_furniture(person)]
    return [Disc(*person.place, _LYING if person.posture == "lie" else _SITTING) for person in on_it]


def fits(place: Point, used: list[Disc]) -> bool:
    """Whether nobody is on the furniture so near to a place that one would not fit there."""
    return all(math.dist(place, (disc.x, disc.y)) >= disc.radius for disc in used)


def _seat_on(thing: SceneObject, used: list[Disc]) -> Rest | None:
    """Where one sits on a thing: in its middle, or beside who sits there; None where one does not, or it is taken."""
    middle = seat(thing)
    if middle is None:
        return None
    along, wide = thing.yaw, thing.size[0]
    if thing.measured is not None and thing.measured.seat is not None:
        along, wide = middle.heading - math.pi / 2, thing.measured.seat.wide
    cos, sin = math.cos(along), math.sin(along)
    for aside in (0.0, _ASIDE, -_ASIDE):
        rest = middle._replace(x=middle.x + aside * cos, y=middle.y + aside * sin)
        if (aside == 0.0 or wide >= 2 * _ASIDE + _SITTING) and fits((rest.x, rest.y), used):
            return rest
    return None


def seat_for(ground: Ground, target: SceneObject, used: list[Disc]) -> tuple[SceneObject, Rest] | None:
    """The target itself where one sits on it; else the seat of its room that is near and looks at it best."""
    if used:
        return _seat_among(ground, target, used)
    if target.name not in ground.seats:
        ground.seats[target.name] = _seat_among(ground, target, used)
    return ground.seats[target.name]


def _seat_among(ground: Ground, target: SceneObject, used: list[Disc]) -> tuple[SceneObject, Rest] | None:
    own = _seat_on(target, used)
    if own is not None:
        return target, own
    far = SEAT_FAR if target.cls in affordances().looked_at else SEAT_NEAR
    found: list[tuple[float, str, SceneObject, Rest]] = []
    for thing in ground.scene.fixed:
        if thing.room != target.room or thing.cls in ("toilet", "bathtub"):
            continue
        gap = thing.bounds.gap(target.bounds)
        rest = _seat_on(thing, used) if gap <= far else None
        if rest is not None and target.bounds.distance(rest.x, rest.y) <= far:
            off = abs(wrapped(math.atan2(target.xy[1] - rest.y, target.xy[0] - rest.x) - rest.heading))
            if off <= _LOOKS_AT:
                found.append((round(gap + 0.6 * off, 6), thing.name, thing, rest))
    if not found:
        return None
    _, _, chair, rest = min(found, key=lambda row: row[:2])
    return chair, rest


def bed_for(target: SceneObject, used: list[Disc]) -> tuple[SceneObject, Rest] | None:
    """The target, where one lies on it, along a sofa or a bench too; None where one does not, or somebody is on it."""
    if any(target.bounds.distance(disc.x, disc.y) <= 0 for disc in used):
        return None
    rest = lying_place(target)
    if rest is not None:
        return target, rest
    sitting = seat(target)
    if sitting is None or target.cls not in _LIE_ON_WIDTH:
        return None
    if target.measured is not None and target.measured.seat is not None:
        long = target.measured.seat.wide
        return (target, sitting._replace(heading=sitting.heading - math.pi / 2)) if long > _LONG else None
    return (target, sitting._replace(heading=target.yaw)) if target.size[0] > _LONG else None
