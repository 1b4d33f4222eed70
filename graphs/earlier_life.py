"""An earlier life: days that people lived alone before, so that several robots can meet the very same days.

A robot's acts may change the person's next acts, and then two methods would be measured on different days. So a run may
take each hour of the person from an earlier run without a robot. It takes the person's decisions, the robot's
observation, the outcomes of the person's acts, and the home at the end of the hour.
"""

from __future__ import annotations

from typing import Any, Protocol

from coopera.core.hour import DayPlan, HourRecord, Observation
from coopera.core.household import Outcome
from coopera.core.people import Frozen


class Shown(Frozen):
    """What a robot was shown of an hour: the same for every robot, so it is worked out once."""

    observation: Observation
    outcome: Outcome
    world: dict[str, Any]
    """The home after the first task."""


class Lived(Protocol):
    """A life that was lived without a robot."""

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
