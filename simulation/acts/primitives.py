"""Single steps for those who plan themselves: go somewhere, take a thing, put down what one holds.

They are the parts of which the skills are made, each planned completely before anything changes.
"""

from __future__ import annotations

from typing import NamedTuple

from coopera.core.affordances import Relation
from coopera.core.household import AgentId, plain
from coopera.simulation.acts.fitting import check_receptacle
from coopera.simulation.acts.handling import FAR_REACH
from coopera.simulation.acts.plans import Ground, Plan, UnableError, clear_of, taken_by_others
from coopera.simulation.acts.skills import There, put, take
from coopera.simulation.acts.walking import walk
from coopera.simulation.state.agents import named
from coopera.simulation.state.home_state import HomeState


class Result(NamedTuple):
    """How a step ended; a failure has its reason and has changed nothing."""

    ok: bool
    reason: str = ""
    metres: float = 0.0


def go_to(ground: Ground, state: HomeState, agent: AgentId, target: str) -> Plan:
    """Plan a walk to a room, to a piece of furniture or to where a thing is.

    Raises:
        UnableError: If there is no such place, or no way to it.
    """
    plan, start = Plan(state), state.agents[agent].spot
    room = ground.scene.room(target)
    if room is not None:
        middle = ground.navigator.middle_of(room.name)
        goals = [middle] if middle is not None else []
    else:
        thing = state.find(ground.scene, target)
        if thing is None:
            raise UnableError(f"there is no room and no object {target!r} in this home")
        where = state.thing(thing)
        at = thing if thing.fixed else (ground.scene.object(where.on or where.inside or "") or where.position[:2])
        point = None if thing.fixed else where.position[:2]
        approach = ground.navigator.approach
        stands = approach(at, start, point=point) or approach(at, start, point=point, reach=FAR_REACH)
        goals = [(stand.x, stand.y) for stand in stands]
        plan.at = [thing.name] if thing.fixed else []
    taken = taken_by_others(state, agent)
    for goal in sorted(goals, key=lambda goal: not clear_of(goal, taken)):
        mark = plan.mark()
        try:
            walk(ground, plan, agent, goal)
        except UnableError:
            plan.rewind(mark)
            continue
        return plan
    raise UnableError(f"{named(agent)} finds no way to the {plain(target)}")


def pick(ground: Ground, state: HomeState, agent: AgentId, thing: str) -> Plan:
    """Plan to go to a thing and take it; it is then in the agent's hand. What another one holds is asked for.

    Raises:
        UnableError: If the hand is full or the thing is out of reach.
    """
    wanted, held = ground.movable(state, thing), state.agents[agent].thing
    if held is not None:
        raise UnableError(f"{named(agent)} already holds the {plain(held)}")
    plan = Plan(state)
    take(ground, plan, agent, wanted)
    return plan


def place(ground: Ground, state: HomeState, agent: AgentId, receptacle: str, relation: Relation = "on") -> Plan:
    """Plan to carry what is in the agent's hand to furniture, or a thing that holds others, and put it down there.

    Raises:
        UnableError: If the hand is empty, or the furniture full or out of reach.
    """
    held = state.agents[agent].thing
    if held is None:
        raise UnableError(f"{named(agent)} holds nothing")
    plan, thing, there = Plan(state), ground.movable(state, held), ground.receptacle(state, receptacle)
    how: Relation = relation if there.fixed else "inside"
    check_receptacle(ground, thing, there, how)
    put(ground, plan, agent, thing, There(there, how))
    return plan
