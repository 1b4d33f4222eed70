"""An earlier life: days that people lived alone before, so that several robots can meet the very same days.

A robot's acts may change the person's next acts, and then two methods would be measured on different days. So a run may
take each hour of the person from an earlier run without a robot. It takes the person's decisions, the robot's
observation, the outcomes of the person's acts, and the home at the end of the hour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from coopera.core.clock import Clock
from coopera.core.errors import HourError
from coopera.core.hour import DayPlan, HourRecord, HumanHour, Observation, Task
from coopera.core.household import Outcome
from coopera.core.people import Frozen
from coopera.graphs.life import LivedNow
from coopera.graphs.services import Services


class Shown(Frozen):
    """What a robot was shown of an hour: the same for every robot, so it is worked out once."""

    observation: Observation
    outcome: Outcome
    world: dict[str, Any]
    """The home after the first task."""


class Lived(Protocol):
    """The days of a life that was lived without a robot."""

    def hour(self, plan: DayPlan, hour: int) -> HourRecord:
        """The hour as it was lived.

        Raises:
            RunError: If the life has no such hour of this person in this home.
        """
        ...

    def shown(self, plan: DayPlan, hour: int) -> Shown | None:
        """What was kept of the first task of an hour, or None."""
        ...

    def keep(self, plan: DayPlan, hour: int, shown: Shown) -> None:
        """Keep what was shown of an hour."""
        ...


@dataclass(frozen=True, slots=True)
class EarlierLife:
    """A life that was lived before, and is met again by a robot."""

    days: Lived
    now: LivedNow = field(default_factory=LivedNow)

    def decide(self, services: Services, plan: DayPlan, clock: Clock) -> HumanHour:
        """What the person decided then."""
        then = self.days.hour(plan, clock.hour)
        if then.human is None:
            raise HourError(then.reason)
        return then.human

    def show(self, services: Services, plan: DayPlan, clock: Clock, first: Task) -> tuple[Observation, Outcome]:
        """What was kept of the first task; else, or where pictures are to be taken, it is done again, and kept."""
        if services.frames:
            return self.now.show(services, plan, clock, first)
        home = services.home(plan.scene)
        if kept := self.days.shown(plan, clock.hour):
            home.restore(kept.world)
            return kept.observation, kept.outcome
        seen, outcome = self.now.show(services, plan, clock, first)
        self.days.keep(plan, clock.hour, Shown(observation=seen, outcome=outcome, world=home.snapshot()))
        return seen, outcome

    def finish(self, services: Services, plan: DayPlan, clock: Clock, left: Sequence[Task]) -> list[Outcome]:
        """What came of the person's acts then."""
        then = self.days.hour(plan, clock.hour)
        done = zip(then.human.tasks if then.human else [], then.world["outcomes"], strict=False)
        return [Outcome.model_validate(outcome) for task, outcome in done if task in left]

    def end(self, services: Services, plan: DayPlan, clock: Clock, human: HumanHour | None) -> None:
        """Leave the home as the person left it then."""
        services.home(plan.scene).restore(self.days.hour(plan, clock.hour).world["poses"])
