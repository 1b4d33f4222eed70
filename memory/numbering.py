"""How the records of a log are named in the store, so that nothing ever needs to be deleted there.

Chroma's index may break over deletions: in a trial a thousand records were added and deleted a few times, and vectors
became unreadable or the process crashed. So dropping the end of a log only notes the position of the cut. Later records
at the same positions have the number of the cut in their id. The dropped rows stay in the store; no id names them any
more. They are called ghosts.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Mapping
from typing import Any, NamedTuple

_DIGITS = 12
_CUTS = "cuts"
_GHOSTS = "ghosts"


class Numbering(NamedTuple):
    """The cuts made so far.

    Attributes:
        starts: Positions of the cuts that still matter, ascending.
        cuts: Their numbers, ascending: from starts[i] on, records were written after cut number cuts[i].
        ghosts: How many rows of the store are dropped records.
    """

    starts: tuple[int, ...] = ()
    cuts: tuple[int, ...] = ()
    ghosts: int = 0

    def id(self, position: int) -> str:
        """Return the id of the record at a position."""
        place = bisect_right(self.starts, position)
        return f"{position:0{_DIGITS}d}" + (f".{self.cuts[place - 1]}" if place else "")

    def cut(self, start: int, length: int) -> Numbering:
        """Return the numbering after dropping the records from `start` on, of `length` there are."""
        kept = sum(earlier < start for earlier in self.starts)
        number = self.cuts[-1] + 1 if self.cuts else 1
        return Numbering((*self.starts[:kept], start), (*self.cuts[:kept], number), self.ghosts + length - start)

    def metadata(self) -> dict[str, str | int]:
        """Return what to keep of it in the collection's metadata."""
        return {_CUTS: json.dumps([*zip(self.starts, self.cuts, strict=True)]), _GHOSTS: self.ghosts}

    @classmethod
    def of(cls, metadata: Mapping[str, Any]) -> Numbering:
        """Return the numbering that a collection's metadata tell of.

        Raises:
            ValueError: If they make no sense.
        """
        pairs = json.loads(metadata.get(_CUTS, "[]"))
        starts, cuts = tuple(int(start) for start, _ in pairs), tuple(int(cut) for _, cut in pairs)
        return cls(starts, cuts, int(metadata.get(_GHOSTS, 0)))


def position_of(key: str) -> int:
    """Return the position that an id stands for."""
    return int(key[:_DIGITS])
