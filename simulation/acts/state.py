"""The truth of a home: where everybody and everything is, as plain frozen data.

Metres and radians; a heading of 0 looks along +x. An object's room is never stored, since its place tells it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from coopera.core.household import Agent
from coopera.core.people import Frozen
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.library import Posture

_CARRIED = 1.0


class PersonState(Frozen):
    """The person: `spot` is the place on the floor from which they walk off, `place` where the body is.

    The two differ where the person sits or lies on something. `support`, `worktop` and `posture` are those of
    `coopera.simulation.motions.poses.Setting`. The person holds `thing` from the magic box and is `at` a furniture.
    """

    spot: Point
    place: Point
    yaw: float = 0.0
    support: float = 0.0
    worktop: float | None = None
    posture: Posture = "stand"
    motion: str = "stand and wait"
    thing: str | None = None
    at: str | None = None


class RobotState(Frozen):
    """The robot: its base on the floor, and what it holds from the magic box."""

    spot: Point
    yaw: float = 0.0
    thing: str | None = None


class ThingState(Frozen):
    """Where a movable thing is: the centre of its base, its turn, and the furniture it stands on (None: the floor)."""

    position: tuple[float, float, float]
    yaw: float
    on: str | None


class HomeState(Frozen):
    """The whole truth at a moment between two acts; `moved` holds only what is not in its initial place."""

    version: Literal[1] = 1
    scene: str
    person: PersonState
    robot: RobotState
    moved: dict[str, ThingState] = Field(default_factory=dict)

    def thing(self, initial: SceneObject) -> ThingState:
        """Where a movable thing of the scene is now; what somebody holds is with them, on nothing."""
        for held, place in ((self.robot.thing, self.robot.spot), (self.person.thing, self.person.place)):
            if held == initial.name:
                return ThingState(position=(*place, _CARRIED), yaw=0.0, on=None)
        return self.moved.get(initial.name) or ThingState(position=initial.position, yaw=initial.yaw, on=initial.on)

    def with_thing(self, name: str, where: ThingState) -> HomeState:
        """The same home with one thing put elsewhere."""
        moved = {**self.moved, name: where}
        return self.model_copy(update={"moved": {key: moved[key] for key in sorted(moved)}})

    def with_person(self, **change: object) -> HomeState:
        """The same home with the person changed."""
        return self.model_copy(update={"person": self.person.model_copy(update=change)})

    def with_robot(self, **change: object) -> HomeState:
        """The same home with the robot changed."""
        return self.model_copy(update={"robot": self.robot.model_copy(update=change)})

    def place(self, agent: Agent) -> Point:
        """Where an agent's body is on the floor plan."""
        return self.person.place if agent == "human" else self.robot.spot

    def spot(self, agent: Agent) -> Point:
        """Where an agent stands, or would stand up to."""
        return self.person.spot if agent == "human" else self.robot.spot


def digest(snapshot: Mapping[str, Any]) -> str:
    """The SHA-256 of a snapshot in canonical JSON: equal for equal homes, in every process."""
    text = json.dumps(snapshot, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def room_of_thing(scene: Scene, state: HomeState, initial: SceneObject) -> str:
    """The room in which a movable thing now is."""
    x, y, _ = state.thing(initial).position
    return scene.room_at(x, y).name
