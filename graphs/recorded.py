"""What stands in the trace was done: an hour or an evening on file is taken over, and not done again.

A checkpoint may be behind the trace: the process was killed between the two, or the checkpoints were lost. Done again,
an hour would leave the trace for another one, with a model that never says the same twice. So the graphs take over
what they find, memories included, until they come to what is not there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from coopera.core.clock import Clock
from coopera.core.errors import RunError
from coopera.core.hour import DayPlan, HourRecord, HumanHour, RobotHour
from coopera.core.people import PersonId
from coopera.graphs.robots.robot_view import Memories
from coopera.graphs.robots.traits import guesses
from coopera.simulation.state.snapshots import digest

if TYPE_CHECKING:
    from coopera.graphs.services import Services


class Remembering(Protocol):
    """Where a run's memories are, such as `Services`."""

    def memories(self, owner: str, episode: int, person: PersonId) -> Memories:
        """The streams of one owner about a person in an episode."""
        ...


def take_over_hour(services: Services, plan: DayPlan, record: HourRecord) -> dict[str, Any]:
    """Have the person and the robot remember an hour as it stands in the trace; return the home as it was left.

    Raises:
        RunError: If the state of the home there is not the one that was written.
    """
    clock, world = Clock(day=plan.episode_day, hour=record.hour), world_after(record)
    services.life.end(services, plan, clock, record.human)
    if record.robot is not None:
        remember_guess(services, plan, clock, record.robot)
    return world


def world_after(record: HourRecord) -> dict[str, Any]:
    """The home as an hour left it, as a snapshot.

    Raises:
        RunError: If it is not what was written.
    """
    poses, sha = record.world.get("poses"), record.world.get("sha256")
    if not isinstance(poses, dict) or digest(poses) != sha:  # of a trace that was read, so of finite numbers
        label = Clock(day=record.episode_day, hour=record.hour).label
        raise RunError(f"The trace of day {record.day}, {label}, was altered: world.poses does not fit world.sha256.")
    return poses


def remember_lived(where: Remembering, plan: DayPlan, clock: Clock, human: HumanHour | None) -> None:
    """Have the person remember an hour, and nothing of it or later besides; `human` is None if it failed early."""
    memories = where.memories("human", plan.episode, plan.person)
    memories.forget_from(clock.now)
    if human:
        memories.add(human.intention.text, [task.act.describe() for task in human.tasks], clock.now)


def remember_guess(where: Remembering, plan: DayPlan, clock: Clock, robot: RobotHour) -> None:
    """Have the robot remember what it took an hour for, and nothing of that hour or later besides."""
    memories = where.memories("guesses", plan.episode, robot.with_whom or plan.person)
    memories.forget_from(clock.now)
    for guess in guesses([(clock.hour, robot)], plan.episode_day * 24):
        memories.add(guess.intention, guess.tasks, guess.now, seen=guess.seen)


def remember_day(where: Remembering, plan: DayPlan, hours: Sequence[HourRecord]) -> None:
    """Have the robot remember what it was told of a day, and nothing of that day or later besides."""
    forget_ahead(where, plan, [plan.person])
    where.memories("history", plan.episode, plan.person).extend(
        (
            plan.episode_day * 24 + hour.hour,
            hour.human.intention.text,
            [task.act.describe() for task in hour.human.tasks],
        )
        for hour in hours
        if hour.human is not None and not hour.human.intention.away
    )


def forget_ahead(where: Remembering, plan: DayPlan, people: Iterable[PersonId]) -> None:
    """Have the robot know nothing of what people told it of this day or a later one: nobody has told it yet."""
    for person in people:
        where.memories("history", plan.episode, person).forget_from(plan.episode_day * 24)


def told(
    plan: DayPlan, hours: Sequence[HourRecord], stranger: Callable[[DayPlan, int], HumanHour | None] | None
) -> list[HourRecord]:
    """A day's hours as the evening speaks of them: the person's own, or those of a stranger in their place."""
    if stranger is None:
        return list(hours)
    others = ((hour, stranger(plan, hour.hour)) for hour in hours)
    return [hour.model_copy(update={"human": other}) for hour, other in others if other is not None]
