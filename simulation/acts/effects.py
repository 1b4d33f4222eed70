"""What a motion changes: the states of things and furniture, what is worn, what is on while it is done."""

from __future__ import annotations

from collections.abc import Iterator

from coopera.core.affordances import HAND, Affordance, Classes, Condition, Effect, affordances
from coopera.core.household import AgentId, plain
from coopera.simulation.acts.fitting import is_one_of, kind_of
from coopera.simulation.acts.plans import Ground
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.state.home_state import HomeState


def after(
    ground: Ground,
    state: HomeState,
    agent: AgentId,
    done: Affordance,
    target: SceneObject,
    used: SceneObject | None,
) -> HomeState:
    """The home once a person has begun a motion at some furniture with what is in hand and what was needed there.

    What the motion switches on stays on until the person does something else.
    """
    if done.switches:
        state = _switched_on(ground, state, agent, done.switches, [target, *([used] if used is not None else [])])
    for effect in done.does:
        if "person" in effect.to:
            state = _put_on(ground, state, agent, effect)
        for thing in _meant(ground, state, agent, effect, target, used):
            change: Condition = dict(effect.changes)
            if change.get("filled") == HAND:
                change["filled"] = _in_words(ground, state, agent)
            state = state.with_condition(thing, change)
    return state


def _switched_on(
    ground: Ground, state: HomeState, agent: AgentId, classes: Classes, things: list[SceneObject]
) -> HomeState:
    """Switch on the first of some objects that is of some classes, and note who did it.

    What is looked at is also switched on from a seat: the nearest one in the room.
    """
    target = things[0]
    room = [one for one in ground.scene.fixed if one.room == target.room and one.cls in affordances().looked_at]
    room.sort(key=lambda thing: (round(thing.bounds.gap(target.bounds), 3), thing.name))
    for thing in [*things, *room]:
        if affordances().is_one_of(thing.cls, classes):
            if state.condition(thing)["powered"] and not _switched_by_somebody(state, thing.name):
                return state
            on = (*state.person(agent).switched, thing.name)
            return state.with_condition(thing, {"powered": True}).with_agent(agent, switched=on)
    return state


def _switched_by_somebody(state: HomeState, name: str) -> bool:
    """Whether somebody has an object on for what they do, and would switch it off."""
    return any(name in state.person(one).switched for one in state.ids("person"))


def _meant(
    ground: Ground, state: HomeState, agent: AgentId, effect: Effect, target: SceneObject, used: SceneObject | None
) -> Iterator[SceneObject]:
    """The objects that an effect is on."""
    held = state.agents[agent].thing
    hand = state.find(ground.scene, held) if held is not None else None
    parts: dict[str, list[SceneObject]] = {
        "hand": [hand] if hand is not None else [],
        "used": [used] if used is not None else [],
        "there": [
            *state.carried_by(ground.scene, target.name),
            *state.contents(ground.scene, target.name),
        ],
        "furniture": [target],
    }
    if effect.at and not affordances().is_one_of(target.cls, effect.at):
        return
    for part in effect.to:
        for thing in parts.get(part, []):
            if not effect.of or is_one_of(state, thing, effect.of):
                yield thing
                if effect.one:
                    return


def _put_on(ground: Ground, state: HomeState, agent: AgentId, effect: Effect) -> HomeState:
    """Put on what is in hand, if it is something to wear; what was worn of the same kind comes off for it."""
    held = state.agents[agent].thing
    thing = state.find(ground.scene, held) if held is not None else None
    if thing is None or not is_one_of(state, thing, effect.of):
        return state
    for name in state.person(agent).worn:
        other = state.find(ground.scene, name)
        if other is None or kind_of(state, other, effect.of) != kind_of(state, thing, effect.of):
            continue
        state = state.with_worn(agent, thing.name)
        return state.into_box(name) if state.goes_back(ground.scene, name) else state.with_held(agent, name)
    return state.with_worn(agent, thing.name)


def _in_words(ground: Ground, state: HomeState, agent: AgentId) -> str:
    """What pours out of what is in hand: the words for it without those for the vessel, or water."""
    held = state.agents[agent].thing or ""
    thing = state.find(ground.scene, held)
    words = state.box[held].text.lower() if held in state.box else plain(thing.cls) if thing is not None else ""
    kept = [word for word in words.split() if word not in _VESSELS]
    while kept and kept[0] in _BETWEEN:
        kept = kept[1:]
    return " ".join(kept) or "water"


_VESSELS = ("bag", "bottle", "can", "carton", "jar", "jug", "kettle", "pot", "teapot", "glass", "mug", "cup")
_BETWEEN = ("a", "an", "the", "of", "with", "some")
"""What a vessel's name leaves before that of what is in it: "a mug of ginger tea"."""
