"""The page of an hour, and that of an evening: one trace file each is read, never the whole run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from markupsafe import Markup

from coopera.core.errors import CooperaError
from coopera.core.hour import Evening, HourRecord
from coopera.evaluation.measuring import told_in_the_evening
from coopera.report.budget import home_folders, imagines, predicate_of
from coopera.report.hours import HourView, hour_view
from coopera.report.page import gather
from coopera.report.plan import Homes
from coopera.rundir.directory import RunDir
from coopera.web.view.desk import Desk
from coopera.web.view.lines import Line
from coopera.web.view.links import Late, Links, evening_page, hour_page
from coopera.web.view.reading import picture_views, poses_of, try_read
from coopera.web.view.run import with_slow
from coopera.web.view.shelf import Shelved


def page(desk: Desk, entry: Shelved, day: int, hour: int) -> dict[str, Any] | None:
    """What the page of an hour shows; of a damaged one, what is wrong with it; None where there is none."""
    lines = desk.lines_of(entry)
    line = next((one for one in lines if (one.day, one.hour) == (day, hour)), None)
    if line is None:
        return None
    run, problem = desk.opened(entry)
    problems = [problem] if problem else []
    view = drawing = None
    if run is not None:
        view, drawing = read_hour(run, lines, line, problems)
    return {
        "entry": entry,
        "line": line,
        "name": person_name(run, line),
        "flagged": with_slow(lines).get((day, hour), line.flags),
        "problems": problems,
        "hour": Late(lambda links: view and _with_pictures(entry, view, links)),
        "home": drawing,
        "around": _around(lines, line),
        "evening": evening_page(day) if (entry.root / "trace" / f"day-{day:02d}" / "evening.json").is_file() else None,
        "record": f"run/{entry.key}/trace/day-{day:02d}/hour-{hour:02d}.json",
    }


def read_hour(
    run: RunDir, lines: Sequence[Line], line: Line, problems: list[str]
) -> tuple[HourView | None, Markup | None]:
    """An hour with all that is known of it, and the drawing of its home; what cannot be read goes to the problems."""
    record = try_read(run.hour_file(line.day, line.hour), HourRecord, run.root, problems)
    if record is None:
        return None, None
    evening = evening_of(run, line.day, problems)
    [record] = told_in_the_evening([record], [evening] if evening else [])
    homes = Homes(home_folders(run))
    plan = homes.plan(record, _before(run, lines, line))
    with ExitStack() as stack:
        try:
            helps = stack.enter_context(predicate_of(run))
        except (CooperaError, OSError):
            helps = None
        view = hour_view(record, evening, helps=helps, imagines=imagines(run.config.method), plan=plan)
    return view, homes.drawing(record.scene) if plan else None


def evening_of(run: RunDir, day: int, problems: list[str]) -> Evening | None:
    """A day's evening; None where it has not ended, or where its file cannot be read."""
    path = run.evening_file(day)
    return try_read(path, Evening, run.root, problems) if path.is_file() and not path.is_symlink() else None


def evening_page_of(desk: Desk, entry: Shelved, day: int) -> dict[str, Any] | None:
    """What the page of an evening shows; None where there is none."""
    run, problem = desk.opened(entry)
    if not (entry.root / "trace" / f"day-{day:02d}" / "evening.json").is_file():
        return None
    problems = [problem] if problem else []
    lines = [line for line in desk.lines_of(entry) if line.day == day]
    shown, truth = None, None
    if run is not None:
        evening = evening_of(run, day, problems)
        hours = [try_read(run.hour_file(day, line.hour), HourRecord, run.root, problems) for line in lines]
        read = [one for one in hours if one is not None]
        if evening and read:
            before = evening_of(run, day - 1, []) if day else None
            book = gather(run, read, [*([before] if before else []), evening])
            shown, truth = book.days[-1], book.people.get(evening.person)
    return {
        "entry": entry,
        "day": day,
        "shown": shown,
        "truth": truth,
        "problems": problems,
        "lines": lines,
        "record": f"run/{entry.key}/trace/day-{day:02d}/evening.json",
        "last": lines[-1].path if lines else "",
    }


def _with_pictures(entry: Shelved, view: HourView, links: Links) -> HourView:
    views, missing = picture_views(entry.root, view.record, lambda name: links.run(entry.key, name))
    return replace(view, views=views, missing=missing)


def person_name(run: RunDir | None, line: Line) -> str:
    """What the person is called."""
    try:
        people = run.people() if run else {}
    except CooperaError:
        people = {}
    return people[line.person].name if line.person in people else line.person


def _before(run: RunDir, lines: Sequence[Line], line: Line) -> Mapping[str, Any] | None:
    """Where everything was when the hour began: where the hour before it ended, of the same episode and home."""
    at = lines.index(line)
    before = lines[at - 1] if at else None
    if before is None or (before.episode, before.scene) != (line.episode, line.scene):
        return None
    path: Path = run.hour_file(before.day, before.hour)
    return poses_of(path)


def _around(lines: Sequence[Line], line: Line) -> dict[str, str]:
    """The pages that keys lead to: j and k the hours beside, J and K the first hours of the days beside."""
    at = lines.index(line)
    days = list(dict.fromkeys(one.day for one in lines))
    place = days.index(line.day)
    found = {}
    if at + 1 < len(lines):
        found["j"] = lines[at + 1].path
    if at:
        found["k"] = lines[at - 1].path
    for key, number in (("J", place + 1), ("K", place - 1)):
        if 0 <= number < len(days):
            first = next(one for one in lines if one.day == days[number])
            found[key] = hour_page(first.day, first.hour)
    return found
