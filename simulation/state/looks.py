"""What can be seen of a home's things by looking around: what stands about, and in which states."""

from __future__ import annotations

from coopera.core.affordances import in_words
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.state.home_state import HomeState, room_of_thing


def in_sight(scene: Scene, state: HomeState, thing: SceneObject) -> bool:
    """Whether an object is not inside something closed."""
    within = None if thing.fixed else state.thing(thing).inside
    container = None if within is None else state.find(scene, within)
    return container is None or state.condition(container).get("open") is not False


def states_in_sight(scene: Scene, state: HomeState, room: str | None = None) -> dict[str, str]:
    """{object: its states in words} of all that is not as at first and can be seen, in a room or everywhere.

    Sorted by name. What is inside something closed is not seen, and what somebody holds or wears is left out: what is
    in a hand has to be recognised, which is what a percept is for.
    """
    found = {}
    for name, condition in state.conditions.items():
        thing = state.find(scene, name)
        if thing is None or state.bearer(name) is not None or not in_sight(scene, state, thing):
            continue
        if room is None or room == (thing.room if thing.fixed else room_of_thing(scene, state, thing)):
            found[name] = in_words(condition)
    return found


def things_in_sight(scene: Scene, state: HomeState, room: str) -> dict[str, str]:
    """The movable things of a room that can be seen: {thing: what it is on or inside, who has it, or "floor"}."""
    things = [thing for thing in state.of_the_home(scene) if room_of_thing(scene, state, thing) == room]
    return {thing.name: _whereabouts(state, thing) for thing in things if in_sight(scene, state, thing)}


def _whereabouts(state: HomeState, thing: SceneObject) -> str:
    where = state.thing(thing)
    inside = f"inside {where.inside}" if where.inside is not None else None
    return state.bearer(thing.name) or where.on or inside or "floor"


def place_in_words(state: HomeState, thing: SceneObject) -> str:
    """Where a thing is: on or inside what, with whom, or on the floor."""
    where, bearer = state.thing(thing), state.bearer(thing.name)
    if bearer is not None:
        return f"with {bearer}"
    if where.inside is not None:
        return f"inside {where.inside}"
    return f"on {where.on or 'the floor'}"
