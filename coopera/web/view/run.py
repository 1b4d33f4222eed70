"""The page of a run: its figures, every hour in a line, and the charts and tables over all of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from coopera.core.errors import CooperaError
from coopera.core.people import Persona
from coopera.evaluation.measures.help import Need
from coopera.report import charts
from coopera.report.hours import slow_from
from coopera.report.page import analysis, gather, offline_roles
from coopera.web.view.desk import Desk
from coopera.web.view.lines import Line, f1_of, need_of
from coopera.web.view.links import Late, hour_page
from coopera.web.view.listing import alike, pairs_of
from coopera.web.view.reading import plainly, read_all
from coopera.web.view.shelf import Shelved

AT_ONCE = 200
"""Hours of a run whose charts and tables over all hours stand on its page at once where pages are files."""
MOST_OTHERS = 60
"""Runs that a run may be compared with by a link of its page."""


@dataclass(frozen=True, slots=True)
class DayLines:
    """A day of a run: its hours in lines, and its figures."""

    day: int
    hours: list[Line]
    name: str
    need: Need
    f1: float | None
    judged: float | None
    ended: bool

    def at(self, hour: int) -> Line | None:
        """The line of an hour."""
        return next((line for line in self.hours if line.hour == hour), None)


def page(desk: Desk, entry: Shelved) -> dict[str, Any]:
    """What the page of a run shows; of one that cannot be opened, why, and what hours there are."""
    run, problem = desk.opened(entry)
    lines = desk.lines_of(entry)
    people: Mapping[str, Persona] = {}
    if run is not None:
        try:
            people = run.people()
        except CooperaError as err:
            problem = plainly(err, entry.root)
    days = days_of(entry, lines, people)
    return {
        "entry": entry,
        "info": run.info if run else {},
        "config": run.config if run else None,
        "problem": problem,
        "damaged": [line for line in lines if line.state == "damaged"],
        "people": people,
        "days": days,
        "lines": lines,
        "hours": sorted({line.hour for line in lines}),
        "flagged": with_slow(lines),
        "need": need_of(lines),
        "first": need_of(_of_age(lines, min)).f1,
        "last": need_of(_of_age(lines, max)).f1,
        "f1": f1_of([line.counts for line in lines]),
        "judged": f1_of([line.judged for line in lines]),
        "curve": curve(days),
        "offline": offline_roles(run.info.get("models", {})) if run else [],
        "live": entry.state == "running",
        "stamp": live(entry, lines)["stamp"],
        "others": _others(desk, entry),
        "analysis": _inline(desk, entry, lines),
    }


def analysis_page(desk: Desk, entry: Shelved) -> dict[str, Any]:
    """Charts and tables over all hours of a run; they need all of its records."""
    found = over_all(desk, entry)
    return {
        "entry": entry,
        "hour_at": Late(lambda links: lambda day, hour: links.run(entry.key, hour_page(day, hour))),
        **found,
    }


def over_all(desk: Desk, entry: Shelved) -> dict[str, Any]:
    """What charts and tables show, or the sentence that says why there are none."""
    run, problem = desk.opened(entry)
    if run is None:
        return {"days": [], "problems": [problem]}
    read = read_all(run)
    try:
        book = gather(run, read.hours, read.evenings)
        return {**analysis(run, book), "curve": None, "problems": read.problems}  # which stands above them already
    except CooperaError as err:
        return {"days": [], "problems": [*read.problems, plainly(err, entry.root)]}


def live(entry: Shelved, lines: Sequence[Line]) -> dict[str, Any]:
    """How a run stands, for a page that looks again now and then."""
    stamp = f"{entry.state} {len(lines)} {sum(line.state == 'damaged' for line in lines)} {len(ended(entry, lines))}"
    return {"state": entry.state, "hours": len(lines), "planned": entry.planned, "stamp": stamp}


def days_of(entry: Shelved, lines: Sequence[Line], people: Mapping[str, Persona]) -> list[DayLines]:
    """The days of a run."""
    over = ended(entry, lines)
    days: dict[int, list[Line]] = {}
    for line in lines:
        days.setdefault(line.day, []).append(line)
    return [
        DayLines(
            day=day,
            hours=hours,
            name=people[who].name if (who := _who(hours)) in people else who,
            need=need_of(hours),
            f1=f1_of([line.counts for line in hours]),
            judged=f1_of([line.judged for line in hours]),
            ended=day in over,
        )
        for day, hours in days.items()
    ]


def ended(entry: Shelved, lines: Sequence[Line]) -> set[int]:
    """The days that have an evening."""
    days = {line.day for line in lines}
    return {day for day in days if (entry.root / "trace" / f"day-{day:02d}" / "evening.json").is_file()}


def with_slow(lines: Sequence[Line]) -> dict[tuple[int, int], tuple[str, ...]]:
    """The flags of each hour, slow ones marked, by day and hour."""
    least = slow_from([line.seconds for line in lines])
    return {(one.day, one.hour): (*one.flags, *(("slow",) if one.seconds >= least else ())) for one in lines}


def curve(days: Sequence[DayLines]) -> Markup:
    """Success by day of the episode, all episodes together."""
    ages = sorted({day.hours[0].episode_day for day in days})
    of = {age: [line for day in days if day.hours[0].episode_day == age for line in day.hours] for age in ages}
    judged = [f1_of([line.judged for line in of[age]]) for age in ages]
    counted = [f1_of([line.counts for line in of[age]]) for age in ages]
    series = [
        charts.Series("judge F1", "judge", judged),
        charts.Series("predicate F1", "predicate", counted),
        charts.Series("need F1", "need", [need_of(of[age]).f1 for age in ages], labelled=len(ages) < 25),
    ]
    return charts.lines(series, [f"day {age}" if len(ages) < 12 else str(age) for age in ages])


def _inline(desk: Desk, entry: Shelved, lines: Sequence[Line]) -> Any:
    """Charts and tables that stand on the run's page itself, where it is a file; a server gives them when asked."""
    if not desk.files or len(lines) > AT_ONCE:
        return None
    found = over_all(desk, entry)
    return Late(lambda links: {**found, "hour_at": lambda day, hour: links.run(entry.key, hour_page(day, hour))})


def _who(hours: Sequence[Line]) -> str:
    return next((line.person for line in hours if line.person), "")


def _of_age(lines: Sequence[Line], which: Any) -> list[Line]:
    """The lines of the first or the last day of the episodes."""
    ages = [line.episode_day for line in lines]
    return [line for line in lines if line.episode_day == which(ages)]


def _others(desk: Desk, entry: Shelved) -> list[Shelved]:
    """Runs that a link leads to, beside this one; where pages are files, those that were written beside it."""
    entries = desk.shelf.entries()
    if desk.files:
        return [other for one, other in pairs_of(entries) if one.key == entry.key]
    return [one for one in entries if alike(entry, one)][:MOST_OTHERS]
