"""Bodies that share the floor: walking around each other, and giving way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import (
    Ground,
    Placed,
    Plan,
    UnableError,
    Walk,
    Watch,
    discs,
    floor_of_others,
    stand_up,
)
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.state.agents import named
from coopera.simulation.state.home_state import HomeState, PersonState
from coopera.simulation.ways.navigation import RADIUS, Disc, Route

_THERE = 0.02
_DETOUR = 4.0
"""Longest way around the others, in metres more than the straight way, before they are asked to step aside."""
_ASIDES = 16
"""How many places to step aside to are tried."""


def walk(
    ground: Ground, plan: Plan, agent: AgentId, goal: Point, carries: str | None = None, *, backs: bool = True
) -> None:
    """Add a walk to a plan: around the others, or past them once they have stepped aside.

    Where somebody can step aside only past the walker, as in a dead end, the walker backs out of their way before;
    without `backs` it does not.

    Raises:
        UnableError: If there is no way.
    """
    start = plan.state.agents[agent].spot
    if math.dist(start, goal) < _THERE:
        if agent in ground.people:
            plan.state = _arrived(ground, plan.state, agent, start)
        return
    straight = ground.navigator.route(start, goal)
    if straight.points is None:
        raise UnableError(f"{named(agent)} cannot get there: {straight.reason}")
    floor = floor_of_others(plan.state, agent)
    route = _around(ground, straight, start, goal, floor)
    if route is None:
        route = straight
        for one in [one for one, found in floor.items() if _in_the_way(straight, found)]:
            if _step_aside(ground, plan, one, straight):
                continue
            if backs and _let_past(ground, plan, one, agent, straight, goal, carries):
                return
            raise UnableError(f"{named(one)} stands in the way and has nowhere to step aside")
    _go(ground, plan, agent, route, carries)
    plan.metres += route.length


def walk_to_deed(
    ground: Ground,
    plan: Plan,
    agent: AgentId,
    deeds: Sequence[Placed],
    goal: Point,
    watch: Watch | None,
    carries: str | None,
) -> None:
    """Add a person's walk to an act; a robot that is to see it goes ahead, and comes back if it had to step aside.

    Raises:
        UnableError: If there is no way.
    """
    if watch is None:
        walk(ground, plan, agent, goal, carries)
        return
    watch(plan, deeds, goal)
    place = plan.state.agents[watch.robot].spot
    walk(ground, plan, agent, goal, carries)
    if plan.state.agents[watch.robot].spot != place:
        watch(plan, deeds, goal)


def _arrived(ground: Ground, state: HomeState, agent: AgentId, spot: Point) -> HomeState:
    """The home with an agent standing at a spot; a robot keeps its heading."""
    body = state.agents[agent]
    if isinstance(body, PersonState):
        return stand_up(ground, state, agent, spot)
    return state.with_agent(agent, spot=spot)


def _around(
    ground: Ground, straight: Route, start: Point, goal: Point, floor: Mapping[AgentId, list[Disc]]
) -> Route | None:
    """The straight way if it is free, else one around everybody in it; None where that is too long or leads nowhere."""
    route, avoid = straight, dict[AgentId, Disc]()
    while (hit := _first_in_the_way(route, floor)) is not None:
        if hit[0] in avoid:
            return None
        avoid[hit[0]] = hit[1]
        route = ground.navigator.route(start, goal, avoid=tuple(avoid.values()))
        if route.points is None or route.length > straight.length + _DETOUR:
            return None
        if math.dist(route.points[-1], goal) >= 0.08:
            return None
    return route


def _first_in_the_way(route: Route, floor: Mapping[AgentId, list[Disc]]) -> tuple[AgentId, Disc] | None:
    hits = ((one, _in_the_way(route, found)) for one, found in floor.items())
    return next(((one, hit) for one, hit in hits if hit is not None), None)


def _in_the_way(route: Route, taken: list[Disc]) -> Disc | None:
    """The first disc that a walker on the route would touch; the start is left out, since they are there already."""
    points = route.points or []
    for disc in taken:
        need = disc.radius + RADIUS - 0.01
        for a, b in zip(points, points[1:], strict=False):
            if _to_line((disc.x, disc.y), a, b) < min(need, math.dist(points[0], (disc.x, disc.y)) - 0.01):
                return disc
    return None


def _to_line(point: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = dx * dx + dy * dy
    share = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / length if length > 0 else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (a[0] + share * dx, a[1] + share * dy))


def _step_aside(ground: Ground, plan: Plan, agent: AgentId, route: Route) -> bool:
    """Let an agent in the way go where the walker passes it, past nobody's body; False where it cannot."""
    way = next(_ways_aside(ground, plan, agent, route, floor_of_others(plan.state, agent)), None)
    if way is not None:
        _go(ground, plan, agent, way)
    return way is not None


def _let_past(
    ground: Ground, plan: Plan, agent: AgentId, walker: AgentId, route: Route, goal: Point, carries: str | None
) -> bool:
    """Let a walker back out for an agent that can step aside only past it, and then go on; False where that fails."""
    mark = plan.mark()
    for way in _ways_aside(ground, plan, agent, route, floor_of_others(plan.state, agent, walker)):
        floor = {**floor_of_others(plan.state, walker), agent: [*discs(plan.state, agent), Disc(*_end(way))]}
        back = next(_ways_aside(ground, plan, walker, way, floor), None)
        if back is None:
            continue
        _go(ground, plan, walker, back, carries)
        plan.metres += back.length
        _go(ground, plan, agent, way)
        try:
            walk(ground, plan, walker, goal, carries, backs=False)
        except UnableError:
            plan.rewind(mark)
            continue
        return True
    return False


def _ways_aside(
    ground: Ground, plan: Plan, agent: AgentId, route: Route, floor: Mapping[AgentId, list[Disc]]
) -> Iterator[Route]:
    """Ways to places near an agent that leave a route free, and to which one gets past what others take up."""
    here = plan.state.agents[agent].spot
    taken = [disc for found in floor.values() for disc in found]
    for aside in islice(ground.navigator.give_way(here, route.points or [], taken=taken), _ASIDES):
        way = ground.navigator.route(here, aside)
        free = _around(ground, way, here, aside, floor) if way.points is not None else None
        if free is not None:
            yield free


def _go(ground: Ground, plan: Plan, agent: AgentId, route: Route, carries: str | None = None) -> None:
    plan.steps.append(Walk(agent, route.points or [], carries))
    plan.state = _arrived(ground, plan.state, agent, _end(route))


def _end(route: Route) -> Point:
    """Where a walk that there is ends."""
    return (route.points or [])[-1]
