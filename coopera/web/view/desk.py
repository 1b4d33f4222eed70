"""What every page of the viewer is made from: the shelf, the lines of hours, and runs that are opened."""

from __future__ import annotations

from dataclasses import dataclass, field

from coopera.core.errors import CooperaError
from coopera.rundir.directory import RunDir
from coopera.web.view.lines import Line, Lines
from coopera.web.view.reading import plainly
from coopera.web.view.shelf import Shelf, Shelved


@dataclass(frozen=True, slots=True)
class Desk:
    """The runs of one folder, at hand.

    Attributes:
        shelf: What lies in the folder.
        files: Whether the pages are written as files, so that nothing can be asked of a server.
        lines: What is known of hours.
    """

    shelf: Shelf
    files: bool = False
    lines: Lines = field(default_factory=Lines)

    def lines_of(self, entry: Shelved) -> list[Line]:
        """The hours of a run, a line each."""
        return self.lines.of_run(entry.root)

    def opened(self, entry: Shelved) -> tuple[RunDir | None, str]:
        """A run, open for reading, or the sentence that says why it cannot be."""
        try:
            return RunDir.open(entry.root), ""
        except CooperaError as err:
            return None, plainly(err, entry.root)
