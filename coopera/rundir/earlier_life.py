"""An earlier life on file: the days of a finished run without a robot, for other runs to meet again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.config.schema import Config
from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import DayPlan, HourRecord, HumanHour
from coopera.graphs.earlier_life import Shown
from coopera.rundir.directory import RunDir
from coopera.rundir.trace_files import read_json, read_record

_PLAN = ("setting", "schedule", "collab", "humans", "scenes", "days", "hours", "seed")
_LIVED = ("person_model", "intentions", "absence", "person_memory", "changes", "base_url")


@dataclass(frozen=True, slots=True)
class LivedDays:
    """Reads a life from the folder of its run; implements `coopera.graphs.earlier_life.Lived`.

    What a robot is shown is kept in the folder `shown` of that run: the first robot's run works it out for the others.
    """

    root: Path
    others: Mapping[int, int] = field(default_factory=dict)
    """For each day of the run, the same day in the life of another person."""

    def hour(self, plan: DayPlan, hour: int) -> HourRecord:
        """The hour as it was lived."""
        path = self.root / "trace" / f"day-{plan.day:02d}" / f"hour-{hour:02d}.json"
        record = read_record(path, HourRecord)
        if (record.person, record.scene, record.episode_day) != (plan.person, plan.scene, plan.episode_day):
            raise RunError(f"{path}: this is an hour of {record.person} in {record.scene}, not of {plan.person}.")
        return record

    def stranger(self, plan: DayPlan, hour: int) -> HumanHour | None:
        """What another person, always the same one, did in this hour of theirs; None where they did nothing at home."""
        path = self.root / "trace" / f"day-{self.others[plan.day]:02d}" / f"hour-{hour:02d}.json"
        human = read_record(path, HourRecord).human if path.is_file() else None
        return None if human is None or human.intention.away else human

    def shown(self, plan: DayPlan, hour: int) -> Shown | None:
        """What was kept of the first task of an hour, or None."""
        path = self._shown(plan, hour)
        if not path.is_file():
            return None
        try:
            return Shown.model_validate(read_json(path))
        except ValidationError as err:
            raise RunError(f"{path}: the file is damaged; delete it, and it is made anew.") from err

    def keep(self, plan: DayPlan, hour: int, shown: Shown) -> None:
        """Keep what was shown of an hour."""
        path = self._shown(plan, hour)
        try:
            write_atomic(path, canonical_json(shown.model_dump(), indent=None))
        except OSError as err:
            raise RunError(f"{path}: what was shown cannot be kept ({reason(err)}).") from err

    def _shown(self, plan: DayPlan, hour: int) -> Path:
        return self.root / "shown" / f"day-{plan.day:02d}" / f"hour-{hour:02d}.json"


def open_earlier_life(config: Config) -> LivedDays | None:
    """The life that a configuration names, or None.

    Raises:
        ConfigError: If that run is not finished, had a robot, or lived other days than are asked for.
    """
    from coopera.evaluation import find_method  # noqa: PLC0415 - slow to import

    if config.earlier_life is None:
        return None
    run = RunDir.open(config.earlier_life)
    where = f"earlier_life: {config.earlier_life}"
    if run.state != "finished":
        raise ConfigError(f"{where} must be a finished run, and it is {run.state}.")
    if find_method(run.config.method).robot:
        raise ConfigError(f"{where} must be a run without a robot (--method none), and its method is another.")
    theirs, ours = _days(run.config), _days(config)
    for name in theirs:
        if theirs[name] != ours[name]:
            raise ConfigError(f"{where} has {name} {theirs[name]}, where this run has {ours[name]}.")
    return LivedDays(config.earlier_life, _others(run) if find_method(config.method).swapped else {})


def _others(run: RunDir) -> dict[int, int]:
    """By day, the same day of the next person in the order of their ids, the first one after the last."""
    lives: dict[str, dict[int, int]] = {}
    for day in run.days():
        first = run.read_day(day)[0]
        lives.setdefault(first.person, {})[first.episode_day] = day
    people = sorted(lives)
    if len(people) < 2:
        raise ConfigError(
            f"method: the robot of this method is told of another person, and only {people[0]} takes part in "
            f"{run.root}; live at least two people's days there."
        )
    after = dict(zip(people, [*people[1:], people[0]], strict=True))
    return {day: lives[after[who]][n] for who in people for n, day in lives[who].items() if n in lives[after[who]]}


def _days(config: Config) -> dict[str, Any]:
    """What decides a person's days."""
    data = config.model_dump(mode="json")
    return {**{name: data[name] for name in (*_PLAN, *_LIVED)}, "models.human": config.models.human}
