"""report.html: the whole run on one page that needs nothing else, written from the run directory alone."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from coopera.config.files import write_atomic
from coopera.core.clock import hour_label
from coopera.core.errors import CooperaError, RunError
from coopera.core.hour import Evening, FeedbackItem, HourRecord, IntentionCandidate, RobotHour, TaskCandidate
from coopera.core.household import Outcome
from coopera.core.people import BigFive, Persona
from coopera.evaluation.measuring import all_measures, told_in_the_evening
from coopera.report import charts, learned
from coopera.report.budget import budget_of, day_rows, in_words
from coopera.report.differing import as_page, offers_of
from coopera.report.pictures import Album, embed
from coopera.report.policy import content_policy
from coopera.report.progress import figure
from coopera.report.tree import reasons
from coopera.rundir import seals
from coopera.rundir.directory import RunDir
from coopera.rundir.helping import help_frames
from coopera.rundir.summary import day_entry, headline, needed, pooled
from coopera.rundir.trace_files import intention_verdicts

MAX_BYTES = 24_000_000
TEMPLATES = Path(__file__).parents[1] / "templates"


@dataclass(frozen=True, slots=True)
class TaskView:
    """One imagined task with all that is known of it.

    `kind` is hit, wrong (accepted, but of no use), miss (declined, but right), declined or unscored.
    """

    task: TaskCandidate
    kind: str
    answer: FeedbackItem | None
    outcome: Outcome | None


@dataclass(frozen=True, slots=True)
class CandidateView:
    """One imagined intention, whether it was right (None: unknown), and its tasks."""

    candidate: IntentionCandidate
    right: bool | None
    tasks: list[TaskView]


@dataclass(frozen=True, slots=True)
class HourView:
    """One hour as the page shows it; `flags` are what the filters ask for."""

    record: HourRecord
    anchor: str
    label: str
    candidates: list[CandidateView]
    flags: list[str]
    views: dict[str, list[str]]
    f1: float | None

    @property
    def away(self) -> bool:
        """Whether the person was away from home, so that there was nothing to help with."""
        return self.record.human is not None and self.record.human.intention.away


@dataclass(frozen=True, slots=True)
class DayView:
    """One day: its hours by hour of day, its figures and its evening."""

    entry: dict[str, Any]
    hours: list[HourView]
    evening: Evening | None
    traits: Markup | None
    name: str


def write_report(run: RunDir) -> Path:
    """Write report.html into the run's folder and return its path.

    Raises:
        RunError: If the trace is damaged or the file cannot be written.
    """
    path = run.root / "report.html"
    album = gather_pictures(run, MAX_BYTES)
    html = render(run, album)
    if (over := len(html.encode()) - MAX_BYTES) > 0:
        html = render(run, gather_pictures(run, max(album.size - over, 0)))
    try:
        write_atomic(path, html)
        seals.seal_report(run.root)
    except OSError as err:
        raise RunError(f"{path}: the report cannot be written ({err.strerror or err}).") from err
    return path


def gather_pictures(run: RunDir, budget: int) -> Album:
    """The run's sampled frames, in at most `budget` characters."""
    frames = {
        (one.day, one.hour): [*one.robot.observation.frames, *chain(*help_frames(run.root, one.day, one.hour).values())]
        for one in run.hours()
        if one.robot
    }
    return embed(run.root, frames, budget)


@functools.cache
def _environment() -> Environment:
    """The templates, compiled once: it takes longer than filling them."""
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"figure": figure, "hour": hour_label, "reasons": reasons, "flat": _flat, "words": _words}
    return environment


def render(run: RunDir, album: Album) -> str:
    """The page as text; a run that is not finished is shown as far as it got."""
    evenings = {evening.day: evening for evening in run.evenings()}
    records = told_in_the_evening(run.hours(), evenings.values())
    people = run.people()
    days = _days(run, records, album, people)
    style, script = ((TEMPLATES / name).read_text(encoding="utf-8") for name in ("style.css", "script.js"))
    return (
        _environment()
        .get_template("report.html.j2")
        .render(
            run=run,
            config=run.config,
            info=run.info,
            people=people,
            days=days,
            hours=run.config.day_hours,
            summary=run.summary(),
            overall={spec.name: pooled(records, spec.name) for spec in all_measures()},
            measures=all_measures(),
            curve=_curve(days),
            ends=_ends(records),
            need=needed(records),
            budget=_budget(run, records, list(evenings.values())),
            differing=as_page(offers_of(records)),
            by_hour=_by_hour(records, run.config.day_hours),
            calibration=_calibration(records, evenings),
            mixed_up={
                "activity": learned.by_activity(records, evenings),
                "hour": learned.by_hour(records, evenings),
            },
            album=album,
            offline=_offline_roles(run.info.get("models", {})),
            style=Markup(style),
            script=Markup(script),
            policy=content_policy(styles=[style], scripts=[script], coloured=True),
        )
    )


def _days(run: RunDir, records: Sequence[HourRecord], album: Album, people: Mapping[str, Persona]) -> list[DayView]:
    views: list[DayView] = []
    before: dict[tuple[int, str], BigFive | None] = {}
    for day in run.days():
        of_day = [record for record in records if record.day == day]
        if not of_day:
            continue
        evening = run.read_evening(day)
        person = people.get(of_day[0].person)
        key = (of_day[0].episode, of_day[0].person)
        seen = evening.belief.big_five if evening else None
        traits = charts.traits(person.big_five if person else None, seen, before.get(key)) if seen else None
        before[key] = seen
        hours = [hour_view(record, evening, album) for record in of_day]
        name = person.name if person else of_day[0].person
        views.append(DayView(day_entry(of_day), hours, evening, traits, name))
    return views


