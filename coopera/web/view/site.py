"""All pages of the viewer, by their address: the server answers with them, and the export writes them as files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from coopera.report.environment import equip
from coopera.report.pictures import TYPES, is_of_the_run
from coopera.web.common import Pages
from coopera.web.view import benchmark, compare, hour, listing, run
from coopera.web.view.desk import Desk
from coopera.web.view.links import INDEX, Late, Links
from coopera.web.view.search import Search
from coopera.web.view.shelf import Shelf, Shelved

HERE = Path(__file__).parent
MOST_FILE = 64 * 2**20
"""Bytes of a picture or a record that is handed out."""
Parts = tuple[str, ...]


class Answer(NamedTuple):
    """What an address is answered with."""

    kind: str
    body: bytes


@dataclass(frozen=True, slots=True)
class Site:
    """The viewer of one folder.

    Attributes:
        desk: What its pages are made from.
        pages: Templates and files of ours.
        search: Of texts.
    """

    desk: Desk
    pages: Pages
    search: Search

    @classmethod
    def of(cls, root: Path, *, files: bool = False) -> Site:
        """The viewer of a folder.

        Args:
            root: The folder.
            files: Whether the pages are to be written as files.

        Raises:
            ConfigError: If it is none.
        """
        pages = Pages(HERE)
        equip(pages.environment)
        return cls(Desk(Shelf(root), files), pages, Search())

    def answer(self, address: str, query: Mapping[str, str] | None = None) -> Answer | None:
        """The page, picture or record at an address; None where there is none.

        Raises:
            CooperaError: If it cannot be made; the rest of the viewer still can.
        """
        parts = tuple(PurePosixPath(address).parts)
        asked = query or {}
        match parts:
            case () | ("index.html",):
                return self._page(INDEX, "list.html.j2", listing.page(self.desk))
            case ("live.json",):
                return _json(listing.live(self.desk.shelf.entries()))
            case ("search.html",) if not self.desk.files:
                found = self.search.look(self.desk.shelf.entries(), asked.get("q", ""), asked.get("from", ""))
                return self._page("search.html", "search.html.j2", {"found": found})
            case ("run", key, *rest) if (entry := self.desk.shelf.find(key, "run")) is not None:
                return self._run(entry, tuple(rest))
            case ("benchmark", key, "index.html") if (entry := self.desk.shelf.find(key, "benchmark")) is not None:
                return self._page(
                    f"benchmark/{key}/{INDEX}", "benchmark_view.html.j2", benchmark.page(self.desk, entry)
                )
            case ("compare", one, other, *rest):
                return self._compare(one, other, tuple(rest))
            case _:
                return None

    def problem(self, address: str, sentence: str) -> Answer | None:
        """A page that says why there is no other."""
        return self._page(address, "trouble.html.j2", {"sentence": sentence})

    def _run(self, entry: Shelved, rest: Parts) -> Answer | None:
        here = f"run/{entry.key}/{'/'.join(rest)}"
        match rest:
            case () | ("index.html",):
                return self._page(f"run/{entry.key}/{INDEX}", "run.html.j2", run.page(self.desk, entry))
            case ("analysis.html",):
                return self._page(here, "run_analysis.html.j2", run.analysis_page(self.desk, entry))
            case ("live.json",):
                return _json(run.live(entry, self.desk.lines_of(entry)))
            case (day, "evening.html") if (number := _number(day, "day")) is not None:
                return self._page(here, "evening.html.j2", hour.evening_page_of(self.desk, entry, number))
            case (day, name) if (place := _hour(day, name)) is not None:
                return self._page(here, "hour.html.j2", hour.page(self.desk, entry, *place))
            case ("trace", day, name) if name.endswith(".json"):
                return _file(entry.root, ("trace", day, name), "application/json")
            case ("frames", *names) if kind := TYPES.get(PurePosixPath(names[-1]).suffix if names else ""):
                return _file(entry.root, rest, kind)
            case _:
                return None

    def _compare(self, one: str, other: str, rest: Parts) -> Answer | None:
        left, right = self.desk.shelf.find(one, "run"), self.desk.shelf.find(other, "run")
        if left is None or right is None:
            return None
        here = f"compare/{one}/{other}/{'/'.join(rest or (INDEX,))}"
        if rest in {(), (INDEX,)}:
            return self._page(here, "compare.html.j2", compare.page(self.desk, left, right))
        if len(rest) == 2 and (place := _hour(*rest)) is not None:
            return self._page(here, "compare_hour.html.j2", compare.hour_page(self.desk, left, right, *place))
        return None

    def _page(self, here: str, template: str, made: Mapping[str, Any] | None) -> Answer | None:
        if made is None:
            return None
        links = Links(here, self.pages.static)
        text = self.pages.environment.get_template(template).render(
            **{
                "link": links,
                "static": links.static,
                "files": self.desk.files,
                "form_token": "",
                "root": self.desk.shelf.root.name,
            },
            **{name: value(links) if isinstance(value, Late) else value for name, value in made.items()},
        )
        return Answer("text/html", text.encode())


def _number(text: str, word: str) -> int | None:
    """The number in a name such as "day-07"."""
    head, _, number = text.partition("-")
    return int(number) if head == word and number.isascii() and number.isdigit() and len(number) < 7 else None


def _hour(day: str, name: str) -> tuple[int, int] | None:
    number, hour_of_day = _number(day, "day"), _number(name.removesuffix(".html"), "hour")
    return (number, hour_of_day) if number is not None and hour_of_day is not None and name.endswith(".html") else None


def _file(root: Path, parts: Parts, kind: str) -> Answer | None:
    """A file of a run, if it truly lies within it and is not endless."""
    path = root.joinpath(*parts)
    if ".." in parts or not is_of_the_run(path, root):
        return None
    try:
        return Answer(kind, path.read_bytes()) if path.stat().st_size <= MOST_FILE else None
    except OSError:
        return None


def _json(data: Any) -> Answer:
    return Answer("application/json", json.dumps(data).encode())
