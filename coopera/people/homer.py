"""Schedules of HOMER and HOMER+ (Patel and others 2023), as JSON: simulated routines of households over many days.

The file is an object of days, {"A/train/000": {"schedule": [["breakfast", 485, 528], …]}, …}: the last part of a key is
the day's number, what is before it the person, and times are minutes of the day. Other fields of a day are not read.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json
from coopera.people.diary import DAY, LATEST, Episode
from coopera.people.published import PersonDiary, Published, counted, nobody, words
from coopera.people.rows import MOST_ROWS

OUT = "Be out of the home"
_LEAVING = "leave_home"
_SHAPE = 'expected an object of days such as {"A/train/000": {"schedule": [["breakfast", 485, 528]]}}'


def read_homer(path: Path, who: str | None, limit: int | None) -> Published:
    """Read schedules; from the end of leave_home to the next activity the person is away.

    Raises:
        ConfigError: If the file is of another shape, an activity ends before it starts or begins before the one before
            it has ended, a time is out of range, or nobody is there; names the day and the row.
    """
    days: dict[str, dict[int, list[Episode]]] = {}
    count = 0
    for key, day in _days(path).items():
        person, _, number = key.rpartition("/")
        if not person or not (number.isascii() and number.isdecimal()) or len(number) > 9:
            raise ConfigError(f"{path}: {key!r} must be a person and the number of a day, such as A/train/000.")
        if int(number) in days.setdefault(person, {}):
            raise ConfigError(f"{path}: day {int(number)} of {person} is there twice.")
        days[person][int(number)] = episodes = _episodes(f"{path}, {key}", int(number), day)
        count += len(episodes)
        if count > MOST_ROWS:
            raise ConfigError(f"{path}: at most {MOST_ROWS} activities are read, and this has more.")
    if who is not None and who not in days:
        raise nobody(path, who, list(days))
    people = [
        PersonDiary(person, "", [episode for number in sorted(found) for episode in found[number]])
        for person, found in days.items()
        if who in (None, person)
    ][:limit]
    new: dict[str, int] = {}
    for one in people:
        for episode in one.episodes:
            if episode.activity not in {*words("homer").values(), OUT}:
                new[episode.activity] = new.get(episode.activity, 0) + 1
    return Published(people, [f"Without words of their own, read as they stand: {counted(new)}."] if new else [])


def plain(activity: str) -> str:
    """An activity in plain words, such as "Wash the dishes after breakfast" for wash_dishes_breakfast."""
    known = words("homer").get(activity)
    if known is not None:
        return str(known)
    said = " ".join(activity.replace("_", " ").split())
    return said[:1].upper() + said[1:]


def _days(path: Path) -> dict[str, Any]:
    data = read_json(path)
    if not isinstance(data, dict):
        raise ConfigError(f"{path}: {_SHAPE}, not a {type(data).__name__}.")
    if not data:
        raise ConfigError(f"{path}: there is no day in this file.")
    return data


def _episodes(where: str, number: int, day: Any) -> list[Episode]:
    schedule = day.get("schedule") if isinstance(day, dict) else None
    if not isinstance(schedule, list) or not schedule:
        raise ConfigError(f"{where}: {_SHAPE}, with at least one activity.")
    rows = [_row(f"{where}, row {at}", row) for at, row in enumerate(schedule, 1)]
    episodes: list[Episode] = []
    for at, (activity, start, end) in enumerate(rows):
        if at and start < rows[at - 1][2]:
            raise ConfigError(
                f"{where}, row {at + 1}: {activity} begins at {start}, before {rows[at - 1][0]} has ended."
            )
        episodes.append(Episode(day=number, start=start, end=end, activity=plain(activity)))
        back = rows[at + 1][1] if at + 1 < len(rows) else DAY
        if activity == _LEAVING and end < back:
            episodes.append(Episode(day=number, start=end, end=back, activity=OUT, away=True))
    return episodes


def _row(where: str, row: Any) -> tuple[str, int, int]:
    """An activity with its start and end."""
    if not isinstance(row, list) or len(row) != 3:
        raise ConfigError(f'{where}: expected an activity, its start and its end, such as ["breakfast", 485, 528].')
    activity, *times = row
    if not isinstance(activity, str) or not 1 <= len(plain(activity)) <= 300:
        raise ConfigError(f"{where}: an activity must be a text of 1 to 300 characters, not {str(activity)[:60]!r}.")
    for time in times:
        if isinstance(time, bool) or not isinstance(time, int) or not 0 <= time <= LATEST:
            said = str(time)[:60]
            raise ConfigError(f"{where}: a time must be minutes of the day, from 0 to {LATEST}, not {said!r}.")
    if times[1] <= times[0]:
        raise ConfigError(f"{where}: {activity} ends at {times[1]}, and starts at {times[0]}.")
    return activity, times[0], times[1]
