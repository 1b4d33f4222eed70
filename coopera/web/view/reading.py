"""Reading runs for pages: what can be read is shown, and what cannot is a sentence beside it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any, TypeVar

from coopera.core.errors import CooperaError
from coopera.core.hour import Evening, HourRecord
from coopera.report.pictures import TYPES, is_of_the_run, pictures_of, view_of
from coopera.rundir.directory import RunDir
from coopera.rundir.trace_files import read_json, read_record
from coopera.web.view.lines import trace_files

Read = TypeVar("Read", HourRecord, Evening)


@dataclass(slots=True)
class Readable:
    """What of a run can be read.

    Attributes:
        hours: In order.
        evenings: In order.
        problems: A sentence for each file that cannot be read.
    """

    hours: list[HourRecord] = field(default_factory=list)
    evenings: list[Evening] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)


def read_all(run: RunDir) -> Readable:
    """Read all of a run that can be read."""
    found = Readable()
    days = []
    for day, _, path in trace_files(run.root):
        days.append(day)
        if (hour := try_read(path, HourRecord, run.root, found.problems)) is not None:
            found.hours.append(hour)
    for day in dict.fromkeys(days):
        path = run.evening_file(day)
        there = path.is_file() and not path.is_symlink()
        if there and (evening := try_read(path, Evening, run.root, found.problems)) is not None:
            found.evenings.append(evening)
    return found


def try_read(path: Path, kind: type[Read], root: Path, problems: list[str]) -> Read | None:
    """Read a record, or add a sentence to the problems."""
    try:
        return read_record(path, kind)
    except CooperaError as err:
        problems.append(plainly(err, root))
        return None


def plainly(err: CooperaError, root: Path) -> str:
    """An error as a page tells it: without the way to the run's folder, and not endless."""
    return str(err).replace(f"{root}/", "")[:600]


def poses_of(path: Path) -> Mapping[str, Any] | None:
    """`world.poses` of an hour's file, without the rest of it; None where there is none to be read."""
    try:
        found = read_json(path)["world"]["poses"]
    except (CooperaError, KeyError, TypeError):
        return None
    return found if isinstance(found, dict) else None


def picture_views(root: Path, record: HourRecord, link: Callable[[str], str]) -> tuple[dict[str, list[str]], list[str]]:
    """The addresses of an hour's pictures by view, and a sentence where files of pictures are missing."""
    views: dict[str, list[str]] = {}
    missing = []
    for name in pictures_of(root, record):
        path = PurePosixPath(name)
        if path.suffix not in TYPES or not is_of_the_run(root / path, root):
            missing.append(path.name)
            continue
        views.setdefault(view_of(path), []).append(link(name))
    if not missing:
        return views, []
    some = ", ".join(missing[:3]) + (f" and {len(missing) - 3} more" if len(missing) > 3 else "")
    return views, [f"Of its pictures {len(missing)} cannot be shown: {some} is not in the run's folder."]
