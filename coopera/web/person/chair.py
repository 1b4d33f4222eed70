"""The one chair: at a time one page, on one device, answers for the person; another may take over, on purpose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

Seat: TypeAlias = Literal["yours", "free", "taken"]
GONE = 20.0
"""Seconds after which a page that no longer asks is taken to be closed."""


@dataclass(slots=True)
class Chair:
    """Who sits, by the name that a page gives itself; `clock` counts seconds."""

    clock: Callable[[], float]
    holder: str = ""
    seen: float = 0.0

    def seat(self, page: str) -> Seat:
        """How it stands with a page that asks; one that sits is noted to be there."""
        if page and page == self.holder:
            self.seen = self.clock()
            return "yours"
        if not self.holder or self.away > GONE:
            return "free"
        return "taken"

    @property
    def away(self) -> float:
        """Seconds since the page that sits has last asked."""
        return self.clock() - self.seen

    def sit(self, page: str, *, take: bool = False) -> bool:
        """Have a page sit, if the chair is free or it takes it; say whether it sits now."""
        if not page or (self.seat(page) == "taken" and not take):
            return False
        self.holder, self.seen = page, self.clock()
        return True

    def leave(self, page: str) -> None:
        """Have a page get up, if it sits."""
        if page == self.holder:
            self.holder = ""
