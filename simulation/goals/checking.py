"""Whether the words of a goal mean something: a class that no home knows is most likely misspelt.

A thing may be called anything, since anything can come out of the magic box. It is refused only where it is nearly
what another thing is called.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain

from coopera.core.affordances import FORMS, affordances
from coopera.core.errors import ConfigError
from coopera.core.household import AgentId, plain
from coopera.simulation.goals.atoms import room_words, who
from coopera.simulation.goals.tree import STATES, Atom, Goal, Role, atoms, near
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.magic_box import looks, shape_of
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.state.home_state import Kind

_MISSPELT = 0.87
"""From this likeness (of difflib, 0 to 1) on, an unknown word is taken for a slip; none of the offline person's is."""


@dataclass(frozen=True, slots=True)
class Words:
    """The words that mean something in some homes, each as `plain` has it, in small letters."""

    names: dict[str, SceneObject]
    furniture: frozenset[str]
    things: frozenset[str]
    containers: frozenset[str]
    rooms: frozenset[str]


def check(
    goal: Goal, scenes: Sequence[Scene], agents: Mapping[AgentId, Kind], motions: Collection[str] | None = None
) -> None:
    """Refuse a goal with a word that means nothing in any of some homes.

    Args:
        goal: The goal.
        scenes: The homes.
        agents: Who lives in them.
        motions: The captions of all motions that can be performed; without them any text is one.

    Raises:
        ConfigError: Naming the atom and the word, and what was most likely meant.
    """
    words = _words(scenes)
    for atom in atoms(goal):
        for role, word in zip(atom.roles, atom.words, strict=True):
            wrong = _wrong(role, word, words, agents, motions)
            if wrong:
                raise ConfigError(f"In {atom}, {wrong}.")
        wrong = _without_state(atom, words)
        if wrong:
            raise ConfigError(f"In {atom}, {wrong}.")


def _wrong(role: Role, word: str, words: Words, agents: Mapping[AgentId, Kind], motions: Collection[str] | None) -> str:
    """What is wrong with a word in its role; empty where nothing is."""
    if role in ("agent", "person"):
        return _wrong_agent(role, word, agents)
    if role == "room":
        known = room_words(word) in words.rooms
        return "" if known else f"there is no room {word!r}{near(room_words(word), sorted(words.rooms))}"
    if role == "form":
        return "" if word.lower() in FORMS else f"{word!r} must be one of {', '.join(FORMS)}"
    if role == "motion":
        known = motions is None or word in motions
        return "" if known else f"nobody can perform {word!r}{near(word, sorted(motions or ()))}"
    return "" if role == "content" else _wrong_object(role, word, words)


def _wrong_agent(role: Role, word: str, agents: Mapping[AgentId, Kind]) -> str:
    try:
        agent = who(word, agents)
    except ConfigError:
        return f"{word!r} is nobody here{near(word, agents)}, the agent being {' or '.join(agents)}"
    return "" if role == "agent" or agents[agent] == "person" else f"{word!r} is no person"


def _wrong_object(role: Role, word: str, words: Words) -> str:
    named = words.names.get(word)
    said = plain(named.cls if named else word).lower()
    furniture = named.fixed if named else said in words.furniture
    thing = not named.fixed if named else said in words.things
    if role == "furniture":
        hint = " (it is a thing)" if thing else near(said, sorted(words.furniture))
        return "" if furniture else f"there is no furniture {word!r}{hint}"
    if role == "thing" and furniture and not thing:
        return f"{word!r} is furniture, where a thing was expected"
    if furniture or thing:
        holds = role != "container" or said in words.containers
        return "" if holds else f"nothing is kept inside a {said}, but in {', '.join(sorted(words.containers))}"
    known = words.things if role == "thing" else words.things | words.furniture
    hint = near(said, sorted(known), _MISSPELT)
    return f"no home knows {word!r}{hint}" if hint else ""


def _without_state(atom: Atom, words: Words) -> str:
    """What is wrong with asking an object for a state that its class does not have; empty where nothing is."""
    if atom.name not in STATES:
        return ""
    word = atom.words[0]
    cls = words.names[word].cls if word in words.names else word
    of = affordances().states[atom.name].of
    if any(affordances().is_one_of(one, of) for one in (cls, shape_of(cls).kind)):
        return ""
    known = ", ".join(sorted(map(plain, affordances().names(of))))
    return f"{word!r} has no such state; {atom.name} can be said of {known}"


def _words(scenes: Sequence[Scene]) -> Words:
    objects = [thing for scene in scenes for thing in scene.objects]
    rooms = chain.from_iterable((room.name, room.kind) for scene in scenes for room in scene.rooms)
    furniture, things, kinds = _everywhere()
    return Words(
        names={thing.name: thing for thing in objects},
        furniture=furniture | _plainly(thing.cls for thing in objects if thing.fixed),
        things=things | _plainly(thing.cls for thing in objects if not thing.fixed),
        containers=_plainly(chain(affordances().inside, affordances().holds)),
        rooms=kinds | {room_words(room) for room in rooms},
    )


@lru_cache(maxsize=1)
def _everywhere() -> tuple[frozenset[str], frozenset[str], frozenset[str]]:
    """The classes of furniture and of things, and the kinds of rooms, that any home may have."""
    known, said = catalogue(), affordances()
    groups = chain.from_iterable(said.groups.values())
    tools = chain.from_iterable(motion.tools for motion in said.motions.values())
    furniture = _plainly(known.fixed)
    things = _plainly(chain(known.movable, groups, said.names(list(tools)), looks())) - furniture
    return furniture, things, frozenset(map(room_words, known.rooms))


def _plainly(words: Iterable[str]) -> frozenset[str]:
    return frozenset(plain(word).lower() for word in words)
