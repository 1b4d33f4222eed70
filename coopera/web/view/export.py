"""The viewer's pages as files, which any browser shows without a server."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from coopera.config.files import reason
from coopera.core.errors import ConfigError, CooperaError
from coopera.core.hour import HourRecord
from coopera.report.pictures import pictures_of
from coopera.rundir.trace_files import read_record
from coopera.web.common.pages import STATIC
from coopera.web.view.lines import trace_files
from coopera.web.view.links import INDEX, evening_page
from coopera.web.view.listing import pairs_of
from coopera.web.view.reading import plainly
from coopera.web.view.shelf import Shelved
from coopera.web.view.site import Answer, Site

MARK = "coopera-view.txt"
"""A file that says that a folder was written by us and may be written again."""


class Exported(NamedTuple):
    """What was written."""

    start: Path
    pages: int
    size: int


def export(root: Path, out: Path) -> Exported:
    """Write the viewer of a folder as files; what cannot be made is a page that says why.

    Args:
        root: The folder of runs.
        out: A folder that is empty, not there yet, or was written by this before.

    Raises:
        ConfigError: If the one is no folder, or the other cannot be written.
    """
    site = Site.of(root, files=True)
    _prepare(out)
    pages = size = 0
    try:
        for address in _addresses(site):
            found = _answer(site, address)
            if found is not None:
                path = out / address
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(found.body)
                pages += found.kind == "text/html"
                size += len(found.body)
        for name, data in site.pages.contents():
            path = out / name.removeprefix("/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            size += len(data)
        (out / MARK).write_text("Written by coopera view --static; written anew, everything here is replaced.\n")
    except OSError as err:
        raise ConfigError(f"--static: {out} cannot be written ({reason(err)}).") from err
    return Exported(out / INDEX, pages, size)


def _prepare(out: Path) -> None:
    """Make the folder, or empty one that was written before."""
    try:
        if out.is_dir() and os.listdir(out):
            if not (out / MARK).is_file():
                raise ConfigError(f"--static: {out} is not empty and was not written by this command; choose another.")
            for name in (INDEX, "run", "benchmark", "compare", STATIC.strip("/")):
                path = out / name
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
        out.mkdir(parents=True, exist_ok=True)
        (out / MARK).write_text("Being written.\n")
    except OSError as err:
        raise ConfigError(f"--static: {out} cannot be written ({reason(err)}).") from err


def _answer(site: Site, address: str) -> Answer | None:
    try:
        return site.answer(address)
    except CooperaError as err:
        return site.problem(address, plainly(err, site.desk.shelf.root))


def _addresses(site: Site) -> Iterator[str]:
    entries = site.desk.shelf.entries()
    yield INDEX
    for entry in entries:
        if entry.kind == "benchmark":
            yield f"benchmark/{entry.key}/{INDEX}"
        else:
            yield from (f"run/{entry.key}/{address}" for address in _of_run(site, entry))
    for one, other in pairs_of(entries):
        yield f"compare/{one.key}/{other.key}/{INDEX}"
        places = {line.path for entry in (one, other) for line in site.desk.lines_of(entry)}
        yield from (f"compare/{one.key}/{other.key}/{place}" for place in sorted(places))


def _of_run(site: Site, entry: Shelved) -> Iterator[str]:
    yield INDEX
    yield "analysis.html"
    lines = site.desk.lines_of(entry)
    yield from (line.path for line in lines)
    for day in dict.fromkeys(line.day for line in lines):
        yield evening_page(day)
        yield f"trace/day-{day:02d}/evening.json"
    for day, hour, path in trace_files(entry.root):
        yield f"trace/day-{day:02d}/hour-{hour:02d}.json"
        try:
            yield from pictures_of(entry.root, read_record(path, HourRecord))
        except CooperaError:  # its page says so
            continue
