"""From rows of hours to the figures of tables and plots."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import NamedTuple

from coopera.evaluation.agreement import l1
from coopera.evaluation.comparing import Comparison, Unit, clustered_mean, compare
from coopera.evaluation.counts import pool
from coopera.evaluation.measuring import find_measure
from coopera.evaluation.results import Row
from coopera.evaluation.statistics import Interval

PEOPLE = "people"
"""The measure that is no measure of an hour, but what the person said of it."""


class Cell(NamedTuple):
    """A figure with its interval and of how many people's days it is."""

    interval: Interval
    n: int


def score(rows: Iterable[Row], measure: str) -> float | None:
    """The one figure of some hours by a measure; by "people", the F1 of what the person said in the evening."""
    hours = [row for row in rows if row.status == "ok"]
    if measure == PEOPLE:
        return pool(counts for row in hours if (counts := row.counts(measure))).f1
    spec = find_measure(measure)
    return spec.pool([figures for row in hours if (figures := row.of(spec)) is not None])[spec.headline]


def units(rows: Iterable[Row], measure: str) -> dict[str, dict[tuple[Hashable, ...], Unit]]:
    """The last day of each person in each episode as a unit, by method; days without a figure are left out."""
    days: dict[tuple[str, tuple[Hashable, ...]], list[Row]] = defaultdict(list)
    for row in rows:
        if row.last:
            days[row.method, (row.setting, row.collab, row.seed, row.episode, row.person)].append(row)
    found: dict[str, dict[tuple[Hashable, ...], Unit]] = defaultdict(dict)
    for (method, key), hours in sorted(days.items(), key=lambda item: str(item[0])):
        value = score(hours, measure)
        if value is not None:
            found[method][key] = Unit(hours[0].person, hours[0].scene, hours[0].seed, value)
    return dict(found)


def last_day(rows: Sequence[Row], measure: str = "predicate") -> dict[str, Cell]:
    """Each method's mean over people's last days."""
    return {
        method: Cell(clustered_mean(list(found.values())), len(found)) for method, found in units(rows, measure).items()
    }


def comparisons(rows: Sequence[Row], reference: str, measure: str = "predicate") -> list[Comparison]:
    """Each method against the reference on the same last days."""
    found = units(rows, measure)
    return compare(found.pop(reference, {}), found)


def curve(
    rows: Sequence[Row], at: Callable[[Row], int | str], measure: str = "predicate"
) -> dict[str, dict[int | str, float]]:
    """A measure by method and by some position (hour, day, activity), hours pooled."""
    groups: dict[tuple[str, int | str], list[Row]] = defaultdict(list)
    for row in rows:
        groups[row.method, at(row)].append(row)
    found: dict[str, dict[int | str, float]] = defaultdict(dict)
    for (method, place), hours in sorted(groups.items(), key=lambda item: (item[0][0], str(item[0][1]).zfill(4))):
        value = score(hours, measure)
        if value is not None:
            found[method][place] = value
    return dict(found)


def agreement(rows: Sequence[Row], measure: str) -> float | None:
    """L1 between a measure and the person's own answers, hour by hour."""
    pairs = [(row.counts(measure), row.counts("people")) for row in rows]
    scored = [(one, other) for one, other in pairs if one and other]
    return l1([pool([one]).f1 for one, _ in scored], [pool([other]).f1 for _, other in scored])


def generalisation(rows: Sequence[Row], setting: str, method: str, fresh: str) -> tuple[Cell, Cell] | None:
    """A method's last day of each episode (an unseen home in setting 2, a stranger in 3+1), beside a fresh robot's."""
    final: dict[tuple[Hashable, ...], int] = {}
    for row in rows:
        episode = (row.setting, row.collab, row.seed, row.episode)
        final[episode] = max(final.get(episode, 0), row.day)
    chosen = [
        row
        for row in rows
        if row.setting == setting and row.day == final[row.setting, row.collab, row.seed, row.episode]
    ]
    found = last_day(chosen)
    return (found[fresh], found[method]) if fresh in found and method in found else None


def effort(rows: Sequence[Row]) -> dict[str, tuple[float, float, float]]:
    """By method and per scored hour: the person's tasks helped, metres saved, and useless acts."""
    found: dict[str, tuple[float, float, float]] = {}
    for method in sorted({row.method for row in rows}):
        hours = [row for row in rows if row.method == method and row.remaining is not None]
        if hours:
            totals = [sum(getattr(row, name) or 0 for row in hours) for name in ("helped", "saved_metres", "useless")]
            found[method] = (totals[0] / len(hours), totals[1] / len(hours), totals[2] / len(hours))
    return found
