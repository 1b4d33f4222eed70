"""Commands tried in small: the environment variable COOPERA_AT_MOST cuts the sizes of runs and benchmarks.

>>> COOPERA_AT_MOST=days=1,hours=2 coopera run

A documentation's commands can so be run as they stand, in seconds.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import Field, ValidationError

from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.core.people import Frozen

VARIABLE = "COOPERA_AT_MOST"
Most = Annotated[int, Field(ge=1)]


class AtMost(Frozen):
    """The largest sizes; None leaves a size as it is.

    Attributes:
        days: Days of an episode.
        hours: Hours of a day.
        episodes: Episodes of each setting of a benchmark.
        settings: Settings of a benchmark.
        methods: Methods of a benchmark.
        seeds: Seeds of a benchmark.
    """

    days: Most | None = None
    hours: Most | None = None
    episodes: Most | None = None
    settings: Most | None = None
    methods: Most | None = None
    seeds: Most | None = None


def at_most() -> AtMost:
    """Read the sizes from the environment.

    Raises:
        ConfigError: If the variable names anything but sizes.
    """
    pairs = [part.partition("=") for part in os.environ.get(VARIABLE, "").split(",") if part.strip()]
    try:
        return AtMost.model_validate({name.strip(): size.strip() for name, _, size in pairs})
    except ValidationError:
        known = ", ".join(AtMost.model_fields)
        raise ConfigError(
            f"{VARIABLE} must be sizes such as days=1,hours=2 (known are {known}), not {os.environ[VARIABLE]!r}."
        ) from None


def cut(config: Config) -> Config:
    """Cut a resolved configuration."""
    most = at_most()
    update: dict[str, Any] = {"days": smaller(config.days, most.days), "hours": smaller(config.hours, most.hours)}
    if config.schedule:
        days = config.schedule[: most.days]
        update |= {"schedule": days, **said_by(days)}  # else they would contradict it
    return config.model_copy(update=update)


def said_by(schedule: Sequence[tuple[str, str]]) -> dict[str, Any]:
    """What a schedule says of a run, as fields of its configuration: whose days, in which homes, how many."""
    who, where = (list(dict.fromkeys(names)) for names in zip(*schedule, strict=True))
    return {"humans": who, "scenes": where, "days": len(schedule)}


def smaller(size: int | None, most: int | None) -> int | None:
    """The smaller of two sizes, of which None is no limit."""
    return min((one for one in (size, most) if one is not None), default=None)
