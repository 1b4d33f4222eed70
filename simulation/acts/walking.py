"""Two bodies that share the floor: walking around each other, and giving way."""

from __future__ import annotations

import math

from coopera.core.household import Agent
from coopera.simulation.acts.navigation import RADIUS, Disc, Route
from coopera.simulation.acts.plans import Ground, Placed, Plan, UnableError, Walk, Watch, discs, other, stand_up
from coopera.simulation.homes.floorplan import Point

_THERE = 0.02
_DETOUR = 4.0
"""Longest way around the other one, in metres more than the straight way, before they are asked to step aside."""


def walk(ground: Ground, plan: Plan, agent: Agent, goal: Point, carries: str | None = None) -> None:
    """Add a walk to a plan: around the other one, or past them once they have stepped aside.

    Raises:
        UnableError: If there is no way.
    """
    start = plan.state.spot(agent)
    if math.dist(start, goal) < _THERE:
        if agent == "human":
            plan.state = plan.state.model_copy(update={"person": stand_up(plan.state.person, start)})
        return
    route = ground.navigator.route(start, goal)
    if route.points is None:
        raise UnableError(f"the {agent} cannot get there: {route.reason}")
    hit = _in_the_way(route, discs(plan.state, other(agent)))
    if hit is not None:
        around = ground.navigator.route(start, goal, avoid=hit)
        if (
            around.points is not None
            and around.length <= route.length + _DETOUR
            and math.dist(around.points[-1], goal) < 0.08
            and _in_the_way(around, discs(plan.state, other(agent))) is None
        ):
            route = around
        else:
            _step_aside(ground, plan, other(agent), route)
    points = route.points or [start, goal]
    plan.steps.append(Walk(agent, points, carries))
    plan.metres += route.length
    last = points[-1]
    if agent == "human":
        plan.state = plan.state.model_copy(update={"person": stand_up(plan.state.person, last)})
    else:
        plan.state = plan.state.with_robot(spot=last)


def walk_to_deed(
    ground: Ground, plan: Plan, deed: Placed, goal: Point, watch: Watch | None, carries: str | None
) -> None:
    """Add the person's walk to an act; a robot that is to see it goes ahead, and comes back if it had to step aside.

    Raises:
        UnableError: If there is no way.
    """
    if watch is None:
        walk(ground, plan, "human", goal, carries)
        return
    watch(plan, deed, goal)
    place = plan.state.robot.spot
    walk(ground, plan, "human", goal, carries)
    if plan.state.robot.spot != place:
        watch(plan, deed, goal)


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


def _step_aside(ground: Ground, plan: Plan, agent: Agent, route: Route) -> None:
    """Let the agent in the way go where the walker passes it."""
    here = plan.state.spot(agent)
    aside = ground.navigator.give_way(here, route.points or [])
    way = ground.navigator.route(here, aside) if aside is not None else None
    if way is None or way.points is None:
        raise UnableError(f"the {agent} stands in the way and has nowhere to step aside")
    plan.steps.append(Walk(agent, way.points))
    if agent == "human":
        plan.state = plan.state.model_copy(update={"person": stand_up(plan.state.person, way.points[-1])})
    else:
        plan.state = plan.state.with_robot(spot=way.points[-1])
