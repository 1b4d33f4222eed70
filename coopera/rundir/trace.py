"""The trace of a run as a whole: where its hours and evenings lie, and which of them stand."""

from __future__ import annotations

from pathlib import Path

from coopera.core.hour import Evening, HourRecord
from coopera.rundir.trace_files import read_record


class Trace:
    """What is read of a run's folder `trace`.

    Attributes:
        root: The run's folder.
    """

    def __init__(self, root: Path) -> None:
        """Read nothing yet."""
        self.root = root

    def read_hour(self, day: int, hour: int) -> HourRecord | None:
        """An hour, or None where there is no trace of it."""
        path = self.hour_file(day, hour)
        return read_record(path, HourRecord) if path.is_file() else None

    def read_day(self, day: int) -> list[HourRecord]:
        """The hours of a day, in order."""
        return [read_record(path, HourRecord) for path in self._hour_files(day)]

    def read_evening(self, day: int) -> Evening | None:
        """A day's evening, or None where the day has not ended."""
        path = self.evening_file(day)
        return read_record(path, Evening) if path.is_file() else None

    def days(self) -> list[int]:
        """Numbers of the days of which there is a trace, sorted."""
        return sorted(int(path.name[4:]) for path in (self.root / "trace").glob("day-*") if path.name[4:].isdigit())

    def hours_done(self) -> list[tuple[int, int]]:
        """(day, hour) of each hour of which there is a trace, in order, without reading it."""
        return [(day, int(path.stem[5:])) for day in self.days() for path in self._hour_files(day)]

    def hours(self) -> list[HourRecord]:
        """All hours of the run, in order."""
        return [record for day in self.days() for record in self.read_day(day)]

    def evenings(self) -> list[Evening]:
        """All evenings of the run, in order."""
        return [evening for day in self.days() if (evening := self.read_evening(day))]

    def hour_file(self, day: int, hour: int) -> Path:
        """The file trace/day-DD/hour-HH.json, there or not."""
        return self._day(day) / f"hour-{hour:02d}.json"

    def evening_file(self, day: int) -> Path:
        """The file trace/day-DD/evening.json, there or not."""
        return self._day(day) / "evening.json"

    def _hour_files(self, day: int) -> list[Path]:
        return sorted(self._day(day).glob("hour-[0-9][0-9].json"))

    def _day(self, day: int) -> Path:
        return self.root / "trace" / f"day-{day:02d}"
