"""What the robot has learned, from the trace alone: how far its probabilities can be trusted, and what it mixes up."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from coopera.core.clock import hour_label
from coopera.core.hour import Evening, HourRecord
from coopera.rundir.trace_files import intention_verdicts

BINS = 5


@dataclass(frozen=True, slots=True)
class Bin:
    """Verdicts whose probability lies in [low, low + 1/5): how many, their mean probability, and the share of right."""

    low: float
    count: int
    said: float | None
    right: float | None


@dataclass(frozen=True, slots=True)
class Read:
    """How the robot read some hours: those of an activity, or those of a time of day.

    Attributes:
        of: The activity as the person put it, or the hour of the day.
        hours: How many there were.
        imagined: In how many of them the right intention was imagined.
        accepted: In how many it was accepted.
        mistaken: The wrong intention that was accepted most often in them, with its count.
    """

    of: str
    hours: int
    imagined: int
    accepted: int
    mistaken: tuple[str, int] | None


def calibration(verdicts: Iterable[tuple[float, bool]]) -> list[Bin]:
    """Compare what was said (P(yes) of each verdict) with what was right, in five bins of equal width."""
    bins: list[list[tuple[float, bool]]] = [[] for _ in range(BINS)]
    for probability, right in verdicts:
        bins[min(int(min(max(probability, 0), 1) * BINS), BINS - 1)].append((probability, right))
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


def by_activity(hours: Sequence[HourRecord], evenings: Mapping[int, Evening], most: int = 12) -> list[Read]:
    """How the robot read what the person did most often; commonest first."""
    read = _read(hours, evenings, lambda _, intention: intention)
    return [one for _, one in sorted(read.items(), key=lambda item: (-item[1].hours, item[0]))[:most]]


def by_hour(hours: Sequence[HourRecord], evenings: Mapping[int, Evening]) -> list[Read]:
    """How the robot read each hour of the day, all days together; in order of time."""
    read = _read(hours, evenings, lambda hour, _: f"{hour:02d}")
    return [replace(read[key], of=hour_label(int(key))) for key in sorted(read)]


def _read(
    hours: Sequence[HourRecord], evenings: Mapping[int, Evening], key: Callable[[int, str], str]
) -> dict[str, Read]:
    met: Counter[str] = Counter()
    imagined: Counter[str] = Counter()
    accepted: Counter[str] = Counter()
    mistaken: dict[str, Counter[str]] = {}
    for hour in hours:
        if hour.human is None or hour.robot is None:
            continue
        said = intention_verdicts(evenings.get(hour.day), hour.hour)
        of = key(hour.hour, hour.human.intention.text)
        met[of] += 1
        right = [c for c in hour.robot.intentions if said.get(c.text)]
        imagined[of] += bool(right)
        accepted[of] += any(c.accepted for c in right)
        wrong = [c.text for c in hour.robot.intentions if c.accepted and said.get(c.text) is False]
        mistaken.setdefault(of, Counter()).update(wrong)
    return {
        of: Read(of, count, imagined[of], accepted[of], next(iter(mistaken[of].most_common(1)), None))
        for of, count in met.items()
    }
