"""The home as a PettingZoo environment: one learner is the person, another one the robot, and both act in each step."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv

from coopera.core.household import HUMAN, ROBOT, AgentId
from coopera.simulation.env.coding import Coding, Numbers
from coopera.simulation.env.household import Helps, Household, same_classes
from coopera.simulation.env.life import Life
from coopera.simulation.world import World

_MOST_TASKS = 8
_SIDES = (str(HUMAN), str(ROBOT))


class HomeParallelEnv(ParallelEnv[str, dict[str, Any], Numbers]):  # type: ignore[misc]  # pettingzoo has no types
    """Two agents, "human" and "robot", who share the person's tasks, which only the human is shown.

    Actions and the observations `clock`, `things` (of the whole home) and `room` are those of `HomeEnv`; the human's
    act has a fourth number, the motion. The human also sees `tasks`: up to eight acts as numbers, 0 where there is
    none (a task with a thing that nothing here looks like is left out). Both get 1 for each task that was done in the
    step or newly helped with, whoever did it. An hour ends when no task is left or after `steps` steps; the episode
    ends with the last hour.
    """

    metadata = {"render_modes": [], "name": "coopera_home_v0"}

    def __init__(
        self,
        world: World,
        life: Life,
        *,
        brings: Sequence[str] = (),
        helps: Helps = same_classes,
        overlap: bool = True,
        steps: int = 12,
    ) -> None:
        """Set up an environment; `reset` begins. The arguments are those of `HomeEnv`.

        Raises:
            ValueError: If an hour has no step.
        """
        if steps < 1:
            raise ValueError(f"steps: expected at least 1, not {steps}")
        self.household = Household(world, life, helps=helps, overlap=overlap, watches=False)
        self.coding = Coding(world, brings)
        self.possible_agents = list(_SIDES)
        self.agents: list[str] = []
        self._steps, self._step = steps, 0
        self._rng = np.random.default_rng(0)
        both = {
            "clock": spaces.MultiDiscrete([7, 24]),
            "room": spaces.Discrete(len(self.coding.rooms)),
            "things": spaces.MultiDiscrete(self.coding.whereabouts_sizes),
        }
        tasks = {"tasks": spaces.MultiDiscrete(np.array([self.coding.human_acts] * _MOST_TASKS))}
        self.observation_spaces: dict[str, spaces.Space[Any]] = {
            HUMAN: spaces.Dict(both | tasks),
            ROBOT: spaces.Dict(both),
        }
        self.action_spaces: dict[str, spaces.Space[Any]] = {
            HUMAN: spaces.MultiDiscrete(self.coding.human_acts),
            ROBOT: spaces.MultiDiscrete(self.coding.robot_acts),
        }

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """What an agent observes."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """What an agent can do."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
        """Begin an episode; the same seed gives the same life."""
        if seed is not None:
            self._rng = np.random.default_rng(seed)
        self.household.begin(int(self._rng.integers(2**31)))
        self.agents, self._step = list(self.possible_agents), 0
        return self._observations(), {agent: {} for agent in self.agents}

    def step(
        self, actions: dict[str, Numbers]
    ) -> tuple[
        dict[str, dict[str, Any]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Do an act of each, at the same time where acts overlap."""
        home, who = self.household, list(self.agents)
        done = home.step({HUMAN: self.coding.act(actions[HUMAN]), ROBOT: self.coding.act(actions[ROBOT])})
        reward = float(done.done + done.helped)
        if ROBOT in done.outcomes and done.helped and done.done:
            reward -= min(done.helped, done.done)  # a task that the robot has done whole counts once
        self._step += 1
        if not home.left or self._step >= self._steps:
            home.next_hour()
            self._step = 0
        infos = {
            agent: {"ok": one.ok, "reason": one.reason} if (one := done.outcomes.get(AgentId(agent))) else {"ok": True}
            for agent in who
        }
        found = self._observations()
        self.agents = [] if home.over else who
        over, cut = dict.fromkeys(who, home.over), dict.fromkeys(who, False)
        return found, dict.fromkeys(who, reward), over, cut, infos

    def close(self) -> None:
        """Close the home."""
        self.household.world.close()

    def _observations(self) -> dict[str, dict[str, Any]]:
        world, coding = self.household.world, self.coding
        places: dict[str, str] = {}
        for room in world.rooms:
            places |= world.things_on(room)
        both = {"clock": coding.clock(self.household.hour), "things": coding.whereabouts(places)}
        rooms = {agent: np.int64(coding.rooms.index(world.room_of(agent))) for agent in (HUMAN, ROBOT)}
        return {
            HUMAN: both | {"room": rooms[HUMAN], "tasks": self._tasks()},
            ROBOT: both | {"room": rooms[ROBOT]},
        }

    def _tasks(self) -> Numbers:
        found = np.zeros((_MOST_TASKS, 4), dtype=np.int64)
        row = 0
        for act in self.household.left:
            with suppress(KeyError):  # of what this home has no number for
                found[row] = self.coding.numbers(act, person=True)
                row += 1
            if row == _MOST_TASKS:
                break
        return found
