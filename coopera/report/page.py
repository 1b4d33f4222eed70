"""report.html: the whole run on one page that needs nothing else, written from the run directory alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from markupsafe import Markup

from coopera.config.files import write_atomic
from coopera.core.clock import hour_label
from coopera.core.errors import CooperaError, RunError
from coopera.core.hour import Evening, HourRecord
from coopera.core.people import BigFive, Persona
from coopera.evaluation.measuring import all_measures, told_in_the_evening
from coopera.evaluation.robot.error_budget import Helps
from coopera.report import charts, learned
from coopera.report.budget import budget_of, day_rows, home_folders, imagines, in_words, predicate_of
from coopera.report.differing import as_page, offers_of
from coopera.report.environment import environment
from coopera.report.hours import HourView, hour_view, mark_slow, poses_before
from coopera.report.look import TEMPLATES, style_with
from coopera.report.packs import pack_days
from coopera.report.pictures import Album, Frames, embed, frames_by_view, pictures_of
from coopera.report.plan import Homes
from coopera.report.policy import content_policy
from coopera.rundir import seals
from coopera.rundir.directory import RunDir
from coopera.rundir.summary import day_entry, headline, needed, pooled, summarise

MAX_BYTES, SMALL_BYTES, HOUR_BYTES = 24_000_000, 4_900_000, 75_000
"""The largest page; that of few hours; and what each hour adds where there are many."""


@dataclass(frozen=True, slots=True)
class DayView:
    """One day: its hours by hour of day, its figures and its evening."""

    entry: dict[str, Any]
    hours: list[HourView]
    evening: Evening | None
    traits: Markup | None
    name: str


@dataclass(frozen=True, slots=True)
class Book:
    """A run as it is shown: its records with what the evening told, its evenings by day, its people, and its days."""

    records: list[HourRecord]
    evenings: dict[int, Evening]
    people: dict[str, Persona]
    days: list[DayView]


def write_report(run: RunDir) -> Path:
    """Write report.html into the run's folder and return its path.

    Raises:
        RunError: If the trace is damaged or the file cannot be written.
    """
    path = run.root / "report.html"
    try:
        write_atomic(path, fitted(run))
        seals.seal_report(run.root)
    except OSError as err:
        raise RunError(f"{path}: the report cannot be written ({err.strerror or err}).") from err
    return path


def fitted(run: RunDir) -> str:
    """The page with as many pictures as fit beside its text, and with prompts and replies where these fit, too."""
    most = _most_bytes(len(run.hours_done()))
    packs = pack_days(run.hours(), run.evenings())
    packed = sum(map(len, packs.values()))
    if packed > most // 3:
        packs, packed = {}, 0
    frames = frames_of(run)
    text, album = texts(run, packs), embed(frames, most - packed)
    html = fill(text, album)
    if album.kept and (over := len(html.encode()) - most) > 0:
        html = fill(text, embed(frames, max(album.size - over, 0)))
    return html


def _most_bytes(hours: int) -> int:
    """How large a page may be: that of five days below 5 MB, to open at once; that of many days in proportion."""
    return min(max(SMALL_BYTES, hours * HOUR_BYTES), MAX_BYTES)


def frames_of(run: RunDir) -> Frames:
    """The run's sampled frames."""
    hours = {(one.day, one.hour): pictures_of(run.root, one) for one in run.hours() if one.robot}
    return frames_by_view(run.root, hours)


