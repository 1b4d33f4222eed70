"""Identification: the robot infers from behaviour who the person is, among the people it knows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from coopera.core.clock import Clock
from coopera.core.hour import Observation
from coopera.core.people import PersonId
from coopera.graphs.robots.robot_view import Memories
from coopera.graphs.robots.sight import in_words

NEAREST = 10
"""Memories of each person that a sight is compared with."""
HOURS = 2.0
SHARPNESS = 8.0
_NEVER = 1e-6  # keeps one odd hour from ruling a person out


class Sight(NamedTuple):
    """When something was seen today, and what."""

    clock: Clock
    text: str


def sight(clock: Clock, seen: Observation) -> Sight:
    """The part of an observation to compare with people's accounts: the first task, or the percept's sentence."""
    return Sight(clock, in_words(seen))


def identify(sights: Sequence[Sight], known: Mapping[PersonId, Memories]) -> dict[PersonId, float]:
    """Return P(person) for each person known, from all that was seen today; the same person all day, equal priors.

    The likelihood of a sight for a person is a kernel density over the tasks of this person's accounts. A task weighs
    by its likeness to the sight (cosine) and by its distance to this hour of the day.
    """
    logs = {person: sum(_log_likelihood(one, memories) for one in sights) for person, memories in known.items()}
    highest = max(logs.values(), default=0.0)
    weights = {person: math.exp(log - highest) for person, log in logs.items()}
    total = sum(weights.values())
    return {person: weight / total for person, weight in weights.items()}


def _log_likelihood(seen: Sight, memories: Memories) -> float:
    if not seen.text:
        return 0.0
    nearest = memories.tasks.recall(seen.text, seen.clock.now, NEAREST)
    density = sum(
        math.exp(SHARPNESS * (one.relevance - 1) - ((one.hour % 24 - seen.clock.hour) / HOURS) ** 2 / 2)
        for one in nearest
    )
    return math.log(density / NEAREST + _NEVER)
