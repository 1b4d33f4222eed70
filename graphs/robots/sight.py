"""What a robot saw of the first task, in words and as prompts read it."""

from __future__ import annotations

from typing import Any

from coopera.core.hour import Observation


def agreeing(seen: Observation) -> Observation:
    """What is seen without what contradicts it: where the first task is told in words, no motion is guessed."""
    if not seen.first_task or seen.percept is None:
        return seen
    return seen.model_copy(update={"percept": seen.percept.model_copy(update={"motion": ""})})


def in_words(seen: Observation, said: str = "") -> str:
    """The first task as it was told, else the percept's sentence, else what the robot's own model `said` it saw."""
    return seen.first_task or (seen.percept.caption() if seen.percept else said)


def as_percept(seen: Observation) -> dict[str, Any] | None:
    """The variable `percept` of `coopera.core.asks`."""
    if seen.percept is None:
        return None
    return {**seen.percept.model_dump(), "states": seen.percept.states, "caption": seen.percept.caption()}
