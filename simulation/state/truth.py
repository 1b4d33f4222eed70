"""What must be true of a home at every moment, worked out from where everything is: each problem is one sentence.

`wrong` finds what makes a state unusable (two places for a thing, unknown names, no numbers); `problems` also finds
what cannot be seen in any home: things that float, overlap, or lie outside what holds them.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from coopera.core.affordances import affordances, problem_of
from coopera.core.household import AgentId
from coopera.simulation.homes.catalogue import interiors, surfaces
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.homes.spots import Array, Taken, taken_by
from coopera.simulation.state.agents import named
from coopera.simulation.state.free_places import filled
from coopera.simulation.state.home_state import AgentState, HomeState, PersonState, ThingState
from coopera.simulation.ways.navigation import Navigator

_MARGIN = 1.0
"""Nothing is farther outside the rectangle around all rooms than this, in metres."""
_LOWEST, _HIGHEST = -0.05, 4.0
_TURNS = 100.0
_SLACK = 0.02
_FLOATING = 0.03
_COMMON = 0.01
"""Two things may share this much in each direction, in metres."""
_FROM_SPOT = 2.2
"""Farthest that a body on a piece of furniture is from where its person would stand, in metres."""
_SUPPORT = 2.0


def wrong(scene: Scene, state: HomeState, motions: Container[str] | None = None) -> Iterator[str]:
    """Yield what makes a state unusable, in a fixed order; nothing for a good one.

    Every thing has exactly one place, names are those of the home, numbers are finite and within it, and conditions are
    such as their objects have. With `motions`, everybody does one of these.
    """
    known = {thing.name: thing for thing in (*scene.fixed, *state.objects(scene))}
    yield from _box(scene, state)
    yield from _hands(state, known)
    yield from _once(state, known)
    for name, where in state.moved.items():
        yield from _where(scene, state, known, name, where)
    for agent, body in state.agents.items():
        yield from _body(scene, known, _start(agent), body)
        if motions is not None and isinstance(body, PersonState) and body.motion not in motions:
            yield f"{_start(agent)} does {body.motion!r}, which is no motion."
    yield from _conditions(state, known)


def problems(scene: Scene, state: HomeState, navigator: Navigator | None = None) -> Iterator[str]:
    """Yield everything that is not as it must be, in a fixed order; nothing for a good state.

    What `wrong` finds, and only without that what the places on the floor plan and the heights show. With `navigator`,
    everybody must stand where a body fits.
    """
    found = list(wrong(scene, state))
    if found:
        yield from found
        return
    placed = [(thing, state.thing(thing)) for thing in state.objects(scene) if _lies_about(state, thing)]
    for thing, where in placed:
        yield from _held_up(scene, state, thing, where)
    yield from _overlaps(scene, placed)
    for agent, body in state.agents.items():
        if navigator is not None and not navigator.can_stand(*body.spot):
            yield f"{_start(agent)} stands at ({body.spot[0]:.2f}, {body.spot[1]:.2f}), where no body fits."
    for name, said in state.conditions.items():
        owner = state.find(scene, name)
        first = affordances().first(owner.cls) if owner is not None else {}
        if not said or any(first[key] == value for key, value in said.items()):
            yield f"The conditions of {name} hold what is as at first."


def _start(agent: AgentId) -> str:
    """An agent's words at the start of a sentence."""
    return named(agent)[:1].upper() + named(agent)[1:]


def _box(scene: Scene, state: HomeState) -> Iterator[str]:
    ids = {thing.id: thing.name for thing in scene.objects}
    for name, known in state.box.items():
        if scene.object(name) is not None:
            yield f"{name} is a thing of this home, and cannot be from the magic box."
        if known.id in ids:
            yield f"{name} and {ids[known.id]} have the same object id {known.id}."
        ids.setdefault(known.id, name)


