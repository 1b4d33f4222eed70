"""What people did, as the checks on them take it: days of intentions and tasks, and how days are held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from coopera.core.household import SceneId
from coopera.core.people import BigFive, Frozen, Persona, PersonId


class LivedDay(Frozen):
    """One day that a person lived in a home: per hour (of day, in order) the intention and the tasks, in words.

    `seed` and `number` (of the day in the person's own calendar) tell which random draws made it.
    """

    person: PersonId
    scene: SceneId
    seed: int
    number: int
    hours: list[int]
    intentions: list[str]
    tasks: list[list[str]]

    @property
    def all_tasks(self) -> list[str]:
        """The day's tasks, in order."""
        return [task for tasks in self.tasks for task in tasks]


class InferredTraits(NamedTuple):
    """The Big Five that a robot believed of a person at the end of their time together."""

    person: PersonId
    big_five: BigFive


@dataclass(frozen=True, slots=True)
class Lives:
    """Days of several people, who they truly are, and what robots came to believe of them."""

    days: list[LivedDay]
    personas: dict[PersonId, Persona]
    beliefs: list[InferredTraits] = field(default_factory=list)

    @property
    def people(self) -> list[PersonId]:
        """Those who lived a day, sorted by id."""
        return sorted({day.person for day in self.days})

    @property
    def scenes(self) -> list[SceneId]:
        """The homes lived in, sorted."""
        return sorted({day.scene for day in self.days})

    def of(self, person: PersonId) -> list[LivedDay]:
        """One person's days."""
        return [day for day in self.days if day.person == person]


class Fold(NamedTuple):
    """Indices of the days that are tested and of those that may be learned from."""

    test: list[int]
    train: list[int]


class HeldOut(NamedTuple):
    """How days are held out: `unseen` is "home" or, where all lived in one home, "day"."""

    unseen: str
    folds: list[Fold]


def hold_out(days: Sequence[LivedDay]) -> HeldOut:
    """Hold out each home in turn (PAPER §4.2: tested on an unseen scene); with one home, each number of day.

    Days of one seed and number share their random draws, so that a person's day in another home may be nearly the
    same day. Such twins of a tested day are never learned from. Folds without a day on either side are left out.
    """
    scenes = sorted({day.scene for day in days})
    if len(scenes) < 2:
        numbers = sorted({day.number for day in days})
        by_number = [Fold(*_split([day.number == number for day in days])) for number in numbers]
        return HeldOut("day", [fold for fold in by_number if fold.test and fold.train])
    folds = []
    for scene in scenes:
        here = [at for at, day in enumerate(days) if day.scene == scene]
        elsewhere = [at for at, day in enumerate(days) if day.scene != scene]
        draws = {_draws(days[at]) for at in here}
        if draws.isdisjoint(_draws(days[at]) for at in elsewhere):
            folds.append(Fold(here, elsewhere))
            continue
        for drawn in sorted(draws):
            test = [at for at in here if _draws(days[at]) == drawn]
            folds.append(Fold(test, [at for at in elsewhere if _draws(days[at]) != drawn]))
    return HeldOut("home", [fold for fold in folds if fold.test and fold.train])


def _draws(day: LivedDay) -> tuple[int, int]:
    return day.seed, day.number


def _split(chosen: Sequence[bool]) -> tuple[list[int], list[int]]:
    return [at for at, yes in enumerate(chosen) if yes], [at for at, yes in enumerate(chosen) if not yes]
