"""A run as a script or a notebook looks at it: hours, candidates and calls as tables, each hour by its number."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coopera.core.clock import hour_label
from coopera.core.errors import ConfigError
from coopera.core.hour import Evening, FeedbackItem, HourRecord, ModelCall
from coopera.core.household import SceneId
from coopera.core.notebook.cards import bar, card, note, table
from coopera.core.people import Persona
from coopera.rundir.directory import RunDir
from coopera.rundir.summary import metrics_rows
from coopera.rundir.trace_files import human_outcomes
from coopera.simulation.homes.scene import Scene, load_scene

if TYPE_CHECKING:
    from pandas import DataFrame

_HOUR = ("day", "episode", "episode_day", "hour", "person", "scene")
_SHOWN = 40  # hours on a card


def open_run(path: str | Path) -> Run:
    """Open a run for reading, finished or not; what was read stays as it was then.

    Raises:
        ConfigError: If the folder holds no run.
        RunError: If its files are damaged or newer than this version understands.
    """
    return Run(RunDir.open(Path(path)))


class Run:
    """A run to look at. Its tables are pandas frames, so they need pandas; everything else does not.

    Attributes:
        files: The run's folder, for whatever is not here.
    """

    def __init__(self, files: RunDir) -> None:
        """Use `open_run`."""
        self.files = files

    @property
    def path(self) -> Path:
        """The folder."""
        return self.files.root

    @property
    def state(self) -> str:
        """How the run stands: running, stopped, failed or finished."""
        return self.files.state

    @cached_property
    def records(self) -> list[HourRecord]:
        """All hours, in order, as the trace has them."""
        return self.files.hours()

    @cached_property
    def evenings(self) -> list[Evening]:
        """All evenings, in order."""
        return self.files.evenings()

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The content of summary.json, as far as the run has come."""
        return self.files.summary()

    @cached_property
    def people(self) -> dict[str, Persona]:
        """Those who take part, by id."""
        return self.files.people()

    def hour(self, day: int, hour: int) -> HourRecord:
        """One hour, such as `run.hour(0, 9)`.

        Raises:
            ConfigError: If the run has no such hour.
        """
        found = self.files.read_hour(day, hour)
        if found is None:
            raise ConfigError(f"{self.path}: there is no day {day}, {hour_label(hour)}.")
        return found

    def home(self, scene: str | None = None) -> Scene:
        """A home of the run as it was built; without a name, the first.

        Raises:
            ConfigError: If it cannot be found any more.
        """
        name = scene or (self.files.config.scenes or [""])[0]
        return load_scene(SceneId(name), [self.files.config.data_dir / "scenes", self.path / "scenes"])

    @cached_property
    def hours(self) -> DataFrame:
        """A row for each hour: what the person did, what the robot offered, and the predicate's figures."""
        return _frame([_hour_row(record) for record in self.records])

    @cached_property
    def candidates(self) -> DataFrame:
        """A row for each intention and each task that the robot imagined, with verdict, truth and the person's answer.

        `correct` is the predicate's and stands at tasks alone; `helpful`, `grade` and `said` are the evening's.
        """
        told: dict[tuple[int, int, str, str], FeedbackItem] = {
            (evening.day, item.hour, item.kind, item.text): item
            for evening in self.evenings
            for item in evening.feedback
        }
        return _frame([row for record in self.records for row in _candidate_rows(record, told)])

    @cached_property
    def calls(self) -> DataFrame:
        """A row for each call of a language model: of hours, then of the evening (`hour` is then missing)."""
        rows = [
            _call_row(call, record.day, record.hour, record.person) for record in self.records for call in record.calls
        ]
        rows += [_call_row(call, one.day, None, one.person) for one in self.evenings for call in one.calls]
        return _frame(sorted(rows, key=lambda row: row["day"])).astype({"hour": "Int64"}) if rows else _frame(rows)

    def __repr__(self) -> str:
        """The run in one line."""
        return f"<Run {self.path}: {self.state}, {len(self.records)} hours>"

    def _repr_html_(self) -> str:
        """The run on a card in a notebook: what it was, how it went day by day, and its hours."""
        config, said = self.files.config, self.summary
        about = f"{', '.join(self.people)} with method {config.method}, {len(self.records)} hours, {self.state}"
        days = [
            [day["day"], day["person"], day["scene"], bar(day["predicate"]["f1"]), bar((day["need"] or {}).get("f1"))]
            for day in said["days"]
        ]
        hours = [
            [
                f"day {one.day}, {hour_label(one.hour)}",
                one.human.intention.text if one.human else one.reason,
                *_score(one),
            ]
            for one in self.records[:_SHOWN]
        ]
        left = len(self.records) - len(hours)
        return card(
            self.path.name,
            about,
            table(["day", "person", "home", "F1", "need F1"], days),
            table(["hour", "the person set out to", "F1"], hours),
            *([note(f"and {left} hours more.")] if left else []),
        )


