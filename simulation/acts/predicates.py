"""What is true of a home now: on, holding, near, at and performed, by class, as goals and measures are written.

`evaluate` reads the usual notation: "on(mug, dining table)", "holding(human, mug)", "near(robot, sofa)",
"at(human, kitchen)", "performed(sit and read)", or "performed(ana, sit and read)" where there is more than one person.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeAlias

from coopera.core.errors import ConfigError
from coopera.core.household import AgentId, plain
from coopera.simulation.acts.state import HomeState, Kind
from coopera.simulation.homes.scene import Scene

Similarity: TypeAlias = Callable[[str, str], float]
"""How alike two texts are, in [-1, 1]."""
SIMILAR = 0.6
"""PAPER §4.3: free-form motions and things count as the same from this similarity on."""
_NEAR = 1.0
_KINDS: dict[str, Kind] = {"person": "person", "human": "person", "robot": "robot"}


def on(scene: Scene, state: HomeState, cls: str, receptacle: str) -> bool:
    """Whether some thing of a class is on (or in) some furniture of a class."""
    for thing in scene.movable:
        carrier = scene.object(state.thing(thing).on or "")
        if carrier is not None and plain(thing.cls) == plain(cls) and plain(carrier.cls) == plain(receptacle):
            return True
    return False


def holding(scene: Scene, state: HomeState, agent: AgentId, cls: str) -> bool:
    """Whether an agent has a thing of a class in its hand; a thing from the magic box is its own class."""
    held = state.agent(agent).thing
    known = scene.object(held or "")
    return held is not None and plain(known.cls if known else held) == plain(cls)


def near(scene: Scene, state: HomeState, agent: AgentId, cls: str, within: float = _NEAR) -> bool:
    """Whether an agent is within some metres of furniture of a class, in the same room."""
    place = state.agent(agent).place
    room = scene.room_at(*place).name
    return any(
        plain(thing.cls) == plain(cls) and thing.room == room and thing.bounds.distance(*place) <= within
        for thing in scene.fixed
    )


def at(scene: Scene, state: HomeState, agent: AgentId, room: str) -> bool:
    """Whether an agent is in a room, named by its name or by its kind."""
    here = scene.room_at(*state.agent(agent).place)
    return room in (here.name, here.kind)


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


def evaluate(scene: Scene, state: HomeState, predicate: str, similarity: Similarity | None = None) -> bool:
    """Whether a written predicate holds.

    Raises:
        ConfigError: If it is none of the five, or has other arguments than it should.
    """
    found = re.fullmatch(r"\s*(\w+)\s*\(([^()]*)\)\s*", predicate)
    name, words = (found[1], [word.strip() for word in found[2].split(",")]) if found else ("", [])
    if name == "on" and len(words) == 2:
        return on(scene, state, *words)
    if name == "performed" and len(words) == 1:
        return performed(state, words[0], similarity)
    agent = _agent(state, words[0]) if len(words) == 2 else None
    if name == "performed" and agent in state.ids("person"):
        return performed(state, words[1], similarity, agent)
    checks = {"holding": holding, "near": near, "at": at}
    if name in checks and agent is not None:
        return checks[name](scene, state, agent, words[1])
    raise ConfigError(
        f"{predicate!r} is no predicate; known are on(class, furniture class), holding(agent, class), "
        "near(agent, furniture class), at(agent, room), performed(motion) and performed(person, motion), the agent "
        f"being {' or '.join(state.agents)}."
    )


def _agent(state: HomeState, word: str) -> AgentId | None:
    """Whom a word means: who is called so, or the only one of a kind."""
    if word in state.agents:
        return AgentId(word)
    alike = state.ids(_KINDS[word]) if word in _KINDS else []
    return alike[0] if len(alike) == 1 else None
