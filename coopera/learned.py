"""What the robot has learned, from the trace alone: how far its probabilities can be trusted, and what it mixes up."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from coopera.trace_files import intention_verdicts
from core.hour import Evening, HourRecord

BINS = 5


@dataclass(frozen=True, slots=True)
class Bin:
    """Verdicts whose probability lies in [low, low + 1/5): how many, their mean probability, and the share of right."""

    low: float
    count: int
    said: float | None
    right: float | None


@dataclass(frozen=True, slots=True)
class Activity:
    """One thing that the person did: in how many hours, imagined in how many, accepted in how many, and mixed up with.

    `mistaken` is the wrong intention that was accepted most often in those hours, with its count.
    """

    text: str
    hours: int
    imagined: int
    accepted: int
    mistaken: tuple[str, int] | None


def calibration(verdicts: Iterable[tuple[float, bool]]) -> list[Bin]:
    """Compare what was said (P(yes) of each verdict) with what was right, in five bins of equal width."""
    bins: list[list[tuple[float, bool]]] = [[] for _ in range(BINS)]
    for probability, right in verdicts:
        bins[min(int(probability * BINS), BINS - 1)].append((probability, right))
    return [
        Bin(
            number / BINS,
            len(found),
            sum(p for p, _ in found) / len(found) if found else None,
            sum(right for _, right in found) / len(found) if found else None,
        )
        for number, found in enumerate(bins)
    ]


def intention_pairs(hours: Sequence[HourRecord], evenings: Mapping[int, Evening]) -> list[tuple[float, bool]]:
    """P(yes) of each imagined intention, and what the person said in the evening."""
    pairs = []
    for hour in hours:
        said = intention_verdicts(evenings.get(hour.day), hour.hour)
        for candidate in hour.robot.intentions if hour.robot else []:
            right = said.get(candidate.text)
            if candidate.probability is not None and right is not None:
                pairs.append((candidate.probability, right))
    return pairs


def task_pairs(hours: Sequence[HourRecord]) -> list[tuple[float, bool]]:
    """P(yes) of each imagined task, and whether it helped, by the predicate."""
    tasks = [task for hour in hours if hour.robot for task in hour.robot.tasks]
    return [(t.probability, t.correct) for t in tasks if t.probability is not None and t.correct is not None]


def activities(hours: Sequence[HourRecord], evenings: Mapping[int, Evening], most: int = 12) -> list[Activity]:
    """What the person did most often, and how the robot read it; commonest first."""
    met: Counter[str] = Counter()
    imagined: Counter[str] = Counter()
    accepted: Counter[str] = Counter()
    mistaken: dict[str, Counter[str]] = {}
    for hour in hours:
        if hour.human is None or hour.robot is None:
            continue
        said = intention_verdicts(evenings.get(hour.day), hour.hour)
        text = hour.human.intention.text
        met[text] += 1
        right = [c for c in hour.robot.intentions if said.get(c.text)]
        imagined[text] += bool(right)
        accepted[text] += any(c.accepted for c in right)
        wrong = [c.text for c in hour.robot.intentions if c.accepted and said.get(c.text) is False]
        mistaken.setdefault(text, Counter()).update(wrong)
    return [
        Activity(text, count, imagined[text], accepted[text], next(iter(mistaken[text].most_common(1)), None))
        for text, count in sorted(met.items(), key=lambda one: (-one[1], one[0]))[:most]
    ]
