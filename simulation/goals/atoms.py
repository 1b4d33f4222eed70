"""What is true of a home at one moment: each predicate as a question to its state."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias

from coopera.core.errors import ConfigError
from coopera.core.household import AgentId, plain
from coopera.core.naming import ends_with
from coopera.simulation.goals.tree import STATES, Atom, State
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.state.free_places import where_it_is
from coopera.simulation.state.home_state import HomeState, Kind, ThingState

Similarity: TypeAlias = Callable[[str, str], float]
"""How alike two texts are, in [-1, 1]."""
SIMILAR = 0.6
"""PAPER §4.3: free-form motions and things count as the same from this similarity on."""
NEAR = 1.0
"""Metres from an agent to what it is near."""
NEXT = 0.5
"""Metres between the footprints of two objects that are next to each other, as in habitat-lab's `obj_next_to`."""
LEVEL = 0.1
"""Metres that lie, at most, between the heights of the two, as in `obj_next_to`."""
_KINDS: dict[str, Kind] = {"person": "person", "human": "person", "robot": "robot"}
_NAME = re.compile(r"[a-z][a-z0-9_]*_\d+")
_Truth: TypeAlias = "Callable[..., bool]"


@dataclass(frozen=True, slots=True)
class Moment:
    """A home as it stands at one moment; `similarity` compares motions, whose captions must be equal without it."""

    scene: Scene
    state: HomeState
    similarity: Similarity | None = None
    objects: tuple[SceneObject, ...] = field(init=False, repr=False)
    """All furniture and things, those out of the magic box included."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "objects", (*self.scene.fixed, *self.state.objects(self.scene)))

    def named(self, word: str) -> Iterator[SceneObject]:
        """The objects that a word means."""
        return (thing for thing in self.objects if self.means(word, thing))

    def means(self, word: str, thing: SceneObject) -> bool:
        """Whether a word means an object, by its exact name or its class.

        A thing out of the magic box has the words that it was named by for its class, and the last of them count.
        """
        if word == thing.name or _NAME.fullmatch(word) and word != thing.cls:
            return word == thing.name
        known = self.state.box.get(thing.name)
        return plain(word).lower() == plain(thing.cls).lower() if known is None else _named(known.text, word)

    def lies(self, thing: SceneObject) -> ThingState:
        """Where a thing is; furniture is on nothing."""
        return self.state.thing(thing)

    def containers(self, thing: SceneObject) -> list[SceneObject]:
        """What an object is inside of, from the innermost to the outermost."""
        found: list[SceneObject] = []
        while not thing.fixed:
            within = self.state.find(self.scene, self.lies(thing).inside or "")
            if within is None or within in found:
                break
            found.append(within)
            thing = within
        return found

    def room(self, thing: SceneObject) -> Room:
        """The room in which an object is; what is inside another is where that is."""
        outer = [thing, *self.containers(thing)][-1]
        x, y = outer.xy if outer.fixed else self.lies(outer).position[:2]
        return (self.scene.room(outer.room) if outer.fixed else None) or self.scene.room_at(x, y)


def true(now: Moment, atom: Atom) -> bool:
    """Whether an atom holds at a moment.

    Raises:
        ConfigError: If it names an agent who does not live there.
    """
    first, *others = atom.words
    if atom.name in _OF_OBJECTS:
        question = _OF_OBJECTS[atom.name]
        answers = [question(now, thing, *others) for thing in now.named(first)]
        return bool(answers) and (all(answers) if atom.every else any(answers))
    if atom.name == "performed":
        agent = who(first, _kinds(now.state)) if others else None
        return performed(now.state, atom.words[-1], now.similarity, agent)
    agent = who(first, _kinds(now.state))
    return _OF_AGENTS[atom.name](now.scene, now.state, agent, *others)


def who(word: str, agents: Mapping[AgentId, Kind]) -> AgentId:
    """Whom a word means: who is called so, or the only one of a kind.

    Raises:
        ConfigError: If nobody is meant.
    """
    if word in agents:
        return AgentId(word)
    alike = [agent for agent, kind in agents.items() if kind == _KINDS.get(word.lower())]
    if len(alike) != 1:
        raise ConfigError(f"It is not clear who is meant by {word!r}, the agent being {' or '.join(agents)}.")
    return alike[0]


def _kinds(state: HomeState) -> dict[AgentId, Kind]:
    return {agent: body.kind for agent, body in state.agents.items()}


def _named(text: str, word: str) -> bool:
    """Whether a text is a word, or ends with it: "green tea" with "tea"; case does not count."""
    return ends_with(plain(text).lower(), plain(word).lower())


def same_room(word: str, room: Room) -> bool:
    """Whether a word is a room's name or its kind."""
    return room_words(word) in (room_words(room.name), room_words(room.kind))


