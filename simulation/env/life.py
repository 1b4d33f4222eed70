"""What the person of an environment does: a list of acts for each hour, from whoever decides them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

from coopera.core.household import Act
from coopera.simulation.world import World


class Hour(NamedTuple):
    """An hour of a life: days from 0 (a Monday), hours of the day."""

    day: int
    hour: int


class Life(Protocol):
    """Who decides for the person."""

    @property
    def hours(self) -> Sequence[Hour]:
        """The hours of one episode, in order; at least one."""
        ...

    def begin(self, world: World, seed: int) -> None:
        """Start an episode in a home as it was built; nothing of an earlier one is left but what it may learn from."""
        ...

    def tasks(self, hour: Hour) -> Sequence[Act]:
        """What the person is going to do in an hour, in order; empty while they are away. Asked once, at its start."""
        ...


class Planned:
    """A life that stands written: the same in every episode, whatever the seed."""

    def __init__(self, acts: Mapping[Hour, Sequence[Act]]) -> None:
        """Take the acts of each hour.

        Raises:
            ValueError: If there is no hour.
        """
        if not acts:
            raise ValueError("a planned life needs at least one hour")
        self._acts = {Hour(*hour): list(acts[hour]) for hour in sorted(acts)}

    @property
    def hours(self) -> list[Hour]:
        """The hours that were given, in order."""
        return list(self._acts)

    def begin(self, world: World, seed: int) -> None:
        """Nothing has to be prepared."""

    def tasks(self, hour: Hour) -> list[Act]:
        """The acts of that hour."""
        return self._acts[hour]