def _hands(state: HomeState, known: dict[str, SceneObject]) -> Iterator[str]:
    for agent, body in state.agents.items():
        held = [body.thing] if body.thing is not None else []
        for name in (*held, *body.worn):
            how = "holds" if name == body.thing else "wears"
            if name not in known:
                yield f"{_start(agent)} {how} {name!r}, which this home does not have."
            elif known[name].fixed:
                yield f"{_start(agent)} {how} {name}, which is furniture."


def _once(state: HomeState, known: dict[str, SceneObject]) -> Iterator[str]:
    """Each thing has one place; one of the scene may be in none of these, where it was at first."""
    places: dict[str, list[str]] = {}
    for agent, body in state.agents.items():
        if body.thing is not None:
            places.setdefault(body.thing, []).append(f"in the hand of {named(agent)}")
        for name in body.worn:
            places.setdefault(name, []).append(f"worn by {named(agent)}")
    for name in state.moved:
        places.setdefault(name, []).append("put down")
    for name, found in places.items():
        if len(found) > 1:
            yield f"{name} is in more than one place: {' and '.join(found)}."
    for name in state.box:
        if name not in places:
            yield f"{name}, from the magic box, is nowhere."


def _where(
    scene: Scene, state: HomeState, known: dict[str, SceneObject], name: str, where: ThingState
) -> Iterator[str]:
    if name not in known:
        yield f"{name!r} is put down, but this home does not have it."
        return
    if known[name].fixed:
        yield f"{name} is furniture, and cannot be put elsewhere."
    yield from _numbers(scene, name, where.position[:2], where.yaw)
    if not _LOWEST <= where.position[2] <= _HIGHEST:
        yield f"{name} is at a height of {where.position[2]} m."
    if where.on is not None and (where.on not in known or not known[where.on].fixed):
        yield f"{name} is on {where.on!r}, which is no furniture of this home."
    if where.inside is None:
        return
    if where.inside not in known or not interiors(known[where.inside]):
        yield f"{name} is inside {where.inside!r}, which holds nothing."
    around = state.moved.get(where.inside)
    if where.inside == name or (around is not None and around.inside is not None):
        yield f"{name} is inside {where.inside}, which is itself inside something."


def _numbers(scene: Scene, who: str, place: tuple[float, float], yaw: float) -> Iterator[str]:
    """What is wrong with a place on the floor plan and a heading; no comparison holds of what is no number."""
    x, y = place
    edge = scene.bounds.grown(_MARGIN)
    if not (edge.x0 <= x <= edge.x1 and edge.y0 <= y <= edge.y1):
        yield f"{who} is at ({x}, {y}), which is outside this home."
    if not abs(yaw) <= _TURNS:
        yield f"{who} has the heading {yaw}, which is none in radians."


def _body(scene: Scene, known: dict[str, SceneObject], who: str, body: AgentState) -> Iterator[str]:
    yield from _numbers(scene, who, body.spot, body.yaw)
    if not isinstance(body, PersonState):
        return
    if not math.dist(body.spot, body.place) <= _FROM_SPOT:
        yield f"{who} is at {body.place}, too far from {body.spot}, where they would stand."
    if not -_SLACK <= body.support <= _SUPPORT:
        yield f"{who} is at a height of {body.support} m."
    if body.worktop is not None and not 0 <= body.worktop <= _SUPPORT:
        yield f"{who} works at a height of {body.worktop} m."
    if body.at is not None and (body.at not in known or not known[body.at].fixed):
        yield f"{who} is at {body.at!r}, which is no furniture of this home."
    for name in body.switched:
        if name not in known:
            yield f"{who} switched on {name!r}, which this home does not have."


def _conditions(state: HomeState, known: dict[str, SceneObject]) -> Iterator[str]:
    for name, said in state.conditions.items():
        if name not in known:
            yield f"{name!r} has conditions, but this home does not have it."
            continue
        has = affordances().first(known[name].cls)
        for key, value in said.items():
            if key not in has:
                yield f"{name} has no state {key!r}."
            elif trouble := problem_of(key, value):
                yield f"The state {key!r} of {name} {trouble}, and is {value!r}."


