"""What stands in the trace was done: an hour or an evening on file is taken over, and not done again.

A checkpoint may be behind the trace: the process was killed between the two, or the checkpoints were lost. Done again,
an hour would leave the trace for another one, with a model that never says the same twice. So the graphs take over
what they find, memories included, until they come to what is not there.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from coopera.core.clock import Clock
from coopera.core.errors import RunError
from coopera.core.hour import DayPlan, HourRecord, RobotHour
from coopera.core.people import PersonId
from coopera.graphs.robots.traits import guesses
from coopera.graphs.services import Services
from coopera.simulation.state.snapshots import digest


def take_over_hour(services: Services, plan: DayPlan, record: HourRecord) -> dict[str, Any]:
    """Have the person and the robot remember an hour as it stands in the trace; return the home as it was left.

    Raises:
        RunError: If the state of the home there is not the one that was written.
    """
    clock = Clock(day=plan.episode_day, hour=record.hour)
    world: dict[str, Any] = record.world["poses"]
    if digest(world) != record.world["sha256"]:
        raise RunError(
            f"The trace of day {plan.day}, {clock.label}, was altered: world.poses does not fit world.sha256."
        )
    services.life.end(services, plan, clock, record.human)
    if record.robot is not None:
        remember_guess(services, plan, clock, record.robot)
    return world


def remember_guess(services: Services, plan: DayPlan, clock: Clock, robot: RobotHour) -> None:
    """Have the robot remember what it took an hour for, and nothing of that hour or later besides."""
    memories = services.memories("guesses", plan.episode, robot.with_whom or plan.person)
    memories.forget_from(clock.now)
    for guess in guesses([(clock.hour, robot)], plan.episode_day * 24):
        memories.add(guess.intention, guess.tasks, guess.now, seen=guess.seen)


def remember_day(services: Services, plan: DayPlan, hours: Sequence[HourRecord]) -> None:
    """Have the robot remember what it was told of a day, and nothing of that day or later besides."""
    forget_ahead(services, plan, [plan.person])
    services.memories("history", plan.episode, plan.person).extend(
        (
            plan.episode_day * 24 + hour.hour,
            hour.human.intention.text,
            [task.act.describe() for task in hour.human.tasks],
        )
        for hour in hours
        if hour.human is not None and not hour.human.intention.away
    )


def forget_ahead(services: Services, plan: DayPlan, people: Iterable[PersonId]) -> None:
    """Have the robot know nothing of what people told it of this day or a later one: nobody has told it yet."""
    for person in people:
        services.memories("history", plan.episode, person).forget_from(plan.episode_day * 24)
