"""The places of all agents in a new home: a room for each, as far as there are rooms."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from coopera.core.errors import SimulationError
from coopera.core.household import AgentId
from coopera.simulation.acts.plans import APART, Ground
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Room
from coopera.simulation.state.agents import Agent, RobotAgent
from coopera.simulation.state.home_state import PersonState, RobotState


def first_states(ground: Ground, agents: Sequence[Agent]) -> dict[AgentId, PersonState | RobotState]:
    """Put each agent into the middle of a room, the first into the most spacious one; further ones away from the rest.

    Raises:
        SimulationError: If somebody finds no room to stand in.
    """
    rooms = sorted(ground.scene.rooms, key=lambda room: (-_area(room), room.name))
    middles = [place for room in rooms if (place := ground.navigator.middle_of(room.name)) is not None]
    found: dict[AgentId, PersonState | RobotState] = {}
    for agent in agents:
        others = [state.spot for state in found.values()]
        free = (middle for middle in middles if all(math.dist(middle, other) > 1.0 for other in others))
        place = next(free, None) or _away_from(ground, others)
        if place is None:
            raise SimulationError(f"The home {ground.scene.id} has no room for {agent.id} to stand in.")
        robot = isinstance(agent, RobotAgent)
        found[agent.id] = RobotState(spot=place) if robot else PersonState(spot=place, place=place)
    return found


def _away_from(ground: Ground, others: Sequence[Point]) -> Point | None:
    """The place of the first one's room that is farthest from everybody; None where that is too near."""
    cells = ground.navigator.cells_in(ground.scene.room_at(*others[0]).name)
    gaps = np.hypot(*(cells[:, None] - np.array(others)).transpose(2, 0, 1)).min(axis=1).round(3)
    x, y = cells[gaps.argmax()].tolist()
    return (x, y) if gaps.max() >= APART else None


def _area(room: Room) -> float:
    return round(room.area, 6)
