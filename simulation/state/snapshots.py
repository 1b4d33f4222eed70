"""Snapshots of a home, which are its state as plain JSON data: reading those of any version, and what they hash to."""

from __future__ import annotations

import json
from collections.abc import Container, Mapping
from typing import Any

from pydantic import ValidationError

from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT
from coopera.core.naming import sha256
from coopera.simulation.homes.scene import Scene
from coopera.simulation.state.home_state import HomeState
from coopera.simulation.state.truth import wrong


def read_snapshot(scene: Scene, start: HomeState, snapshot: Mapping[str, Any], motions: Container[str]) -> HomeState:
    """The state that a snapshot is of; an empty one is of the home as it was built.

    Args:
        scene: The home.
        start: Its state as it was built, which says who lives there.
        snapshot: Of any version.
        motions: Captions of what its people can do.

    Raises:
        SimulationError: If it is damaged, cannot be true, or is of another home.
    """
    if not snapshot:
        return start
    try:
        state = HomeState.model_validate(_today(snapshot))
    except ValidationError as err:
        first = err.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise SimulationError(f"The snapshot of the home cannot be used, field {where}: {first['msg']}.") from err
    if state.scene != scene.id:
        raise SimulationError(f"The snapshot is of the home {state.scene!r}, but this is {scene.id!r}.")
    here, there = start.inhabitants, state.inhabitants
    if here != there:
        raise SimulationError(f"The snapshot is of a home of {', '.join(there)}, but this is one of {', '.join(here)}.")
    if snapshot.get("version") != state.version:
        state = _named_from_box(scene, state)
    if (damage := next(wrong(scene, state, motions), None)) is not None:
        raise SimulationError(f"The snapshot of the home cannot be used: {damage}")
    return state.model_copy(update={"agents": {agent: state.agents[agent] for agent in start.agents}})


def digest(snapshot: Mapping[str, Any]) -> str:
    """The SHA-256 of a snapshot in canonical JSON: equal for equal homes, in every process."""
    text = json.dumps(snapshot, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return sha256(text)


def _today(snapshot: Mapping[str, Any]) -> Mapping[str, Any]:
    """A snapshot in today's form.

    Those of version 1 had just one person and one robot, and no ids. Until version 2 a held thing of the scene kept the
    place that it was taken from, and a thing out of the magic box was but a text in a hand.
    """
    person, robot = snapshot.get("person"), snapshot.get("robot")
    if isinstance(person, Mapping) and isinstance(robot, Mapping) and snapshot.get("version") == 1:
        rest = {key: value for key, value in snapshot.items() if key not in ("version", "person", "robot")}
        agents = {HUMAN: {"kind": "person", **person}, ROBOT: {"kind": "robot", **robot}}
        snapshot = {**rest, "version": 2, "agents": agents}
    if snapshot.get("version") == 2 and isinstance(snapshot.get("agents"), Mapping):
        return _each_once(snapshot)
    return snapshot


def _each_once(snapshot: Mapping[str, Any]) -> Mapping[str, Any]:
    """A snapshot of version 2 as one of version 3: what is held is nowhere else. `_named_from_box` does the rest."""
    bodies = [body for body in snapshot["agents"].values() if isinstance(body, Mapping)]
    held = {body.get("thing") for body in bodies}
    moved = {name: where for name, where in dict(snapshot.get("moved", {})).items() if name not in held}
    return {**snapshot, "version": 3, "moved": moved}


def _named_from_box(scene: Scene, state: HomeState) -> HomeState:
    """The state of a snapshot before version 3, whose things out of the magic box were but texts in a hand."""
    for agent, body in state.agents.items():
        if body.thing is not None and scene.object(body.thing) is None:
            state = state.with_agent(agent, thing=None).out_of_box(scene, agent, body.thing)
    return state
