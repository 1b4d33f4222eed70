"""What a motion is done with: tools that are fetched to the furniture first, and the thing in hand."""

from __future__ import annotations

import math
from typing import NamedTuple

from coopera.core.affordances import Affordance, Classes, Gather, Relation, affordances
from coopera.core.household import AgentId, FreeMotion, plain
from coopera.simulation.acts.fitting import in_hand_is
from coopera.simulation.acts.plans import Ground, Plan, UnableError, Watch, on_furniture
from coopera.simulation.acts.skills import There, empty_hand, put, take, take_off
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.state.free_places import free_places
from coopera.simulation.state.home_state import HomeState, PersonState

_AT_HAND = 0.35
"""A tool that lies this near to the hands (metres, on the floor plan) need not be moved."""
_WORTH_IT = 0.1
"""It is moved only if that brings it this much nearer."""
_TRIES = 6


class Workplace(NamedTuple):
    """Where a motion will be done: the furniture, the body there, and its hands on the floor plan."""

    target: SceneObject
    body: PersonState
    hands: Point


def bring_tool(
    ground: Ground,
    plan: Plan,
    agent: AgentId,
    act: FreeMotion,
    done: Affordance,
    at: Workplace,
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
    if at.target.cls in affordances().looked_at and not done.needs:  # nothing is put on a television to eat from it
        return None
    trouble = ""
    for tool in _tools(ground, plan.state, agent, done.tools, at)[:_TRIES]:
        if _lies_ready(ground, plan.state, tool, at):
            return tool
        mark = plan.mark()
        try:
            _fetch(ground, plan, agent, tool, at, watch)
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
    ground: Ground, plan: Plan, agent: AgentId, wanted: Gather, at: Workplace, in_hand: str, watch: Watch | None
) -> None:
    """Add to a plan that what a chore is about is brought to the furniture, such as dirty dishes to the sink.

    What cannot be got there, or finds no place, is left where it is, and so is what is to be in hand.
    """
    relation: Relation = "inside" if wanted.inside and affordances().contains(at.target.cls) else "on"
    moved = 0
    for thing in _by_distance(ground, plan.state, at.hands):
        if moved == wanted.most:
            return
        if thing.name == in_hand or not _is_wanted(plan.state, thing, wanted, at.target):
            continue
        if not free_places(ground.scene, plan.state, thing, at.target, relation):  # there are no more once it is taken
            continue
        mark = plan.mark()
        try:
            empty_hand(ground, plan, agent, watch)
            take(ground, plan, agent, thing, watch)
            put(ground, plan, agent, thing, There(at.target, relation, near=at.hands), watch)
        except UnableError:
            plan.rewind(mark)
            continue
        plan.fetched.append(thing.name)
        moved += 1


def _is_wanted(state: HomeState, thing: SceneObject, wanted: Gather, target: SceneObject) -> bool:
    """Whether a chore is about a thing: it is of the right kind and in the right state, and not there yet.

    What goes inside has to be usual there: dishes into the dishwasher, shirts into the washing machine.
    """
    where, known = state.thing(thing), affordances()
    return (
        known.is_one_of(thing.cls, wanted.of)
        and (not wanted.inside or known.relation(thing.cls, target.cls) == "inside")
        and state.bearer(thing.name) is None
        and (where.inside is None or state.bearer(where.inside) is None)
        and state.condition(thing).get("clean") == wanted.clean
        and target.name not in (where.on, where.inside)
    )


def take_in_hand(ground: Ground, plan: Plan, agent: AgentId, name: str, watch: Watch | None) -> None:
    """Add to a plan that a thing is in hand: one of the home is fetched, and any other comes out of the magic box.

    A thing from the box that is in hand already, such as one that a robot brought, is kept.

    Raises:
        UnableError: If it cannot be reached or had, or there is no place to put away what is in hand.
    """
    wanted = plan.state.find(ground.scene, name)
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
        take_off(plan, agent, name)
        empty_hand(ground, plan, agent, watch)


def _fetch(ground: Ground, plan: Plan, agent: AgentId, tool: SceneObject, at: Workplace, watch: Watch | None) -> None:
    empty_hand(ground, plan, agent, watch, keep=tool.name)
    take(ground, plan, agent, tool, watch)
    rests = at.body.place if on_furniture(at.body) else None
    put(ground, plan, agent, tool, There(at.target, near=at.hands, apart=rests), watch)
    plan.fetched.append(tool.name)


def _tools(ground: Ground, state: HomeState, agent: AgentId, wanted: Classes, at: Workplace) -> list[SceneObject]:
    """Things of the home that would do and can be had: clean ones first, then as they are named, then near ones."""
    known = affordances()
    order = {name: rank for rank, name in enumerate(known.names(wanted))}
    found = [
        thing
        for thing in _by_distance(ground, state, at.hands)
        if known.is_one_of(thing.cls, wanted) and _can_be_had(ground, state, agent, thing)
    ]
    return sorted(found, key=lambda one: (state.condition(one).get("clean") is False, order.get(one.cls, len(order))))


def _can_be_had(ground: Ground, state: HomeState, agent: AgentId, thing: SceneObject) -> bool:
    """Whether a thing lies about, is in this hand, or in the gripper of a robot, which would bring it."""
    bearer, around = state.bearer(thing.name), state.thing(thing).inside
    if around is not None and state.bearer(around) is not None:
        return False
    return bearer in (None, agent) or (bearer in ground.robots and state.agents[bearer].thing == thing.name)


def _by_distance(ground: Ground, state: HomeState, hands: Point) -> list[SceneObject]:
    def away(thing: SceneObject) -> tuple[float, str]:
        x, y, _ = state.thing(thing).position
        return round(math.dist((x, y), hands), 3), thing.name

    return sorted(state.objects(ground.scene), key=away)


def _lies_ready(ground: Ground, state: HomeState, thing: SceneObject, at: Workplace) -> bool:
    """Whether a tool lies at the furniture within reach of the hands, or as near to them as there is a place."""
    where = state.thing(thing)
    away = math.dist(where.position[:2], at.hands)
    if where.on != at.target.name or away <= _AT_HAND:
        return where.on == at.target.name
    places = free_places(ground.scene, state, thing, at.target)
    return all(math.dist(place[:2], at.hands) > away - _WORTH_IT for place in places)
