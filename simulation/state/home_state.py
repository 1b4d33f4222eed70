"""The truth of a home: where everybody and everything is, as plain frozen data.

Metres and radians; a heading of 0 looks along +x. An object's room is never stored, since its place tells it.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from coopera.core.affordances import Condition, affordances
from coopera.core.errors import SimulationError
from coopera.core.household import AgentId
from coopera.core.people import Frozen, is_empty
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.scene import Label, Scene, SceneObject
from coopera.simulation.motions.library import Posture

_CARRIED = 1.0
Kind: TypeAlias = Literal["person", "robot"]


class PersonState(Frozen):
    """A person: `spot` is the place on the floor from which they walk off, `place` where the body is.

    The two differ where the person sits or lies on something. `support`, `worktop` and `posture` are those of
    `coopera.simulation.motions.poses.Setting`. The person has `thing` in hand, wears what is `worn`, and is `at` a
    furniture; what they `switched` on goes off when they move on.
    """

    kind: Literal["person"] = "person"
    spot: Point
    place: Point
    yaw: float = 0.0
    support: float = 0.0
    worktop: float | None = None
    posture: Posture = "stand"
    motion: str = "stand and wait"
    thing: str | None = None
    at: str | None = None
    worn: tuple[str, ...] = Field((), exclude_if=is_empty)
    switched: tuple[str, ...] = Field((), exclude_if=is_empty)


class RobotState(Frozen):
    """A robot: its base on the floor, and what it has in its gripper."""

    kind: Literal["robot"] = "robot"
    spot: Point
    yaw: float = 0.0
    thing: str | None = None

    @property
    def place(self) -> Point:
        """Where the body is on the floor plan: a robot is where it stands."""
        return self.spot

    @property
    def worn(self) -> tuple[str, ...]:
        """A robot wears nothing."""
        return ()


AgentState = Annotated[PersonState | RobotState, Field(discriminator="kind")]


class ThingState(Frozen):
    """Where a movable thing is: the centre of its base, its turn, and what carries it.

    It is `on` a piece of furniture, `inside` furniture or another thing, or, with neither, on the floor. Inside another
    thing, position and turn are in that thing's frame, since it may be carried about.
    """

    position: tuple[float, float, float]
    yaw: float
    on: str | None
    inside: str | None = Field(None, exclude_if=is_empty)

    @model_validator(mode="after")
    def _has_one_place(self) -> ThingState:
        if self.on is not None and self.inside is not None:
            raise ValueError(f"a thing is on {self.on} or inside {self.inside}, not both")
        return self

    def seen_from(self, container: ThingState) -> ThingState:
        """A place in a container's frame as one in the home."""
        cos, sin = math.cos(container.yaw), math.sin(container.yaw)
        (x, y, z), (at_x, at_y, at_z) = self.position, container.position
        place = (round(at_x + x * cos - y * sin, 4), round(at_y + x * sin + y * cos, 4), round(at_z + z, 4))
        return self.model_copy(update={"position": place, "yaw": self.yaw + container.yaw})


class BoxThing(Frozen):
    """A thing out of the magic box, as long as it is in the home: its object id, and the words that it was named by."""

    id: int = Field(ge=0)
    text: str = Field(min_length=1, max_length=120, pattern=r"\S")


