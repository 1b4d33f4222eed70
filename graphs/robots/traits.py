"""Traits inference: the robot's belief about the person, revised in the evening and, if wanted, hour by hour.

PAPER App. D. In the evening it rests on the person's account. During the day there is no account, so an hourly revision
rests on the robot's own guesses of the hours before. The evening starts again from the belief of the evening before.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from coopera.core.clock import Clock
from coopera.core.hour import HourRecord, RobotHour
from coopera.core.people import Belief
from coopera.core.protocols import Ask
from coopera.core.randomness import Address
from coopera.core.replies import TraitsReply
from coopera.graphs.robots.recall import Source, as_memory
from coopera.graphs.robots.sight import in_words


class Past(NamedTuple):
    """An hour as the robot knows it: from an account, or from its guesses and what it has `seen` of the first task."""

    now: int
    intention: str
    tasks: list[str]
    seen: Sequence[str] = ()

    def done(self, now: Clock, source: Source) -> list[dict[str, Any]]:
        """The tasks as prompts read them: what was seen first, the others from that source."""
        seen = [as_memory(task, self.now, now, "seen") for task in self.seen]
        return [*seen, *(as_memory(task, self.now, now, source) for task in self.tasks)]


def accounts(hours: Sequence[HourRecord], dawn: int) -> list[Past]:
    """The hours of a day by the person's account; those that failed or were spent away from home are left out."""
    return [
        Past(dawn + hour.hour, hour.human.intention.text, [task.act.describe() for task in hour.human.tasks])
        for hour in hours
        if hour.human is not None and not hour.human.intention.away
    ]


def guesses(hours: Sequence[tuple[int, RobotHour]], dawn: int) -> list[Past]:
    """The robot's guesses for some hours of a day: its likeliest intention, what it saw, and its accepted tasks.

    Hours in which it accepted no intention are left out.
    """
    past = []
    for hour, robot in hours:
        accepted = [candidate for candidate in robot.intentions if candidate.accepted]
        if accepted:
            guess = max(accepted, key=lambda candidate: candidate.probability or 0.0)
            words = in_words(robot.observation, robot.seen)
            tasks = [t.act.describe() for t in robot.tasks if t.accepted and t.intention == guess.text]
            past.append(Past(dawn + hour, guess.text, tasks, [words] if words else []))
    return past


def revise(
    ask: Ask, at: Address, clock: Clock, past: Sequence[Past], before: Belief, *, evening: bool
) -> tuple[Belief, dict[str, str]]:
    """Ask for a revised belief.

    Args:
        ask: The one door to language models.
        at: The address of the call.
        clock: Now.
        past: The hours it rests on.
        before: The belief so far.
        evening: Whether they come from the account, or from guesses.

    Returns:
        The belief, and the reasons for its parts.

    Raises:
        ModelOutputError: If the reply cannot be read.
    """
    source: Source = "told" if evening else "guessed"
    reply = ask(
        "robot/traits",
        TraitsReply,
        at=at,
        variables={
            "intentions": [as_memory(one.intention, one.now, clock, source) for one in past],
            "tasks": [task for one in past for task in one.done(clock, source)],
            "profile": before.profile,
            "evening": evening,
        },
    )
    reasons = {"big_five": reply.reasons_big_five, "profile": reply.reasons_profile}
    return Belief(big_five=reply.big_five, profile=reply.profile), reasons
