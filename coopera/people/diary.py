"""A diary: what somebody did from when to when, and how that becomes hours.

Rows have day, start, end, activity and perhaps tasks and away. Times are "HH:MM", or minutes of the day as whole
numbers, up to 48:00; those past 24:00 are of the next day, and an end before the start is, too.

An episode has a place in each hour of which it takes ten minutes or more; one that takes ten minutes of no hour has its
place where it begins. Of those with a place in an hour, this one is the hour's intention:

1. One of ten minutes or more that has had no hour yet, so that a meal does not vanish behind a long afternoon; of
   several, one without a place in the next hour before one that goes on there, and then the longest.
2. Else the one that takes most of the hour.

An hour is marked as continued where its episode was already an hour's intention. An hour without an episode is not
there, and neither is a day without a row of its own, into which only the night before goes on.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationError

from coopera.core.errors import ConfigError
from coopera.core.hour import LoggedHour
from coopera.core.people import Frozen
from coopera.people.rows import Rows, refuse_missing

COLUMNS = ("day", "start", "end", "activity", "tasks", "away")
DAY = 24 * 60  # minutes
LATEST = 2 * DAY
AT_LEAST = 10  # minutes of an hour that give an episode a place in it
LONGEST_NIGHT = 16 * 60  # an end before the start is of the next day, if the episode is no longer than this
_NEEDED = ("day", "start", "end", "activity")
_CLOCK = re.compile(r"([0-9]{1,2}):([0-5][0-9])")
_MINUTES = re.compile(r"0|[1-9][0-9]{0,3}")
_TIME = "a time such as 09:30 or 25:30, or minutes of the day such as 570, up to 48:00"
_EXPECTED = {
    "day": "a whole number from 0 up",
    "start": _TIME,
    "end": _TIME,
    "activity": "a text of 1 to 300 characters",
    "tasks": "at most 8 texts of 1 to 300 characters",
    "away": "yes or no",
}


def minute(said: Any) -> int:
    """The minute of the day that a cell says, from 0 to 48:00.

    Raises:
        ValueError: If it is no such time. Numbers with a zero before them are none, since 0930 may mean half past nine.
    """
    text = str(said).strip()
    if isinstance(said, bool) or not isinstance(said, int | str):
        raise ValueError(text)
    if clock := _CLOCK.fullmatch(text):
        found = 60 * int(clock[1]) + int(clock[2])
    elif _MINUTES.fullmatch(text):
        found = int(text)
    else:
        raise ValueError(text)
    if found > LATEST:
        raise ValueError(text)
    return found


Minute = Annotated[int, BeforeValidator(minute)]


class Episode(Frozen):
    """What somebody did for a while. `start` and `end` are minutes of `day`, past 1440 those of the next one."""

    day: int = Field(ge=0)
    start: Minute
    end: Minute
    activity: str = Field(min_length=1, max_length=300)
    tasks: Annotated[list[Annotated[str, Field(min_length=1, max_length=300)]], Field(max_length=8)] = []
    away: bool = False

    @property
    def begins(self) -> int:
        """Start in minutes since day 0."""
        return self.day * DAY + self.start

    @property
    def ends(self) -> int:
        """End in minutes since day 0."""
        return self.day * DAY + self.end

    @property
    def minutes(self) -> int:
        """How long it lasts."""
        return self.end - self.start

    def minutes_of(self, hour: int) -> int:
        """How many minutes it takes of an hour, counted from day 0."""
        return max(0, min(self.ends, 60 * hour + 60) - max(self.begins, 60 * hour))

    def places(self) -> list[int]:
        """The hours, counted from day 0, that it may stand for."""
        first, last = self.begins // 60, (self.ends - 1) // 60
        return [hour for hour in range(first, last + 1) if self.minutes_of(hour) >= AT_LEAST] or [first]


def hours_of(episodes: Iterable[Episode]) -> list[LoggedHour]:
    """The hours of episodes that do not overlap, by the rule above, sorted by day and hour."""
    days: set[int] = set()
    in_hour: dict[int, list[Episode]] = {}
    for episode in sorted(episodes, key=lambda one: one.begins):
        days.add(episode.day)
        for hour in episode.places():
            in_hour.setdefault(hour, []).append(episode)
    told: set[int] = set()
    hours = []
    for at, here in sorted(in_hour.items()):
        episode = _intended(at, here, told)
        if at // 24 in days:
            hours.append(
                LoggedHour(
                    day=at // 24,
                    hour=at % 24,
                    intention=episode.activity,
                    tasks=episode.tasks,
                    continues=episode.begins in told,
                    away=episode.away,
                )
            )
        told.add(episode.begins)
    return hours


def _intended(hour: int, here: Sequence[Episode], told: set[int]) -> Episode:
    """The episode that an hour is about; `told` has the beginnings of those that have had an hour. The earlier wins."""
    new = [one for one in here if one.minutes >= AT_LEAST and one.begins not in told]
    if new:
        last_chance = [one for one in new if one.minutes_of(hour + 1) < AT_LEAST]
        return max(last_chance or new, key=lambda one: one.minutes)
    return max(here, key=lambda one: one.minutes_of(hour))


def read_episodes(path: Path, rows: Rows) -> list[Episode]:
    """The episodes of a diary's rows, sorted by their beginning.

    Raises:
        ConfigError: If a column is missing or unknown, a value is wrong, an episode ends before it starts, two overlap,
            or there is none; names the file and the line.
    """
    refuse_missing(path, rows, _NEEDED)
    found = [(_episode(path, line, row), line) for line, row in rows.rows]
    if not found:
        raise ConfigError(f"{path}: the diary holds no episode.")
    found.sort(key=lambda one: one[0].begins)
    if clash := overlap([episode for episode, _ in found]):
        (one, line), (other, other_line) = (found[at] for at in clash)
        raise ConfigError(
            f"{path}, line {max(line, other_line)}: day {other.day}, {said(other)} overlaps with day {one.day}, "
            f"{said(one)} in line {min(line, other_line)}; a person does one thing at a time."
        )
    return [episode for episode, _ in found]


def overlap(episodes: Sequence[Episode]) -> tuple[int, int] | None:
    """Which two of some episodes, sorted by beginning, overlap first; None where none do."""
    clashes = ((at, at + 1) for at, (one, two) in enumerate(pairwise(episodes)) if two.begins < one.ends)
    return next(clashes, None)


def said(episode: Episode) -> str:
    """An episode as a sentence names it, such as "Cook" from 18:00 to 18:40."""
    return f'"{episode.activity}" from {as_clock(episode.start)} to {as_clock(episode.end)}'


def as_clock(minutes: int) -> str:
    """Minutes of the day as "HH:MM", past midnight as "25:30"."""
    return f"{minutes // 60:02d}:{minutes % 60:02d}"


def as_csv(episodes: Iterable[Episode]) -> str:
    """A diary file's text; it reads back as the same episodes."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for one in episodes:
        times = (as_clock(one.start), as_clock(one.end))
        writer.writerow((one.day, *times, one.activity, ";".join(one.tasks), "yes" if one.away else ""))
    return text.getvalue()


def _episode(path: Path, line: int, row: Mapping[str, Any]) -> Episode:
    where = f"{path}, line {line}"
    unknown = [name for name in row if name not in COLUMNS]
    if unknown:
        raise ConfigError(f"{where}: there is no field {unknown[0]!r} (a diary has {', '.join(COLUMNS)}).")
    try:
        episode = Episode.model_validate(dict(row))
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = str(first["loc"][0])
        if first["type"] == "missing":
            raise ConfigError(f"{where}: the field {field} is missing.") from None
        raise ConfigError(f"{where}: {field} must be {_EXPECTED[field]}, not {str(row[field])[:60]!r}.") from None
    if episode.start < episode.end:
        return episode
    past_midnight = episode.model_copy(update={"end": episode.end + DAY})
    if episode.start == episode.end or not 0 < past_midnight.minutes <= LONGEST_NIGHT or episode.start >= DAY:
        raise ConfigError(
            f"{where}: {said(episode)} ends before it starts; past midnight an episode lasts "
            f"{LONGEST_NIGHT // 60} hours at most, or its end is said as 25:30."
        )
    return past_midnight