class HomeState(Frozen):
    """The whole truth at a moment between two acts.

    Every thing has exactly one place: in a hand, worn, or where `moved` says; one of the scene that is in none of these
    is where it was at first. `box` is what came out of the magic box, `conditions` the states that are not as at first.
    """

    version: Literal[3] = 3
    scene: str
    agents: dict[AgentId, AgentState]
    """Everybody in the home, in the order in which they were put into it."""
    moved: dict[str, ThingState] = Field(default_factory=dict)
    box: dict[Label, BoxThing] = Field(default_factory=dict, exclude_if=is_empty)
    conditions: dict[str, Condition] = Field(default_factory=dict, exclude_if=is_empty)

    @property
    def inhabitants(self) -> list[str]:
        """Who lives here, in words, sorted: such as "human (person)"."""
        return sorted(f"{agent} ({state.kind})" for agent, state in self.agents.items())

    def ids(self, kind: Kind) -> list[AgentId]:
        """The ids of the people, or of the robots."""
        return [agent for agent, state in self.agents.items() if state.kind == kind]

    def the(self, kind: Kind, agent: AgentId | None = None) -> AgentId:
        """Who is meant: the person (or robot) of that id, or without one the only person of the home.

        Raises:
            SimulationError: If there is no such person, or none was named and there is not just one.
        """
        known = self.ids(kind)
        if agent in known:
            return agent
        if agent is None and len(known) == 1:
            return known[0]
        if not known:
            raise SimulationError(f"There is no {kind} in this home.")
        wrong = f"no {kind} {agent!r}" if agent is not None else f"more than one {kind}"
        raise SimulationError(f"There is {wrong} in this home; name one of {', '.join(known)}.")

    def agent(self, agent: AgentId) -> PersonState | RobotState:
        """One agent's state.

        Raises:
            SimulationError: If nobody of that id lives here.
        """
        if agent not in self.agents:
            raise SimulationError(f"There is no agent {agent!r} in this home; there are {', '.join(self.agents)}.")
        return self.agents[agent]

    def person(self, agent: AgentId | None = None) -> PersonState:
        """A person's state, or that of the only person: as `the` says."""
        found = self.agents[self.the("person", agent)]
        assert isinstance(found, PersonState)
        return found

    def robot(self, agent: AgentId | None = None) -> RobotState:
        """A robot's state, or that of the only robot: as `the` says."""
        found = self.agents[self.the("robot", agent)]
        assert isinstance(found, RobotState)
        return found

    def holder(self, thing: str) -> AgentId | None:
        """Who has a thing in their hand."""
        return next((agent for agent, state in self.agents.items() if state.thing == thing), None)

    def wearer(self, thing: str) -> AgentId | None:
        """Who wears a thing."""
        return next((agent for agent, state in self.agents.items() if thing in state.worn), None)

    def thing(self, initial: SceneObject) -> ThingState:
        """Where a movable thing is now; what somebody holds or wears, or what is inside that, is with them."""
        bearer = self.bearer(initial.name)
        if bearer is not None:
            return ThingState(position=(*self.agents[bearer].place, _CARRIED), yaw=0.0, on=None)
        where = self.moved.get(initial.name) or at_first(initial)
        if where.inside is None:
            return where
        within = self.bearer(where.inside)
        if within is not None:
            return where.model_copy(update={"position": (*self.agents[within].place, _CARRIED)})
        container = self.moved.get(where.inside)
        return where if container is None else where.seen_from(container)

    def bearer(self, thing: str) -> AgentId | None:
        """Who holds or wears a thing."""
        for agent, state in self.agents.items():
            if state.thing == thing or thing in state.worn:
                return agent
        return None

    def objects(self, scene: Scene) -> tuple[SceneObject, ...]:
        """All movable things in the home: those of the scene by name, and those out of the magic box."""
        if not self.box:
            return scene.movable
        return (*scene.movable, *(from_box(name, known) for name, known in sorted(self.box.items())))

    def of_the_home(self, scene: Scene) -> list[SceneObject]:
        """The same, without what is out of the magic box and with somebody: that is no thing of the home."""
        return [thing for thing in self.objects(scene) if thing.name not in self.box or self.bearer(thing.name) is None]

    def find(self, scene: Scene, name: str) -> SceneObject | None:
        """The furniture or thing of that name, out of the magic box or not; None where there is none."""
        known = self.box.get(name)
        return scene.object(name) if known is None else from_box(name, known)

    def contents(self, scene: Scene, container: str) -> list[SceneObject]:
        """What is inside furniture or a thing, by name."""
        return [thing for thing in self.objects(scene) if self.thing(thing).inside == container]

    def carried_by(self, scene: Scene, furniture: str) -> list[SceneObject]:
        """What stands on a piece of furniture, by name."""
        return [thing for thing in self.objects(scene) if self.thing(thing).on == furniture]

    def condition(self, thing: SceneObject) -> Condition:
        """All states that an object has, with their values now; empty for an object without any."""
        return {**affordances().first(thing.cls), **self.conditions.get(thing.name, {})}

    def with_thing(self, name: str, where: ThingState) -> HomeState:
        """The same home with one thing put elsewhere, out of the hand or off the body that had it."""
        state = self._without(name)
        moved = {**state.moved, name: where}
        return state.model_copy(update={"moved": {key: moved[key] for key in sorted(moved)}})

    def with_held(self, agent: AgentId, name: str) -> HomeState:
        """The same home with a thing in an agent's hand, and nowhere else."""
        return self._without(name).with_agent(agent, thing=name)

    def with_worn(self, agent: AgentId, name: str) -> HomeState:
        """The same home with a thing worn by a person, and nowhere else."""
        state = self._without(name)
        return state.with_agent(agent, worn=(*state.person(agent).worn, name))

    def _without(self, name: str) -> HomeState:
        """Take a thing from where it was put, out of every hand and off every body; its place must be said at once."""
        moved = {key: where for key, where in self.moved.items() if key != name}
        state = self.model_copy(update={"moved": moved})
        for agent, body in self.agents.items():
            if body.thing == name:
                state = state.with_agent(agent, thing=None)
            if name in body.worn:
                state = state.with_agent(agent, worn=tuple(one for one in body.worn if one != name))
        return state

    def out_of_box(self, scene: Scene, agent: AgentId, text: str) -> HomeState:
        """The same home with a new thing from the magic box in an agent's hand."""
        label, number = _label(text, most=70), 1
        while scene.object(f"{label}_{number}") is not None or f"{label}_{number}" in self.box:
            number += 1
        name = f"{label}_{number}"
        ids = [thing.id for thing in scene.objects] + [known.id for known in self.box.values()]
        new = BoxThing(id=max(ids, default=0) + 1, text=text)
        return self.model_copy(update={"box": {**self.box, name: new}}).with_agent(agent, thing=name)

    def into_box(self, name: str) -> HomeState:
        """The same home without a thing that came out of the magic box."""
        state = self._without(name).without_switch(name)
        return state.model_copy(
            update={
                "box": {key: known for key, known in state.box.items() if key != name},
                "conditions": {key: said for key, said in state.conditions.items() if key != name},
            }
        )

    def without_switch(self, name: str) -> HomeState:
        """The same home where nobody will switch an object off when they move on."""
        state = self
        for agent in self.ids("person"):
            switched = self.person(agent).switched
            if name in switched:
                state = state.with_agent(agent, switched=tuple(one for one in switched if one != name))
        return state

    def goes_back(self, scene: Scene, name: str | None) -> bool:
        """Whether a thing goes back into the magic box when a hand lets go of it: it is from there, and empty."""
        return name is not None and name in self.box and not self.contents(scene, name)

    def with_condition(self, thing: SceneObject, change: Condition) -> HomeState:
        """The same home with states of an object changed; those that its class does not have are left out."""
        first = affordances().first(thing.cls)
        now = {**self.conditions.get(thing.name, {}), **{key: said for key, said in change.items() if key in first}}
        kept = {key: now[key] for key in sorted(now) if now[key] != first[key]}
        conditions = {key: said for key, said in self.conditions.items() if key != thing.name}
        if kept:
            conditions[thing.name] = kept
        return self.model_copy(update={"conditions": {key: conditions[key] for key in sorted(conditions)}})

    def with_agent(self, agent: AgentId, **change: object) -> HomeState:
        """The same home with an agent changed."""
        return self.put(agent, self.agents[agent].model_copy(update=change))

    def put(self, agent: AgentId, state: PersonState | RobotState) -> HomeState:
        """The same home with an agent in another state."""
        return self.model_copy(update={"agents": {**self.agents, agent: state}})


