"""What a motion is done with: tools that are fetched to the furniture first, and the thing in hand."""

from __future__ import annotations

import math
from collections.abc import Iterator

from coopera.core.affordances import Affordance, Classes, Gather, affordances
from coopera.core.household import AgentId, FreeMotion, plain
from coopera.simulation.acts.fitting import in_hand_is
from coopera.simulation.acts.free_places import free_places
from coopera.simulation.acts.plans import Ground, Plan, UnableError, Watch
from coopera.simulation.acts.skills import empty_hand, put, put_away, take
from coopera.simulation.acts.state import HomeState, PersonState
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject

_AT_HAND = 0.6
"""A tool that lies this near to the hands (metres, on the floor plan) need not be moved."""
_TRIES = 2


def bring_tool(
    ground: Ground,
    plan: Plan,
    agent: AgentId,
    act: FreeMotion,
    done: Affordance,
    target: SceneObject,
    body: PersonState,
    hands: Point,
    watch: Watch | None,
) -> SceneObject | None:
    """Add to a plan that the tool of a motion lies at the furniture near the hands; the nearest one is fetched.

    Returns:
        The tool, if it is not the thing in hand; None where there is none, and none is needed.

    Raises:
        UnableError: If one is needed, and there is none that can be got there.
    """
    if not done.tools or in_hand_is(ground, plan.state, act.in_hand, done.tools):
        return None
    trouble = ""
    found = list(_tools(ground, plan.state, agent, done.tools, target, hands))
    for tool in found[:_TRIES]:
        if _lies_ready(plan.state, tool, target, hands):
            return tool
        mark = plan.mark()
        try:
            _fetch(ground, plan, agent, tool, target, body, hands, watch)
        except UnableError as unable:
            plan.rewind(mark)
            trouble = str(unable)
            continue
        return tool
    if done.needs:
        names = affordances().names(done.needs)
        raise UnableError(trouble or f"{act.motion!r} takes a {plain(names[0])}, and there is none to be had")
    return None


def gather(
    ground: Ground, plan: Plan, agent: AgentId, wanted: Gather, target: SceneObject, hands: Point, watch: Watch | None
) -> None:
    """Add to a plan that what a chore is about is brought to the furniture, such as dirty dishes to the sink.

    What cannot be got there, or finds no place, is left where it is.
    """
    relation = "inside" if wanted.inside and affordances().contains(target.cls) else "on"
    moved = 0
    for thing in _by_distance(ground, plan.state, hands):
        condition = plan.state.condition(thing)
        if moved == wanted.most:
            return
        if not affordances().is_one_of(thing.cls, wanted.of) or condition.get("clean", wanted.clean) == (
            not wanted.clean
        ):
            continue
        where = plan.state.thing(thing)
        if "clean" not in condition or target.name in (where.on, where.inside):
            continue
        mark = plan.mark()
        try:
            empty_hand(ground, plan, agent, watch)
            take(ground, plan, agent, thing, watch)
            put(ground, plan, agent, thing, target, watch, relation=relation, near=hands)
        except UnableError:
            plan.rewind(mark)
            continue
        plan.fetched.append(thing.name)
        moved += 1


def take_in_hand(ground: Ground, plan: Plan, agent: AgentId, name: str, watch: Watch | None) -> None:
    """Add to a plan that a thing is in hand: one of the home is fetched, and any other comes out of the magic box.

    A thing from the box that is in hand already, such as one that a robot brought, is kept.

    Raises:
        UnableError: If it cannot be reached or had, or there is no place to put away what is in hand.
    """
    wanted = plan.state.object(ground.scene, name)
    held = plan.state.agents[agent].thing
    if wanted is None:
        if held is not None and held in plan.state.box and plan.state.box[held].text == name:
            return
        empty_hand(ground, plan, agent, watch)
        plan.state = plan.state.out_of_box(ground.scene, agent, name)
        return
    empty_hand(ground, plan, agent, watch, keep=wanted.name)
    if held != wanted.name:
        take(ground, plan, agent, wanted, watch)
        plan.fetched.append(wanted.name)


def undress(ground: Ground, plan: Plan, agent: AgentId, watch: Watch | None) -> None:
    """Add to a plan that a person takes off what they wear: things from the magic box go back, others are put away.

    Raises:
        UnableError: If there is no place to put one away.
    """
    empty_hand(ground, plan, agent, watch)
    for name in plan.state.person(agent).worn:
        if name in plan.state.box:
            plan.state = plan.state.into_box(name)
        else:
            plan.state = plan.state.with_held(agent, name)
            put_away(ground, plan, agent, watch)


def _fetch(
    ground: Ground,
    plan: Plan,
    agent: AgentId,
    tool: SceneObject,
    target: SceneObject,
    body: PersonState,
    hands: Point,
    watch: Watch | None,
) -> None:
    empty_hand(ground, plan, agent, watch, keep=tool.name)
    take(ground, plan, agent, tool, watch)
    resting = body.place if math.dist(body.spot, body.place) > 0.1 else None
    put(ground, plan, agent, tool, target, watch, near=hands, clear_of_body=resting)
    plan.fetched.append(tool.name)


def _tools(
    ground: Ground, state: HomeState, agent: AgentId, wanted: Classes, target: SceneObject, hands: Point
) -> Iterator[SceneObject]:
    """Things of the home that would do and that nobody else has: clean ones first, then those near to the hands."""
    known = affordances()
    things = [thing for thing in _by_distance(ground, state, hands) if known.is_one_of(thing.cls, wanted)]
    things = [thing for thing in things if state.bearer(thing.name) in (None, agent)]
    things = [thing for thing in things if thing.name not in state.agents[agent].worn]
    yield from sorted(
        (
            thing
            for thing in things
            if _lies_ready(state, thing, target, hands) or free_places(ground.scene, state, thing, target)
        ),
        key=lambda thing: state.condition(thing).get("clean") is False,
    )


def _by_distance(ground: Ground, state: HomeState, hands: Point) -> list[SceneObject]:
    def away(thing: SceneObject) -> tuple[float, str]:
        x, y, _ = state.thing(thing).position
        return round(math.dist((x, y), hands), 3), thing.name

    return sorted(state.objects(ground.scene), key=away)


def _lies_ready(state: HomeState, thing: SceneObject, target: SceneObject, hands: Point) -> bool:
    where = state.thing(thing)
    return where.on == target.name and math.dist(where.position[:2], hands) <= _AT_HAND
