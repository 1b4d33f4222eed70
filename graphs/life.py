"""A person's hour as it is lived now: decided by whoever plays the person, and done in the home."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, HumanHour, Observation, Task
from coopera.core.household import Outcome
from coopera.core.lazy import made_once
from coopera.core.randomness import Address
from coopera.graphs.human import build_human_graph, human_hour
from coopera.graphs.players.player import HumanInput, HumanState
from coopera.graphs.recorded import remember_lived
from coopera.graphs.services import Services

_graph = made_once()(build_human_graph)


class LivedNow:
    """A new life."""

    def decide(self, services: Services, plan: DayPlan, clock: Clock) -> HumanHour:
        """Run the person's graph; whatever they remembered of this hour or later is forgotten first."""
        ctx = services.human(plan)
        ctx.memories.forget_from(clock.now)
        done = _graph().invoke(HumanInput(clock=clock, hours=plan.hours), context=ctx)
        return human_hour(cast(HumanState, done))

    def show(self, services: Services, plan: DayPlan, clock: Clock, first: Task) -> tuple[Observation, Outcome]:
        """Have the person do the first task while the robot watches.

        The robot gets sampled frames, in type 1 the task's text too (PAPER §3.1), and, where its model cannot look at
        pictures, what a perception module reports.
        """
        home = services.home(plan.scene)
        outcome = home.perform(services.human_agent, first.act, record=True, watcher=services.robot_agent)
        frames = []
        if services.frames:
            folder = services.recorder.frames_folder(plan.day, clock.hour)
            taken = home.frames(services.frames, folder, wait=services.looks_at_frames)
            frames = [services.relative(path) for path in taken]
        if services.video:
            home.film(services.recorder.video_file(plan.day, clock.hour))
        blind = not services.ask.sees("robot")
        percept = home.percept(services.rng(Address(plan.person, clock.day, clock.hour, "percept"))) if blind else None
        text = first.act.describe() if plan.collab == 1 else None
        return Observation(frames=frames, percept=percept, first_task=text), outcome

    def finish(self, services: Services, plan: DayPlan, clock: Clock, left: Sequence[Task]) -> list[Outcome]:
        """Have the person do the rest."""
        home = services.home(plan.scene)
        return [home.perform(services.human_agent, task.act) for task in left]

    def end(self, services: Services, plan: DayPlan, clock: Clock, human: HumanHour | None) -> None:
        """Have the person remember the hour, and nothing of it or later besides."""
        remember_lived(services, plan, clock, human)
