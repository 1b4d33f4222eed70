"""The agents of a home, as data: people and robots, each with an id, and a robot with its body."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from coopera.core.errors import ConfigError
from coopera.core.household import HUMAN, ROBOT, AgentId
from coopera.simulation.people.appearance import Appearance

_ID = r"[a-z][a-z0-9_]*"


@dataclass(frozen=True, slots=True)
class PersonAgent:
    """A person, with the one body that people have here, and looks of their own; by default those of the id."""

    id: AgentId = HUMAN
    looks: Appearance | None = None


@dataclass(frozen=True, slots=True)
class RobotAgent:
    """A robot; `body` is as `coopera.simulation.bodies.robot.load_robot` takes it."""

    id: AgentId = ROBOT
    body: str = "fetch"


Agent: TypeAlias = PersonAgent | RobotAgent


def check_agents(agents: Sequence[Agent]) -> None:
    """Refuse agents who cannot share a home: it needs one at least, and each needs an id of its own.

    Raises:
        ConfigError: Naming the id and what was expected.
    """
    if not agents:
        raise ConfigError("A home needs at least one agent, and was given none.")
    strange = next((agent.id for agent in agents if not re.fullmatch(_ID, agent.id)), None)
    if strange is not None:
        raise ConfigError(f"An agent's id must be lower-case letters, digits and underscores, not {strange!r}.")
    twice = next((one for one, count in Counter(agent.id for agent in agents).items() if count > 1), None)
    if twice is not None:
        raise ConfigError(f"Each agent of a home needs an id of its own, but {twice!r} is used more than once.")


def named(agent: AgentId) -> str:
    """The words for an agent in a sentence: its id, but "the human" and "the robot" for those that ship."""
    return f"the {agent}" if agent in (HUMAN, ROBOT) else agent