def _lies_about(state: HomeState, thing: SceneObject) -> bool:
    """Whether a thing is somewhere in the home, and not carried about in a hand or in what is in a hand."""
    if state.bearer(thing.name) is not None:
        return False
    where = state.moved.get(thing.name)
    return where is None or where.inside is None or state.bearer(where.inside) is None


def _held_up(scene: Scene, state: HomeState, thing: SceneObject, where: ThingState) -> Iterator[str]:
    """What is wrong with what carries or holds a thing, and with the room that it lies in."""
    x, y, z = where.position
    space = filled(thing, where)
    carrier = state.find(scene, where.on or where.inside or "")
    room = scene.room_at(x, y)
    if carrier is not None and carrier.fixed:
        room = scene.room(carrier.room) or room
    if not room.encloses(space.bounds, _SLACK):
        yield f"{thing.name} sticks out of the {room.name}."
    if carrier is None:
        if abs(z) > _FLOATING:
            yield f"{thing.name} is {z:.2f} m above the floor, on nothing."
    elif where.inside is not None:
        box = _space(state, carrier)
        within = box.low - _SLACK <= space.low and space.high <= box.high + _SLACK
        if not (within and box.bounds.encloses(space.bounds, _SLACK)):
            yield f"{thing.name} sticks out of {carrier.name}, which it should be inside of."
    else:
        aside, ahead = carrier.to_local(x, y)
        if abs(aside) > carrier.size[0] / 2 + _SLACK or abs(ahead) > carrier.size[1] / 2 + _SLACK:
            yield f"{thing.name} does not lie over {carrier.name}, which should carry it."
        heights = [carrier.position[2] + surface.z for surface in surfaces(carrier)]
        if not any(abs(z - height) <= _FLOATING for height in heights):
            said = ", ".join(f"{height:.2f}" for height in heights)
            yield f"{thing.name} is at a height of {z:.2f} m, but {carrier.name} carries things at {said}."


def _space(state: HomeState, thing: SceneObject) -> Taken:
    """The space that furniture or a thing fills now."""
    return taken_by(thing) if thing.fixed else filled(thing, state.thing(thing))


def _overlaps(scene: Scene, placed: list[tuple[SceneObject, ThingState]]) -> Iterator[str]:
    """Things that share space with other things, or with furniture that neither carries nor holds them."""
    names = [thing.name for thing, _ in placed]
    things = _rows(filled(thing, where) for thing, where in placed)
    for i, j in np.argwhere(_shared(things, _rows(map(taken_by, scene.fixed)))).tolist():
        where, other = placed[i][1], scene.fixed[j].name
        if other not in (where.on, where.inside) and not _within(placed, where, other):
            yield f"{names[i]} and {other} overlap."
    meet = _shared(things, things)
    for i, j in combinations(range(len(placed)), 2):
        if meet[i, j] and names[j] != placed[i][1].inside and names[i] != placed[j][1].inside:
            yield f"{names[i]} and {names[j]} overlap."


def _within(placed: list[tuple[SceneObject, ThingState]], where: ThingState, furniture: str) -> bool:
    """Whether what holds a thing is itself on or inside a piece of furniture."""
    around = next((known for thing, known in placed if thing.name == where.inside), None)
    return around is not None and furniture in (around.on, around.inside)


def _rows(spaces: Iterable[Taken]) -> Array:
    rows = [(s.bounds.x0, s.bounds.y0, s.low, s.bounds.x1, s.bounds.y1, s.high) for s in spaces]
    return np.array(rows, dtype=float).reshape(-1, 6)


def _shared(some: Array, others: Array) -> NDArray[np.bool_]:
    """Which boxes share more than a centimetre in every direction; shapes (n, 6) and (m, 6) to (n, m)."""
    low = np.maximum(some[:, None, :3], others[None, :, :3])
    high = np.minimum(some[:, None, 3:], others[None, :, 3:])
    return np.asarray((high - low > _COMMON).all(axis=2))