def _label(text: str, most: int | None = None) -> str:
    """Words as a label, cut to so many characters; "thing_" comes before what does not begin with a letter."""
    slug = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")[:most]
    return slug if slug[:1].isalpha() else f"thing_{slug}".strip("_")


@lru_cache(maxsize=256)  # a long life has new ones every day
def from_box(name: str, known: BoxThing) -> SceneObject:
    """A thing out of the magic box as an object like any other; its class is what it counts as."""
    shape = shape_of(known.text)
    cls = _label(shape.kind)
    red, green, blue = (round(255 * channel) for channel in shape.rgb)
    return SceneObject(
        id=known.id,
        name=name,
        cls=cls[:80],
        category=catalogue().category(cls)[:60] or "thing",
        fixed=False,
        room="",
        position=(0.0, 0.0, 0.0),
        size=shape.size,
        colour=f"#{red:02x}{green:02x}{blue:02x}",
    )


def at_first(initial: SceneObject) -> ThingState:
    """Where a thing of the scene is as long as nobody has moved it."""
    return _standing(initial.position, initial.yaw, initial.on)


@lru_cache(maxsize=4096)
def _standing(position: tuple[float, float, float], yaw: float, on: str | None) -> ThingState:
    return ThingState(position=position, yaw=yaw, on=on)


def room_of_thing(scene: Scene, state: HomeState, initial: SceneObject) -> str:
    """The room in which a movable thing now is."""
    x, y, _ = state.thing(initial).position
    return scene.room_at(x, y).name


def standing_now(scene: Scene, state: HomeState) -> Scene:
    """A home as its things now stand; what somebody holds or wears, and what is inside something, is not in it."""
    things = list(scene.fixed)
    for thing in state.objects(scene):
        where = state.thing(thing)
        if state.bearer(thing.name) is None and where.inside is None:
            room = room_of_thing(scene, state, thing)
            change = {"position": where.position, "yaw": where.yaw, "on": where.on, "room": room}
            things.append(thing.model_copy(update=change))
    return scene.model_copy(update={"objects": sorted(things, key=lambda thing: thing.id)})