def texts(run: RunDir, packs: Mapping[str, str] | None = None) -> dict[str, Any]:
    """What the page shows besides pictures; a run that is not finished is shown as far as it got.

    Args:
        run: The run.
        packs: Its prompts and replies, as of `pack_days`; without them the page says where to see them.
    """
    evenings, homes = run.evenings(), Homes(home_folders(run))
    with predicate_of(run) as helps:
        book = gather(run, run.hours(), evenings, helps=helps, homes=homes)
    style = style_with("style.css")
    script = "".join((TEMPLATES / name).read_text(encoding="utf-8") for name in ("theme.js", "hours.js"))
    scenes = dict.fromkeys(hour.record.scene for day in book.days for hour in day.hours if hour.plan)
    return {
        **analysis(run, book),
        "packed": packs is not None and bool(packs),
        "packs": packs or {},
        "homes": [homes.drawing(scene) for scene in scenes],
        "hour_at": lambda day, hour: f"#d{day}h{hour}",
        "style": Markup(style),
        "script": Markup(script),
        "policy": content_policy(styles=[style], scripts=[script], coloured=True),
    }


def fill(texts: Mapping[str, Any], album: Album) -> str:
    """The page with its pictures."""
    days = [replace(day, hours=[_pictured(hour, album) for hour in day.hours]) for day in texts["days"]]
    return environment().get_template("report.html.j2").render(texts, days=days, album=album)


def _pictured(hour: HourView, album: Album) -> HourView:
    return replace(hour, views=album.views.get((hour.record.day, hour.record.hour), {}))


def gather(
    run: RunDir,
    hours: Sequence[HourRecord],
    evenings: Sequence[Evening],
    *,
    helps: Callable[[HourRecord], Helps] | None = None,
    homes: Homes | None = None,
) -> Book:
    """What is known of a run, hour by hour, from those of its records that can be read."""
    told = {evening.day: evening for evening in evenings}
    records = told_in_the_evening(hours, told.values())
    people = run.people()
    before = poses_before(records)
    asks = imagines(run.config.method)
    found: dict[int, list[HourView]] = {}
    for record in records:
        plan = homes.plan(record, before.get((record.day, record.hour))) if homes else None
        view = hour_view(record, told.get(record.day), helps=helps, imagines=asks, plan=plan)
        found.setdefault(record.day, []).append(view)
    mark_slow([view for views in found.values() for view in views])
    return Book(records, told, people, _days(found, told, people))


def analysis(run: RunDir, book: Book) -> dict[str, Any]:
    """What the charts and tables over all hours of a run show."""
    records, evenings = book.records, book.evenings
    return {
        "run": run,
        "config": run.config,
        "info": run.info,
        "people": book.people,
        "days": book.days,
        "hours": run.config.day_hours,
        "summary": summarise(run.config, records, list(evenings.values()), run.prices),
        "overall": {spec.name: pooled(records, spec.name) for spec in all_measures()},
        "measures": all_measures(),
        "curve": _curve(book.days),
        "ends": _ends(records),
        "need": needed(records),
        "budget": _budget(run, records, list(evenings.values())),
        "differing": as_page(offers_of(records)),
        "by_hour": _by_hour(records, run.config.day_hours),
        "calibration": _calibration(records, evenings),
        "mixed_up": {
            "activity": learned.by_activity(records, evenings),
            "hour": learned.by_hour(records, evenings),
        },
        "offline": offline_roles(run.info.get("models", {})),
    }


def _days(
    found: Mapping[int, list[HourView]], evenings: Mapping[int, Evening], people: Mapping[str, Persona]
) -> list[DayView]:
    views: list[DayView] = []
    before: dict[tuple[int, str], BigFive | None] = {}
    for day, hours in sorted(found.items()):
        of_day = [hour.record for hour in hours]
        evening = evenings.get(day)
        person = people.get(of_day[0].person)
        key = (of_day[0].episode, of_day[0].person)
        seen = evening.belief.big_five if evening else None
        traits = charts.traits(person.big_five if person else None, seen, before.get(key)) if seen else None
        before[key] = seen
        name = person.name if person else of_day[0].person
        views.append(DayView(day_entry(of_day), hours, evening, traits, name))
    return views


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


def offline_roles(models: Mapping[str, str]) -> list[str]:
    """Who was played by the offline routine model, as the page calls them."""
    names = {"human": "the person", "robot": "the robot", "judge": "the judge"}
    return [name for role, name in names.items() if models.get(role, "").startswith("offline")]