def _score(record: HourRecord) -> list[Any]:
    return [bar(record.success.predicate.f1 if record.success else None)]


def _where(record: HourRecord) -> dict[str, Any]:
    return {name: getattr(record, name) for name in _HOUR}


def _hour_row(record: HourRecord) -> dict[str, Any]:
    human, robot = record.human, record.robot
    done = human_outcomes(record)
    figures = next((row for row in metrics_rows(record) if row["measure"] == "predicate"), {})
    skipped = {*_HOUR, "measure", "status"}
    return {
        **_where(record),
        "status": record.status,
        "reason": record.reason,
        "intention": human.intention.text if human else None,
        "continues": human.intention.continues if human else None,
        "away": human.intention.away if human else None,
        "tasks": len(human.tasks) if human else 0,
        "failed_acts": sum(not one.ok for one in done),
        "offers": len(robot.tasks) if robot else 0,
        "accepted": sum(bool(one.accepted) for one in robot.tasks) if robot else 0,
        "helped": sum(one.ok for one in robot.outcomes) if robot else 0,
        **{name: value for name, value in figures.items() if name not in skipped},
        "calls": len(record.calls),
        "tokens": sum(call.tokens_in + call.tokens_out for call in record.calls),
        "seconds": sum(call.seconds for call in record.calls),
    }


def _candidate_rows(
    record: HourRecord, told: Mapping[tuple[int, int, str, str], FeedbackItem]
) -> Iterator[dict[str, Any]]:
    if record.robot is None:
        return
    known: list[tuple[str, str, str, Any, bool | None]] = [
        ("intention", one.text, one.text, one, None) for one in record.robot.intentions
    ]
    offers = [("task", one.act.describe(), one.intention, one, one.correct) for one in record.robot.tasks]
    for kind, text, intention, one, correct in [*known, *offers]:
        item = told.get((record.day, record.hour, kind, text))
        yield {
            **_where(record),
            "kind": kind,
            "text": text,
            "intention": intention,
            "probability": one.probability,
            "accepted": one.accepted,
            "correct": correct,
            "helpful": item.helpful if item else None,
            "grade": item.grade if item else None,
            "said": item.reason if item else None,
        }


def _call_row(call: ModelCall, day: int, hour: int | None, person: str) -> dict[str, Any]:
    plain = call.model_dump(
        include={"node", "prompt", "model", "seconds", "tokens_in", "tokens_out", "attempts", "cached"}
    )
    return {
        "day": day,
        "hour": hour,
        "person": person,
        **plain,
        "faults": len(call.faults),
        "leniencies": sum(call.leniencies.values()),
        "late": call.late,
        "asked": str(call.messages[0]["content"]) if call.messages else "",
        "reply": call.reply,
    }


def _frame(rows: Sequence[dict[str, Any]]) -> DataFrame:
    try:
        pandas: Any = importlib.import_module("pandas")
    except ImportError as err:
        raise ConfigError("The tables of a run need pandas: pip install coopera[notebook].") from err
    made: DataFrame = pandas.DataFrame(rows)
    return made