def hour_view(record: HourRecord, evening: Evening | None, album: Album) -> HourView:
    """Gather what is known of an hour: its candidates joined with the evening's answers and with what was done."""
    candidates = _candidates(record.robot, evening, record.hour) if record.robot else []
    kinds = {task.kind for guess in candidates for task in guess.tasks}
    flags: list[str] = [kind for kind in ("wrong", "miss") if kind in kinds]
    flags += ["failed"] if record.status == "failed" else []
    judged = [guess.right for guess in candidates if guess.right is not None]
    flags += ["unimagined"] if judged and not any(judged) else []
    return HourView(
        record=record,
        anchor=f"d{record.day}h{record.hour}",
        label=hour_label(record.hour),
        candidates=candidates,
        flags=flags,
        views=album.views.get((record.day, record.hour), {}),
        f1=record.success.predicate.f1 if record.success else None,
    )


def _candidates(robot: RobotHour, evening: Evening | None, hour: int) -> list[CandidateView]:
    right = intention_verdicts(evening, hour)
    tasks = _tasks(robot, evening, hour)
    candidates = [
        CandidateView(
            candidate, right.get(candidate.text), [one for one in tasks if one.task.intention == candidate.text]
        )
        for candidate in robot.intentions
    ]
    known = {candidate.text for candidate in robot.intentions}
    loose = [one for one in tasks if one.task.intention not in known]
    if loose:  # a method that skips intentions
        candidates.append(CandidateView(IntentionCandidate(text="no intention"), None, loose))
    return candidates


def _tasks(robot: RobotHour, evening: Evening | None, hour: int) -> list[TaskView]:
    items = [one for one in evening.feedback if one.hour == hour and one.kind == "task"] if evening else []
    in_order = len(items) == len(robot.tasks)  # the evening asks for every task of the hour, in order
    left = list(robot.outcomes)
    views = []
    for number, task in enumerate(robot.tasks):
        outcome = next((one for one in left if one.act == task.act), None) if task.accepted else None
        if outcome is not None:
            left.remove(outcome)
        views.append(TaskView(task, _kind(task), items[number] if in_order else None, outcome))
    return views


def _kind(task: TaskCandidate) -> str:
    if task.correct is None:
        return "unscored"
    if task.accepted:
        return "hit" if task.correct else "wrong"
    return "miss" if task.correct else "declined"


def _ends(records: Sequence[HourRecord]) -> tuple[float | None, float | None]:
    """Need F1 on the first and on the last day, each pooled over the episodes."""
    ages = [record.episode_day for record in records] or [0]
    first, last = (
        headline((record for record in records if record.episode_day == age), "help") for age in (min(ages), max(ages))
    )
    return first, last


def _curve(days: Sequence[DayView]) -> Markup:
    """Success by day of the episode: pooled over episodes, and each episode thinly where there are several."""
    ages = sorted({day.entry["episode_day"] for day in days})
    episodes = sorted({day.entry["episode"] for day in days})
    series = []
    if len(episodes) > 1:
        for episode in episodes:
            found = {day.entry["episode_day"]: day for day in days if day.entry["episode"] == episode}
            names = ", ".join(dict.fromkeys(day.name for day in found.values()))
            values = [found[age].entry["need"]["f1"] if age in found else None for age in ages]
            series.append(charts.Series(f"{names} (episode {episode})", "episode", values))
    for measure, name in (("judge", "judge"), ("predicate", "predicate"), ("help", "need")):
        values = [
            headline((hour.record for day in days if day.entry["episode_day"] == age for hour in day.hours), measure)
            for age in ages
        ]
        series.append(charts.Series(f"{name} F1", name, values, labelled=name == "need"))
    return charts.lines(series, [f"day {age}" for age in ages])


def _by_hour(records: Sequence[HourRecord], hours: Sequence[int]) -> Markup:
    """Need F1 by hour of day, pooled over all days."""
    values = [headline((record for record in records if record.hour == hour), "help") for hour in hours]
    return charts.bars(values, [hour_label(hour).replace(" ", "") for hour in hours])


def _budget(run: RunDir, records: Sequence[HourRecord], evenings: Sequence[Evening]) -> dict[str, Any] | None:
    """Where help was lost, as tables; None without a robot, or where a home of the run is gone."""
    try:
        found = budget_of(run, records, evenings)
    except CooperaError:
        return None
    total = found.total
    if not total.hours:
        return None
    return {"all": in_words(total), "days": day_rows(found.days), "missed": total.missed}


def _calibration(records: Sequence[HourRecord], evenings: Mapping[int, Evening]) -> Markup | None:
    """How far P(yes) of intentions (as judge) and tasks (as predicate) can be trusted; None where there is none.

    The first day's verdicts of an untrained classifier, all 0.5, are left out.
    """
    pairs = {"predicate": learned.task_pairs(records), "judge": learned.intention_pairs(records, evenings)}
    bins = {
        kind: [
            (one.said, one.right, one.count)
            for one in learned.calibration((p, right) for p, right in found if p != 0.5)
            if one.said is not None and one.right is not None
        ]
        for kind, found in pairs.items()
    }
    return charts.calibration(bins) if any(bins.values()) else None


def _offline_roles(models: Mapping[str, str]) -> list[str]:
    """Who was played by the offline routine model, as the page calls them."""
    names = {"human": "the person", "robot": "the robot", "judge": "the judge"}
    return [name for role, name in names.items() if models.get(role, "").startswith("offline")]


def _flat(value: object) -> str:
    """A measurement as short words."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_flat(one)}" for name, one in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(_flat(one) for one in value)
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def _words(items: Sequence[str]) -> str:
    """Join words as people do: "a, b and c"."""
    return " and ".join(filter(None, [", ".join(items[:-1]), *items[-1:]]))
