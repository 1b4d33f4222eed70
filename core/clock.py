"""Simulated time: whole hours of numbered days."""

from __future__ import annotations

from pydantic import Field

from coopera.core.people import Frozen

WEEKDAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
FIRST_HOUR = 9  # PAPER §3.1: the day starts at 9 am
HOURS_PER_DAY = 13  # PAPER §3.2 and the authors' code: 9 am … 9 pm inclusive (the text also says 12)


class Clock(Frozen):
    """One hour of one day; day 0 is a Monday."""

    day: int = Field(ge=0)
    hour: int = Field(ge=0, le=23)

    @property
    def now(self) -> int:
        """Global hour index, day x 24 + hour, so that nights decay memories too."""
        return self.day * 24 + self.hour

    @property
    def weekday(self) -> str:
        """Name of the day of the week."""
        return WEEKDAYS[self.day % 7]

    @property
    def label(self) -> str:
        """The hour as people say it, such as "9 am" or "1 pm"."""
        return hour_label(self.hour)


def hour_label(hour: int) -> str:
    """Return an hour of day (0-23) as people say it, such as "12 pm"."""
    return f"{(hour - 1) % 12 + 1} {'am' if hour < 12 else 'pm'}"
