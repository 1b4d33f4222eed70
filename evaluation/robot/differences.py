"""Where the measures of success differ about the same offers: predicate, judge, the person, and similarity."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import NamedTuple

from coopera.core.hour import HourRecord
from coopera.core.success import Counts
from coopera.evaluation.measuring import all_measures


class Offer(NamedTuple):
    """A candidate of the robot, and what each measure says of it.

    Attributes:
        wanted: The person's tasks after the first, in words.
        said: Whether it helps, by measure; None where that is not known. Measures that say nothing are left out.
    """

    day: int
    hour: int
    offer: str
    thought: str
    accepted: bool
    intention: str
    wanted: list[str]
    said: dict[str, bool | None]


class Pair(NamedTuple):
    """A two by two of two measures, over the offers of which both say something."""

    one: str
    other: str
    both: int
    only_one: int
    only_other: int
    neither: int

    @property
    def offers(self) -> int:
        """Of how many offers both say something."""
        return self.both + self.only_one + self.only_other + self.neither

    @property
    def agreeing(self) -> float | None:
        """The share on which they agree; None where there is none."""
        return (self.both + self.neither) / self.offers if self.offers else None

    @property
    def kappa(self) -> float | None:
        """Cohen's kappa: agreement beyond chance; None where one of the two always says the same."""
        if not self.offers or self.agreeing is None:
            return None
        yes = (self.both + self.only_one) / self.offers, (self.both + self.only_other) / self.offers
        chance = yes[0] * yes[1] + (1 - yes[0]) * (1 - yes[1])
        return (self.agreeing - chance) / (1 - chance) if 0 < yes[0] < 1 and 0 < yes[1] < 1 else None


class Pattern(NamedTuple):
    """Offers of which the measures say the same, yes by some and no by others."""

    said: dict[str, bool | None]
    offers: list[Offer]


def offers_of(hours: Iterable[HourRecord]) -> list[Offer]:
    """Every offer of some hours (`told_in_the_evening`, for the person's own word) with what was said of it.

    Hours that failed or had no robot have none. Traces of before verdicts were kept have the predicate's alone.
    """
    specs = [spec for spec in all_measures() if issubclass(spec.figures, Counts)]
    found = []
    for hour in hours:
        if not (hour.human and hour.robot and hour.success):
            continue
        tasks, wanted = hour.robot.tasks, [task.act.describe() for task in hour.human.tasks[1:]]
        verdicts = {"predicate": [task.correct for task in tasks]}
        for spec in specs:
            if (one := spec.read(hour.success)) and len(one.verdicts) == len(tasks):
                verdicts[spec.name] = one.verdicts
        for place, task in enumerate(tasks):
            said = {spec.name: verdicts[spec.name][place] for spec in specs if spec.name in verdicts}
            offer, about = task.act.describe(), hour.human.intention.text
            found.append(Offer(hour.day, hour.hour, offer, task.thought, bool(task.accepted), about, wanted, said))
    return found


def pairs_of(offers: Sequence[Offer]) -> list[Pair]:
    """The two by twos of all measures that say something."""
    names = list(dict.fromkeys(name for offer in offers for name in offer.said))
    found = []
    for one, other in combinations(names, 2):
        said = [(offer.said.get(one), offer.said.get(other)) for offer in offers]
        counts = [said.count(cell) for cell in ((True, True), (True, False), (False, True), (False, False))]
        found.append(Pair(one, other, *counts))
    return found


def patterns_of(offers: Iterable[Offer]) -> list[Pattern]:
    """The offers about which measures differ, by who says what, the most frequent first."""
    groups: dict[tuple[tuple[str, bool | None], ...], list[Offer]] = defaultdict(list)
    for offer in offers:
        if {True, False} <= set(offer.said.values()):
            groups[tuple(offer.said.items())].append(offer)
    ranked = sorted(groups.items(), key=lambda item: -len(item[1]))
    return [Pattern(dict(said), found) for said, found in ranked]