def room_words(word: str) -> str:
    """A room's name as it is compared."""
    return " ".join(word.replace("_", " ").lower().split())


def holding(scene: Scene, state: HomeState, agent: AgentId, cls: str) -> bool:
    """Whether an agent has such a thing in its hand."""
    return _has(scene, state, cls, state.agent(agent).thing)


def wearing(scene: Scene, state: HomeState, agent: AgentId, cls: str) -> bool:
    """Whether a person wears such a thing."""
    return any(_has(scene, state, cls, name) for name in state.agent(agent).worn)


def _has(scene: Scene, state: HomeState, cls: str, name: str | None) -> bool:
    thing = state.find(scene, name or "")
    return thing is not None and Moment(scene, state).means(cls, thing)


def near(scene: Scene, state: HomeState, agent: AgentId, cls: str, within: float = NEAR) -> bool:
    """Whether an agent is within some metres of such an object, in the same room."""
    now, place = Moment(scene, state), state.agent(agent).place
    room = scene.room_at(*place)
    there = (where_it_is(state, thing) for thing in now.named(cls) if now.room(thing) == room)
    return any(thing.bounds.distance(*place) <= within for thing in there)


def at(scene: Scene, state: HomeState, agent: AgentId, room: str) -> bool:
    """Whether an agent is in a room, named by its name or by its kind."""
    return same_room(room, scene.room_at(*state.agent(agent).place))


def performed(
    state: HomeState, motion: str, similarity: Similarity | None = None, agent: AgentId | None = None
) -> bool:
    """Whether a person's last motion is the one that a text means: the same words, or similar ones.

    Args:
        state: The home.
        motion: A caption or a free text.
        similarity: Compares texts; without it only equal captions count.
        agent: Whose motion; anybody's where nobody is named.
    """
    people = state.ids("person") if agent is None else [agent]
    done = [state.person(one).motion for one in people]
    return motion in done or (similarity is not None and any(similarity(motion, one) >= SIMILAR for one in done))


def _on(now: Moment, thing: SceneObject, furniture: str) -> bool:
    carrier = None if thing.fixed else now.state.find(now.scene, now.lies(thing).on or "")
    return carrier is not None and now.means(furniture, carrier)


def _inside(now: Moment, thing: SceneObject, container: str) -> bool:
    return any(now.means(container, one) for one in now.containers(thing))


def _in_room(now: Moment, thing: SceneObject, room: str) -> bool:
    return same_room(room, now.room(thing))


def _on_floor(now: Moment, thing: SceneObject) -> bool:
    if thing.fixed or now.state.bearer(thing.name) is not None:
        return False
    return now.lies(thing).on is None and now.lies(thing).inside is None


def _next_to(now: Moment, thing: SceneObject, cls: str) -> bool:
    return any(other.name != thing.name and _beside(now, thing, other) for other in now.named(cls))


def _beside(now: Moment, a: SceneObject, b: SceneObject) -> bool:
    """Whether two objects are next to each other: neither carries the other, nor does anybody carry one of them."""
    held = any(now.state.bearer(one.name) is not None for one in (a, b))
    if held or _carries(now, a, b) or _carries(now, b, a):
        return False
    if now.containers(a)[:1] != now.containers(b)[:1] or now.room(a) != now.room(b):
        return False
    first, second = where_it_is(now.state, a), where_it_is(now.state, b)
    level = first.position[2] <= second.top + LEVEL and second.position[2] <= first.top + LEVEL
    return level and first.bounds.gap(second.bounds) <= NEXT


def _carries(now: Moment, a: SceneObject, b: SceneObject) -> bool:
    return not b.fixed and a.name in (now.lies(b).on, now.lies(b).inside)


def _in_state(name: State, now: Moment, thing: SceneObject, wanted: str = "") -> bool:
    """Whether an object is open (powered, clean), has a form, or has something (or just this) in it."""
    value = now.state.condition(thing).get(name)
    if name == "filled":
        return bool(value) and (not wanted or _named(str(value), wanted))
    return value == wanted.lower() if name == "form" else value is True


_OF_OBJECTS: dict[str, _Truth] = {
    "on": _on,
    "inside": _inside,
    "in_room": _in_room,
    "on_floor": _on_floor,
    "next_to": _next_to,
    **{name: partial(_in_state, name) for name in STATES},
}
_OF_AGENTS: dict[str, _Truth] = {"holding": holding, "wearing": wearing, "near": near, "at": at}
