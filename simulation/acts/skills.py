"""What people and robots do with things: take one, put it down, open what it is in, put one away.

A skill is planned completely before anything changes: the plan holds the steps (which a recording plays) and the
home as it will be afterwards. What cannot be planned raises `UnableError`, and the home stays as it was.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from coopera.core.affordances import Relation, affordances
from coopera.core.household import AgentId, HandOver, PickPlace, plain
from coopera.simulation.acts.fitting import check_receptacle
from coopera.simulation.acts.handing import ask_for, give, receiver_of
from coopera.simulation.acts.handling import FAR_REACH, Errand, go_to_reach, grip, why
from coopera.simulation.acts.plans import Dress, Ground, Handle, Open, Plan, UnableError, Watch
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.homes.spots import Spot
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.state.agents import named
from coopera.simulation.state.free_places import free_places, full, where_it_is
from coopera.simulation.state.home_state import HomeState, ThingState
from coopera.simulation.ways.home_check import FLOOR_REACH
from coopera.simulation.ways.navigation import REACH, Stand

_BESIDE = 0.35
_PLACES = 8
"""How many of the free places are tried, spread over all of them."""


def take(ground: Ground, plan: Plan, agent: AgentId, thing: SceneObject, watch: Watch | None = None) -> None:
    """Add to a plan: go to a thing and take it in hand, which must be empty unless it is there already.

    What it is in is opened for it and closed again. What another one holds is asked for; what one wears is taken off.

    Raises:
        UnableError: If there is no place to stand, or the arm gets there from none, or another one will not give it.
    """
    state = plan.state
    if state.agents[agent].thing == thing.name:
        return
    _refuse_full_hand(ground, state, agent)
    if thing.name in state.agents[agent].worn:
        take_off(plan, agent, thing.name)
        return
    holder = state.bearer(thing.name)
    if holder is not None:
        ask_for(ground, plan, agent, holder, thing)
        return
    where = state.thing(thing)
    container = _container(ground, state, where)
    if container is not None and (bearer := state.bearer(container.name)) is not None:
        raise UnableError(f"the {plain(thing.name)} is inside the {plain(container.name)}, which {named(bearer)} has")
    carrier = _carrier(ground, state, container if container is not None else thing)
    found = go_to_reach(ground, plan, agent, Errand(grip(thing, where.position), carrier), watch)
    if found is None:
        raise UnableError(f"{named(agent)} cannot reach the {plain(thing.name)}{why(plan)}")

    def grasp() -> None:
        plan.steps.append(Handle(agent, *found, thing.name, None))
        plan.state = plan.state.with_held(agent, thing.name)

    _opening(plan, agent, container, found, grasp)
    if carrier is not None:
        plan.at.append(carrier.name)


class There(NamedTuple):
    """Where a thing is to be put: on or inside a receptacle, furniture or a thing that holds others.

    `near` is a point on the floor plan to which it should come as near as there is a place; `apart` is where a body is
    about to sit or lie, so that nothing is put there.
    """

    receptacle: SceneObject
    relation: Relation = "on"
    near: Point | None = None
    apart: Point | None = None


def put(
    ground: Ground, plan: Plan, agent: AgentId, thing: SceneObject, there: There, watch: Watch | None = None
) -> None:
    """Add to a plan: carry a thing in hand somewhere and put it down; what is closed is opened and closed again.

    Raises:
        UnableError: If it is full or cannot be reached.
    """
    receptacle, relation = there.receptacle, there.relation
    _refuse_nesting(ground, plan.state, thing, receptacle, relation)
    places = [
        place
        for place in free_places(ground.scene, plan.state, thing, receptacle, relation)
        if not _sat_upon(plan.state, receptacle, place[:2])
        and (there.apart is None or math.dist(place[:2], there.apart) >= _BESIDE)
    ]
    if not places:
        raise UnableError(full(receptacle, thing, relation))
    container = receptacle if relation == "inside" else None
    carrier = _carrier(ground, plan.state, receptacle)
    for place, reach in _tried(places, there.near):
        errand = Errand(grip(thing, place[:3]), carrier, thing.name, tries=8, reaches=(reach,))
        found = go_to_reach(ground, plan, agent, errand, watch)
        if found is not None:
            lies = _laid(plan.state, receptacle, place, relation)

            def release(found: tuple[Stand, Array] = found, place: Spot = place, lies: ThingState = lies) -> None:
                seen = ThingState(position=place[:3], yaw=place.yaw, on=lies.on, inside=lies.inside)
                plan.steps.append(Handle(agent, *found, thing.name, seen))
                plan.state = _known_place(plan.state, receptacle).with_thing(thing.name, lies)

            _opening(plan, agent, container, found, release)
            plan.at.append(receptacle.name)
            return
    where = "inside" if relation == "inside" else "on"
    raise UnableError(f"{named(agent)} cannot reach a free place {where} the {plain(receptacle.name)}{why(plan)}")


def take_off(plan: Plan, agent: AgentId, name: str) -> None:
    """Add to a plan: take off what one wears; it is then in the hand, which is empty before."""
    plan.state = plan.state.with_held(agent, name)
    plan.steps.append(Dress(agent, plan.state.agents[agent].worn, name))


def pick_place(ground: Ground, state: HomeState, agent: AgentId, act: PickPlace, watch: Watch | None = None) -> Plan:
    """Plan a pick-and-place: go, take, go, put. What a hand has from the magic box goes back there first.

    Another thing that a person has in hand is put away first; a robot must have put it down itself.

    Raises:
        UnableError: With the reason why it cannot be done.
    """
    thing = ground.movable(state, act.object, act.object_id)
    receptacle = ground.receptacle(state, act.receptacle, act.receptacle_id)
    relation: Relation = act.relation if receptacle.fixed else "inside"
    check_receptacle(ground, thing, receptacle, relation)
    plan = Plan(state)
    empty_hand(ground, plan, agent, watch, keep=thing.name)
    plan.in_hand = thing.name
    take(ground, plan, agent, thing, watch)
    put(ground, plan, agent, thing, There(receptacle, relation), watch)
    plan.at.reverse()
    return plan


def hand_over(ground: Ground, state: HomeState, agent: AgentId, act: HandOver) -> Plan:
    """Plan a hand-over: the robot has, fetches or gets from the magic box a thing, goes to a person, and gives it.

    The name of a thing of the home means that thing, and any other words one from the box. What the person held from
    the box goes back into it.

    Raises:
        UnableError: If the thing or the person cannot be reached, it is not clear who that is, or a hand is full.
    """
    receiver = receiver_of(state, act)
    wanted = state.find(ground.scene, act.object)
    if wanted is not None and wanted.fixed:
        raise UnableError(f"the {plain(act.object)} cannot be carried")
    has = state.agents[receiver].thing
    if has is not None and (has == act.object or not state.goes_back(ground.scene, has)):
        raise UnableError(f"{named(receiver)} has the {plain(has)} in hand")
    plan = Plan(state)
    held = state.agents[agent].thing
    ready = held in state.box and wanted is None and state.box[held].text == act.object
    empty_hand(ground, plan, agent, keep=held if ready else act.object)
    if wanted is not None:
        take(ground, plan, agent, wanted)
    elif not ready:
        plan.state = plan.state.out_of_box(ground.scene, agent, act.object)
    if has is not None:
        plan.state = plan.state.into_box(has)
    plan.in_hand = str(plan.state.agents[agent].thing)
    give(ground, plan, agent, receiver, plan.in_hand)
    return plan


def set_open(
    ground: Ground, state: HomeState, agent: AgentId, name: str, *, opens: bool, watch: Watch | None = None
) -> Plan:
    """Plan to go to furniture or a thing and open or close it; what is so already stays so.

    Raises:
        UnableError: If it has no door, drawer or lid, or cannot be reached, or the agent's hand is full.
    """
    plan = Plan(state)
    thing = _with_state(ground, state, name, "open", "opened or closed")
    if state.condition(thing)["open"] != opens:
        found = _reach(ground, plan, agent, thing, watch)
        _swing(plan, agent, thing, found, opens=opens)
    return plan


def switch(
    ground: Ground, state: HomeState, agent: AgentId, name: str, *, on: bool, watch: Watch | None = None
) -> Plan:
    """Plan to go to furniture or a thing and switch it on or off; what is so already stays so.

    Raises:
        UnableError: If it cannot be switched, or cannot be reached, or the agent's hand is full.
    """
    plan = Plan(state)
    thing = _with_state(ground, state, name, "powered", "switched on or off")
    if state.condition(thing)["powered"] != on:
        _reach(ground, plan, agent, thing, watch)
        plan.state = plan.state.with_condition(thing, {"powered": on}).without_switch(thing.name)
    return plan


def empty_hand(
    ground: Ground, plan: Plan, agent: AgentId, watch: Watch | None = None, *, keep: str | None = None
) -> None:
    """Add to a plan that a hand becomes empty, unless it has `keep` (a thing's name) in it.

    What came out of the magic box goes back into it. A person puts another thing away; a robot, which others plan for,
    must be told where to.

    Raises:
        UnableError: If a robot holds a thing of the home, or there is no place to put it.
    """
    held = plan.state.agents[agent].thing
    if held is None or held == keep:
        return
    if plan.state.goes_back(ground.scene, held):
        plan.state = plan.state.into_box(held)
    elif agent in ground.robots:
        raise UnableError(f"{named(agent)} must first put down the {plain(held)}")
    else:
        put_away(ground, plan, agent, watch)


def put_away(ground: Ground, plan: Plan, agent: AgentId, watch: Watch | None = None) -> None:
    """Add to a plan: put what is in hand on the nearest furniture that has a place for it.

    Raises:
        UnableError: If there is none.
    """
    thing = ground.movable(plan.state, str(plan.state.agents[agent].thing))
    x, y = plan.state.agents[agent].place
    room = ground.scene.room_at(x, y).name
    near = sorted(ground.scene.fixed, key=lambda one: (one.room != room, round(one.bounds.distance(x, y), 3), one.name))
    for furniture in near:
        mark = plan.mark()
        try:
            put(ground, plan, agent, thing, There(furniture), watch)
        except UnableError:
            plan.rewind(mark)
            continue
        return
    raise UnableError(f"{named(agent)} finds no place to put down the {plain(thing.name)}")


def _refuse_nesting(
    ground: Ground, state: HomeState, thing: SceneObject, receptacle: SceneObject, relation: Relation
) -> None:
    """What holds things can be filled where it stands about, and be put inside something only while it is empty."""
    if relation == "on":
        return
    if state.contents(ground.scene, thing.name):
        raise UnableError(f"the {plain(thing.name)} has things in it, and goes inside nothing as long as it has")
    if receptacle.fixed:
        return
    bearer, around = state.bearer(receptacle.name), state.thing(receptacle).inside
    if bearer is not None:
        raise UnableError(f"{named(bearer)} has the {plain(receptacle.name)}; it can be filled once it is put down")
    if around is not None:
        raise UnableError(f"the {plain(receptacle.name)} is inside the {plain(around)}, and cannot be filled there")


def _refuse_full_hand(ground: Ground, state: HomeState, agent: AgentId) -> None:
    held = state.agents[agent].thing
    if held is not None:
        thing = state.find(ground.scene, held)
        raise UnableError(f"{named(agent)} already holds the {plain(thing.name if thing is not None else held)}")


def _tried(places: list[Spot], near: Point | None) -> list[tuple[Spot, float]]:
    """Places in the order in which they are tried, each with how far it may be from the body.

    First those within everybody's reach, then those that one has to stretch for.
    """
    if near is not None:
        places = sorted(places, key=lambda place: round(math.dist(place[:2], near), 3))[: 2 * _PLACES : 2]
    else:
        places = places[:: max(1, len(places) // _PLACES)]
    close = [(place, FLOOR_REACH if place.z < 0.1 else REACH) for place in places]
    return [*close, *((place, FAR_REACH) for place in places)]


def _carrier(ground: Ground, state: HomeState, thing: SceneObject) -> SceneObject | None:
    """The furniture that an object is, or stands on; None for what stands on the floor."""
    if thing.fixed:
        return thing
    return ground.scene.object(state.thing(thing).on or "")


def _container(ground: Ground, state: HomeState, where: ThingState) -> SceneObject | None:
    return None if where.inside is None else state.find(ground.scene, where.inside)


def _opening(
    plan: Plan, agent: AgentId, container: SceneObject | None, found: tuple[Stand, Array], deed: Callable[[], None]
) -> None:
    """Do something with the hand in a container: open it for that if it is closed, and close it again."""
    shut = container is not None and plan.state.condition(container).get("open") is False
    if container is not None and shut:
        _swing(plan, agent, container, found, opens=True)
        plan.opened.append(container.name)
    deed()
    if container is not None and shut:
        _swing(plan, agent, container, found, opens=False)


def _swing(plan: Plan, agent: AgentId, thing: SceneObject, found: tuple[Stand, Array], *, opens: bool) -> None:
    plan.steps.append(Open(agent, *found, thing.name, opens))
    plan.state = plan.state.with_condition(thing, {"open": opens})


def _with_state(ground: Ground, state: HomeState, name: str, which: str, how: str) -> SceneObject:
    thing = state.find(ground.scene, name)
    if thing is None:
        raise UnableError(f"there is no {plain(name)} ({name}) in this home")
    if which not in affordances().first(thing.cls):
        raise UnableError(f"the {plain(name)} cannot be {how}")
    return thing


def _reach(ground: Ground, plan: Plan, agent: AgentId, thing: SceneObject, watch: Watch | None) -> tuple[Stand, Array]:
    """Add a walk to where a hand gets to an object's front, at a comfortable height."""
    _refuse_full_hand(ground, plan.state, agent)
    bearer, around = plan.state.bearer(thing.name), None if thing.fixed else plan.state.thing(thing).inside
    if bearer is not None and bearer != agent:
        raise UnableError(f"{named(bearer)} has the {plain(thing.name)}")
    if around is not None:
        raise UnableError(f"the {plain(thing.name)} is inside the {plain(around)}, and has to be taken out first")
    now = where_it_is(plan.state, thing)
    height = min(max(0.6 * now.size[2], 0.02), 0.95 - min(now.position[2], 0.9))
    x, y, z = now.to_world(0.0, now.size[1] / 2 if now.fixed else 0.0, height)
    found = go_to_reach(ground, plan, agent, Errand((x, y, z), _carrier(ground, plan.state, thing)), watch)
    if found is None:
        raise UnableError(f"{named(agent)} cannot reach the {plain(thing.name)}{why(plan)}")
    return found


def _laid(state: HomeState, receptacle: SceneObject, place: Spot, relation: Relation) -> ThingState:
    """Where a thing is once it lies there: inside a thing that can be carried, in that thing's frame."""
    if relation == "on":
        return ThingState(position=place[:3], yaw=place.yaw, on=receptacle.name)
    if receptacle.fixed:
        return ThingState(position=place[:3], yaw=place.yaw, on=None, inside=receptacle.name)
    now = where_it_is(state, receptacle)
    x, y = now.to_local(place.x, place.y)
    within = (round(x, 4), round(y, 4), round(place.z - now.position[2], 4))
    return ThingState(position=within, yaw=round(place.yaw - now.yaw, 4), on=None, inside=receptacle.name)


def _known_place(state: HomeState, receptacle: SceneObject) -> HomeState:
    """Write down where a thing stands that now holds another one: its contents' places are given in its frame."""
    if receptacle.fixed or receptacle.name in state.moved:
        return state
    return state.with_thing(receptacle.name, state.thing(receptacle))


def _sat_upon(state: HomeState, receptacle: SceneObject, place: Point) -> bool:
    """Whether somebody sits or lies just there."""
    for person in map(state.person, state.ids("person")):
        if person.posture != "stand" and receptacle.bounds.distance(*person.place) <= 0:
            near = 0.35 if person.posture == "sit" else 0.8
            if math.dist(place, person.place) < near:
                return True
    return False
