"""Real people offline: whose log a run takes the person's hours from, checked against the days that are to be lived."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from coopera.config.schema import Config
from coopera.core.clock import hour_label
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan, LoggedHour
from coopera.core.people import PersonId
from coopera.graphs.players.stated import Logs
from coopera.people.log_file import open_log

_LOG = "log:"
_ENDINGS = (".csv", ".jsonl", ".ndjson")


def open_logs(config: Config, days: Sequence[DayPlan]) -> Logs | None:
    """Read the logs that `played_by: log:PATH` names; None where nobody wrote a log.

    PATH is one person's log or diary, or a folder with one per person, named by id (amara.csv). The recorded days of a
    person are lived in their order, whatever their numbers. An hour of which a diary says nothing is left open.

    Raises:
        ConfigError: If a log is missing, cannot be read, or lacks a day or an hour that is to be lived; if a day of a
            diary has none of the hours that are to be lived.
    """
    if not config.played_by.startswith(_LOG):
        return None
    path = Path(config.played_by.removeprefix(_LOG)).expanduser()
    people = list(dict.fromkeys(plan.person for plan in days))
    logs = {person: _by_day(_find(path, person, people)) for person in people}
    logged: dict[tuple[int, int], LoggedHour] = {}
    lived: dict[tuple[int, PersonId], int] = {}
    for plan in days:
        nth = lived.get((plan.episode, plan.person), 0)
        lived[plan.episode, plan.person] = nth + 1
        log = logs[plan.person]
        if nth >= len(log.days):
            raise ConfigError(
                f"{log.file}: the log has {len(log.days)} days, and {plan.person} is to live more; "
                f"use --days {len(log.days)}."
            )
        logged.update({(plan.day, hour): said for hour, said in _day(log, nth, plan).items()})
    return lambda plan, clock: logged.get((plan.day, clock.hour))


class _Days(NamedTuple):
    """A log by day and hour, and whether hours without a word are open."""

    file: Path
    days: dict[int, dict[int, LoggedHour]]
    diary: bool


def _by_day(path: Path) -> _Days:
    log = open_log(path)
    days: dict[int, dict[int, LoggedHour]] = {}
    for hour in log.hours:
        days.setdefault(hour.day, {})[hour.hour] = hour
    return _Days(path, days, log.diary)


def _day(log: _Days, nth: int, plan: DayPlan) -> dict[int, LoggedHour]:
    """What is recorded of the hours that a plan lives, on the nth recorded day."""
    day = list(log.days)[nth]
    found = {hour: log.days[day][hour] for hour in plan.hours if hour in log.days[day]}
    lived = f"{hour_label(plan.hours[0])} to {hour_label(plan.hours[-1])}"
    if log.diary and not found:
        raise ConfigError(f"{log.file}: day {day} of the diary says nothing of the hours that the run lives, {lived}.")
    for hour in plan.hours:
        if hour not in found and not log.diary:
            raise ConfigError(
                f"{log.file}: day {day} has no hour {hour} ({hour_label(hour)}); the run lives {lived}, "
                "so write it down or use --hours."
            )
    return found


def _find(path: Path, person: PersonId, people: Sequence[PersonId]) -> Path:
    if path.is_dir():
        found = [path / f"{person}{ending}" for ending in _ENDINGS if (path / f"{person}{ending}").is_file()]
        if not found:
            raise ConfigError(f"played_by: {path} must hold a log of each person; {person}.csv or .jsonl is missing.")
        return found[0]
    if len(people) > 1:
        raise ConfigError(
            f"played_by: {path} is the log of one person, and {len(people)} take part ({', '.join(people)}); name one "
            "with --humans, or give a folder with a log per person."
        )
    return path
