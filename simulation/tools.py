"""A home as LangChain tools, for a tool-calling model that plans for one of its bodies.

`world_tools(world, "robot")` gives tools that a chat model can be bound to (`model.bind_tools`). Each answers with one
sentence or a small table; a refusal gives its reason, so that the model can try something else.
"""

from __future__ import annotations

import json
from collections.abc import Callable

from langchain_core.tools import BaseTool, StructuredTool
from pydantic import ValidationError
from pydantic.v1 import ValidationError as OldValidationError

from coopera.core.affordances import Relation
from coopera.core.household import ROBOT, AgentId, FreeMotion, HandOver, MotionText, Name
from coopera.simulation.acts.primitives import Result
from coopera.simulation.state.home_state import PersonState
from coopera.simulation.world import World

_DOOR, _SWITCH = ("closed", "open"), ("off", "on")


def world_tools(world: World, agent: AgentId = ROBOT) -> list[BaseTool]:
    """The tools with which a model acts in a home.

    Args:
        world: The home; it is changed by the tools, and stays the caller's to close.
        agent: Whose body the model has.

    Raises:
        SimulationError: If there is no such agent.
    """
    world.state.agent(agent)

    def look_around() -> str:
        """See where you and the others are, what you hold, and which objects are in your room, in which state."""
        return json.dumps(_seen_by(world, agent))

    def list_objects(room: str = "") -> str:
        """List all furniture and movable things by room.

        Args:
            room: Only this room; empty for the whole home.
        """
        return _listed(world, room)

    def go_to(target: str) -> str:
        """Go to a room, a piece of furniture or a thing.

        Args:
            target: Its name, such as "kitchen" or "sofa_1".
        """
        return _said(world.go_to(agent, target), f"You are at the {target}.")

    def pick(thing: str) -> str:
        """Go to a movable thing and take it into your hand, which must be empty.

        What another one holds is asked for. What a thing is in is opened for it, and closed again.

        Args:
            thing: Its name, such as "mug_1".
        """
        return _said(world.pick(agent, thing), f"You hold {thing}.")

    def place(receptacle: str, relation: Relation = "on") -> str:
        """Carry what you hold to a piece of furniture and put it down there, on top or inside.

        Args:
            receptacle: The furniture's name, such as "dining_table_1", or that of a basket or a box.
            relation: "on" it, or "inside", as in a fridge; it is opened for that, and closed again.
        """
        furniture = receptacle in world.objects("fixed")
        return _said(
            world.place(agent, receptacle, relation), f"It is {relation if furniture else 'inside'} {receptacle}."
        )

    def set_open(name: str, opens: bool) -> str:
        """Go to what has a door, a drawer or a lid, and open it or close it.

        Args:
            name: Its name, such as "fridge_1".
            opens: True to open it, false to close it.
        """
        return _said(world.set_open(agent, name, opens), f"{name} is {_DOOR[opens]}.")

    def switch(name: str, on: bool) -> str:
        """Go to what can be switched, and switch it on or off.

        Args:
            name: Its name, such as "television_1".
            on: True to switch it on, false to switch it off.
        """
        return _said(world.switch(agent, name, on), f"{name} is {_SWITCH[on]}.")

    def hand_over(thing: Name, person: str = "") -> str:
        """Bring a person a thing: one of the home, which you fetch or hold, or any small thing from the magic box.

        Args:
            thing: The name of a thing of the home, such as "mug_1", or else what it is in words, such as "toothbrush".
            person: Who gets it; may be left out where there is only one person.
        """
        receiver = AgentId(person) if person else None
        done = world.perform(agent, HandOver(object=thing, receiver=receiver))
        return _said(Result(done.ok, done.reason, done.metres), f"{person or 'The person'} has the {thing}.")

    def move(target: Name, motion: MotionText, in_hand: Name) -> str:
        """Do a motion at a piece of furniture with a thing in hand.

        Args:
            target: The furniture's name.
            motion: The motion in words, such as "sit and read".
            in_hand: The thing: its name if it is to be that thing of the home, or words such as "book".
        """
        fixed = world.layout.object(target)
        act = FreeMotion(target_id=fixed.id if fixed else 0, target=target, in_hand=in_hand, motion=motion)
        done = world.perform(agent, act)
        return _said(Result(done.ok, done.reason, done.metres), f"You {world.state.person(agent).motion} at {target}.")

    functions: list[Callable[..., str]] = [look_around, list_objects, go_to, pick, place, set_open, switch]
    functions.append(hand_over if agent in world.robots else move)
    return [
        StructuredTool.from_function(function, parse_docstring=True, handle_validation_error=_mistake)
        for function in functions
    ]


def _mistake(wrong: ValidationError | OldValidationError) -> str:
    """What is wrong with the arguments of a call, as a sentence for the model that made it."""
    first = wrong.errors()[0]
    return f"That failed: {'.'.join(str(part) for part in first['loc'])}: {first['msg']}."


def _listed(world: World, room: str) -> str:
    if room and room not in world.rooms:
        return f"There is no room {room!r}; there are {', '.join(world.rooms)}."
    listed = {
        name: {
            "furniture": [thing for thing, (_, where) in world.objects("fixed").items() if where == name],
            "things": world.things_on(name),
        }
        for name in ([room] if room else world.rooms)
    }
    return json.dumps(listed)


def _seen_by(world: World, agent: AgentId) -> dict[str, object]:
    room = world.room_of(agent)
    seen: dict[str, object] = {"you": {"room": room, "holding": world.state.agent(agent).thing}}
    for other, state in world.state.agents.items():
        if other != agent:
            doing = {"motion": state.motion} if isinstance(state, PersonState) else {}
            seen[other] = {"room": world.room_of(other), "holding": state.thing, **doing}
    seen["furniture"] = [name for name, (_, where) in world.objects("fixed").items() if where == room]
    seen["things"] = world.things_on(room)
    seen["states"] = world.states(room)
    return seen


def _said(result: Result, done: str) -> str:
    return f"{done} ({result.metres:.1f} m)" if result.ok else f"That failed: {result.reason}"
