"""The home as a Gymnasium environment: a learner is the robot, and the person lives as they do."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces

from coopera.core.household import HUMAN, ROBOT, Percept
from coopera.simulation.env.coding import Coding, Numbers
from coopera.simulation.env.household import Helps, Household, Stepped, same_classes
from coopera.simulation.env.life import Life
from coopera.simulation.world import World

Sees = Literal["room", "home"]
HELPED, USELESS = 1.0, -0.2
FAR = 30.0
"""What is farther than this (metres), or not there, has this depth."""


class HomeEnv(gymnasium.Env[dict[str, Any], Numbers]):
    """A day (or more) with a person; a step is one act of the robot while the person does their next task.

    An hour goes on until the person has no task left; the episode ends with the last hour. As in the paper, a robot
    that waits in the hour's first step watches the first task, and can help with those after it.

    Action: `MultiDiscrete([4, things, places])`; see `coopera.simulation.env.coding` (`env.coding.act(action)` is the
    act, `env.coding.numbers(act)` the way back).

    Observation: a `Dict` of `clock` (weekday, hour), `person` (room, motion label, furniture and class in hand, as the
    robot saw it last in this hour, 0 for unknown), `room` (the robot's) and `things` (where each thing of the home is,
    as far as the robot has seen); with `picture`, what its camera sees and how far away that is. The person's intention
    and tasks are in no observation and in no `info`.

    Reward: `helped` for each task of the person that an act newly helps with, `useless` for an act that fails or helps
    with none, 0 for waiting.

    `info`: `act` (in words), `ok`, `reason`, `helped` of the last step, and `seconds` that the acts took; at the end of
    the episode `help`, the sums of the episode.
    """

    metadata = {"render_modes": []}

    def __init__(  # noqa: PLR0913 - one parameter for each thing that can be chosen
        self,
        world: World,
        life: Life,
        *,
        brings: Sequence[str] = (),
        helps: Helps = same_classes,
        sees: Sees = "room",
        picture: tuple[int, int] | None = None,
        watches: bool = True,
        overlap: bool = False,
        rewards: tuple[float, float] = (HELPED, USELESS),
        resources: ExitStack | None = None,
    ) -> None:
        """Set up an environment; `reset` begins.

        Args:
            world: A home with one person, "human", and one robot, "robot"; the environment closes it.
            life: Who decides for the person.
            brings: Things that can be brought besides those of the home; see `Coding`.
            helps: The rule by which an act helps.
            sees: Whether the robot sees the things of its room, or of the whole home at any time. In both cases it was
                shown around at first.
            picture: Width and height of what the robot's camera sees after a step, if it is to be observed: `picture`
                (colours) and `depth` (metres, at most `FAR`). It needs the renderer gl.
            watches: Whether a waiting robot is told what it sees of the person, which takes most of a step's time.
            overlap: Whether both act at the same time: who is done first changes the home first, and the robot stops
                where it would run into the person. Without, the robot acts first.
            rewards: For a task helped with, and for an act that helped with none.
            resources: What is to be closed with the environment, such as what the life is lived with.
        """
        self.household = Household(world, life, helps=helps, overlap=overlap, watches=watches)
        self.coding = Coding(world, brings)
        self._picture = picture
        self._sees, (self._good, self._bad), self._resources = sees, rewards, resources
        self._known: dict[str, str] = {}
        self._seen: Percept | None = None
        self._sums = dict.fromkeys(("tasks", "helped", "acts", "useless"), 0)
        self.action_space = spaces.MultiDiscrete(self.coding.robot_acts)
        observed: dict[str, spaces.Space[Any]] = {
            "clock": spaces.MultiDiscrete([7, 24]),
            "person": spaces.MultiDiscrete(self.coding.percept_sizes),
            "room": spaces.Discrete(len(self.coding.rooms)),
            "things": spaces.MultiDiscrete(self.coding.whereabouts_sizes),
        }
        if picture is not None:
            width, height = picture
            observed["picture"] = spaces.Box(0, 255, (height, width, 3), np.uint8)
            observed["depth"] = spaces.Box(0.0, FAR, (height, width), np.float32)
        self.observation_space: spaces.Space[Any] = spaces.Dict(observed)

    @property
    def world(self) -> World:
        """The home, truth and all: for a look from outside, not for the robot."""
        return self.household.world

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode; the same seed gives the same life and the same errors of perception."""
        super().reset(seed=seed)
        self.household.begin(int(self.np_random.integers(2**31)))
        self._sums = dict.fromkeys(self._sums, 0) | {"tasks": len(self.household.left)}
        self._seen, self._known = None, {}
        for room in self.world.rooms:
            self._known |= self.world.things_on(room)
        return self._observation(), {"act": "", "ok": True, "reason": "", "helped": 0, "seconds": 0.0}

    def step(self, action: Numbers) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Do an act while the person does their next task.

        Raises:
            ValueError: If the episode is over.
        """
        act = self.coding.act(action)
        hour = self.household
        done = hour.step({ROBOT: act, HUMAN: hour.left[0] if hour.left else None})
        if HUMAN in done.outcomes and not done.outcomes[HUMAN].ok and hour.left:
            hour.left.pop(0)  # what cannot be done is given up
        self._look(done)
        reward = self._reward(done)
        if not hour.left:
            hour.next_hour()
            self._seen = None
            self._sums["tasks"] += len(hour.left)
        return self._observation(), reward, hour.over, False, self._info(done)

    def close(self) -> None:
        """Close the home, and what was given to be closed with it."""
        self.world.close()
        if self._resources is not None:
            self._resources.close()

    def _look(self, done: Stepped) -> None:
        rooms = self.world.rooms if self._sees == "home" else [self.world.room_of(ROBOT)]
        for room in rooms:
            now = self.world.things_on(room)
            gone = [thing for thing, where in self._known.items() if thing not in now and self._in_room(where, room)]
            self._known = {thing: where for thing, where in self._known.items() if thing not in gone} | now
        self._seen = done.percept or self._seen

    def _in_room(self, where: str, room: str) -> bool:
        thing = self.world.layout.object(where.removeprefix("inside "))
        return thing is not None and thing.room == room

    def _reward(self, done: Stepped) -> float:
        if ROBOT not in done.outcomes:
            return 0.0
        self._sums["acts"] += 1
        self._sums["helped"] += done.helped
        self._sums["useless"] += not done.helped
        return self._good * done.helped if done.helped else self._bad

    def _observation(self) -> dict[str, Any]:
        return self._looked() | {
            "clock": self.coding.clock(self.household.hour),
            "person": self.coding.percept(self._seen),
            "room": np.int64(self.coding.rooms.index(self.world.room_of(ROBOT))),
            "things": self.coding.whereabouts(self._known),
        }

    def _looked(self) -> dict[str, Any]:
        if self._picture is None:
            return {}
        seen = self.world.view(ROBOT, self._picture)
        return {"picture": seen.colour, "depth": np.minimum(seen.depth, FAR).astype(np.float32)}

    def _info(self, done: Stepped) -> dict[str, Any]:
        own = done.outcomes.get(ROBOT)
        said = {
            "act": own.act.describe() if own else "",
            "ok": own.ok if own else True,
            "reason": own.reason if own else "",
            "helped": done.helped,
            "seconds": max(done.seconds.values(), default=0.0),
        }
        return said | ({"help": dict(self._sums)} if self.household.over else {})
