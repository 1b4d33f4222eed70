"""Addresses of the viewer's pages: relative to the page they stand on, so that they hold for files, too."""

from __future__ import annotations

import posixpath
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

INDEX = "index.html"


class Links:
    """Makes the links of one page.

    Args:
        here: The page's own address within the viewer, such as "run/KEY/index.html".
        file: Gives the address of one of our own files, such as a stylesheet, within the viewer.
    """

    def __init__(self, here: str, file: Callable[[str], str]) -> None:
        self.here = here
        self._file = file

    def to(self, address: str) -> str:
        """A link to an address within the viewer."""
        return quote(posixpath.relpath(address, posixpath.dirname(self.here) or "."))

    def static(self, name: str) -> str:
        """A link to one of our own files."""
        return self.to(self._file(name).lstrip("/"))

    def home(self) -> str:
        """The list."""
        return self.to(INDEX)

    def run(self, key: str, page: str = INDEX) -> str:
        """A run, or a page of it."""
        return self.to(f"run/{key}/{page}")

    def benchmark(self, key: str) -> str:
        """A benchmark."""
        return self.to(f"benchmark/{key}/{INDEX}")

    def compare(self, one: str, other: str, page: str = INDEX) -> str:
        """Two runs side by side, or an hour of both."""
        return self.to(f"compare/{one}/{other}/{page}")


@dataclass(frozen=True, slots=True)
class Late:
    """A value of a page that is made of the page's links."""

    make: Callable[[Links], Any]

    def __call__(self, links: Links) -> Any:
        """Make it."""
        return self.make(links)


def hour_page(day: int, hour: int) -> str:
    """The page of an hour, within the pages of its run."""
    return f"day-{day:02d}/hour-{hour:02d}.html"


def evening_page(day: int) -> str:
    """The page of an evening, within the pages of its run."""
    return f"day-{day:02d}/evening.html"
