"""What is said of an import: what was understood of the files, what was guessed, and what was left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias

Kind: TypeAlias = Literal["understood", "guessed", "left out"]
KINDS: tuple[Kind, ...] = ("understood", "guessed", "left out")


class Said(NamedTuple):
    """One line: what it is about, as the files call it, and what is said of it."""

    kind: Kind
    what: str
    why: str


class Report:
    """The report of one import, in the order in which things were found."""

    def __init__(self) -> None:
        self.said: list[Said] = []

    def understood(self, what: str, why: str) -> None:
        """Note what the files say plainly."""
        self.said.append(Said("understood", what, why))

    def guessed(self, what: str, why: str) -> None:
        """Note what the files do not say, and what is taken for it."""
        self.said.append(Said("guessed", what, why))

    def left_out(self, what: str, why: str) -> None:
        """Note what is not in the home, and why."""
        self.said.append(Said("left out", what, why))


def lines_of(report: Sequence[Said], kind: Kind) -> list[str]:
    """The lines of one kind, as they are shown."""
    return [f"{line.kind}: {line.what}: {line.why}" for line in report if line.kind == kind]
