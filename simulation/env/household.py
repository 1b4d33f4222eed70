"""A home, a life and two who act in it, step by step: what both environments are made of.

In a step each of the two does one act or none. A robot that does nothing watches: it drives to where it sees the
person, and is told what a perception module reports of their act. An act of the robot helps if the person still had
it before them; what is done twice is done once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from coopera.core.household import HUMAN, ROBOT, Act, AgentId, FreeMotion, HandOver, Outcome, Percept, PickPlace, plain
from coopera.core.randomness import rng_at
from coopera.simulation.acts.plans import UnableError
from coopera.simulation.env.life import Hour, Life
from coopera.simulation.env.pace import Course, course, waits
from coopera.simulation.goals.achieved import goal_of
from coopera.simulation.world import World

Helps = Callable[[World, Act, Act], bool]
"""Whether an act of the robot helps with an act that the person has before them."""

PATIENCE = 60.0
"""Longer (seconds) no robot waits for somebody to get out of its way."""


def same_classes(world: World, act: Act, wanted: Act) -> bool:
    """The paper's rule (App. C.3), with equal classes of things in place of similar ones in type 2 (DEVIATES).

    A pick-and-place helps with one of a thing and a receptacle of the same classes, whichever they are; to bring a
    thing helps with a motion for which a thing of its class is in hand.
    """
    if isinstance(act, PickPlace) and isinstance(wanted, PickPlace):
        return goal_of(act, world.class_of) == goal_of(wanted, world.class_of)
    if isinstance(act, HandOver) and isinstance(wanted, FreeMotion):
        return plain(world.class_of(act.object)) == plain(world.class_of(wanted.in_hand))
    return False


class Stepped(NamedTuple):
    """What came of a step.

    Attributes:
        outcomes: Of each agent that did something.
        helped: How many of the person's tasks the robot has newly helped with.
        done: How many of the person's tasks are newly done, by whomever.
        percept: What a robot that watched has seen, or None.
        seconds: How long each act took, with the time that its agent stood waiting for the other.
    """

    outcomes: dict[AgentId, Outcome]
    helped: int
    done: int
    percept: Percept | None
    seconds: dict[AgentId, float]


class Household:
    """One person and one robot in a home, hour by hour."""

    def __init__(self, world: World, life: Life, *, helps: Helps, overlap: bool, watches: bool) -> None:
        """Put them together; `begin` starts an episode."""
        self.world, self.life, self.helps = world, life, helps
        self.overlap, self.watches = overlap, watches
        self.left: list[Act] = []
        """What the person still has to do in this hour, in order; the robot must not be told."""
        self.over = True
        self._seed = self._steps = self._at = 0
        self._helped: list[Act] = []

    @property
    def hour(self) -> Hour:
        """The hour it is; after the last one, still that."""
        return self.life.hours[min(self._at, len(self.life.hours) - 1)]

    def begin(self, seed: int) -> None:
        """Start an episode: everything is where it was when the home was built."""
        self.world.restore({})
        self._seed, self._steps, self._at, self.over = seed, 0, -1, False
        self.life.begin(self.world, seed)
        self.left = []
        self.next_hour()

    def next_hour(self) -> None:
        """Go on to the next hour in which the person does something, if there is one; what was left is given up."""
        self.left, self._helped = [], []
        while not self.left and not self.over:
            self._at += 1
            self.over = self._at >= len(self.life.hours)
            if not self.over:
                self.left = list(self.life.tasks(self.hour))

    def step(self, acts: Mapping[AgentId, Act | None]) -> Stepped:
        """Let both do something, the robot first unless acts overlap; the hour stays until `next_hour`.

        Raises:
            ValueError: If the episode is over.
        """
        if self.over:
            raise ValueError("the episode is over: call reset")
        self._steps += 1
        wanted = dict(acts)
        order, seconds, late = self._order(wanted)
        outcomes: dict[AgentId, Outcome] = {}
        helped, before = 0, len(self.left)
        for agent in order:
            act = wanted[agent]
            if act is None or (agent == HUMAN and self._was_done(act, outcomes.get(ROBOT))):
                continue
            if agent in late:
                outcomes[agent] = Outcome(agent=agent, act=act, ok=False, reason=late[agent])
                continue
            watched = agent == HUMAN and self.watches and wanted.get(ROBOT) is None
            outcomes[agent] = self.world.perform(agent, act, record=watched, watcher=ROBOT if watched else None)
            if outcomes[agent].ok:
                helped += self._count(agent, act)
        seen = HUMAN in outcomes and self.watches and wanted.get(ROBOT) is None
        percept = self.world.percept(rng_at(self._seed, "percept", self._steps)) if seen else None
        return Stepped(outcomes, helped, before - len(self.left), percept, seconds)

    def _count(self, agent: AgentId, act: Act) -> int:
        """Strike out what an act has done of the person's tasks; returns how many it has newly helped with."""
        if agent == HUMAN:
            if act in self.left:
                self.left.remove(act)
            return 0
        met = next((task for task in self.left if task not in self._helped and self.helps(self.world, act, task)), None)
        if met is None:
            return 0
        if isinstance(met, PickPlace):
            self.left.remove(met)
        else:
            self._helped.append(met)
        return 1

    def _was_done(self, act: Act, by_robot: Outcome | None) -> bool:
        """Whether the robot has just done what the person was about to do."""
        if by_robot is None or not by_robot.ok or not isinstance(act, PickPlace):
            return False
        return self.helps(self.world, by_robot.act, act)

    def _order(
        self, acts: Mapping[AgentId, Act | None]
    ) -> tuple[list[AgentId], dict[AgentId, float], dict[AgentId, str]]:
        """Who changes the home first, how long each takes, and who comes too late because the other was in the way."""
        courses = {
            agent: found for agent, act in acts.items() if act is not None and (found := self._course(agent, act))
        }
        seconds = {agent: found.seconds for agent, found in courses.items()}
        order = [agent for agent in (ROBOT, HUMAN) if acts.get(agent) is not None]
        if not self.overlap or len(courses) < len(order) or len(order) < 2:
            return order, seconds, {}
        waited = waits(courses[ROBOT], courses[HUMAN])
        seconds[ROBOT] += waited
        late = {ROBOT: f"The {HUMAN} was in the way for {waited:.0f} seconds."} if waited > PATIENCE else {}
        return sorted(order, key=lambda agent: (seconds[agent], agent)), seconds, late

    def _course(self, agent: AgentId, act: Act) -> Course | None:
        """An act in time as it would go now; None where it cannot be done, which takes no time."""
        try:
            plan = self.world.plan(agent, act)
        except UnableError:
            return None
        return course(agent, self.world.state.agents[agent].spot, plan, drives=agent == ROBOT)
