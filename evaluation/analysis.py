"""From rows of hours to the figures of tables and plots."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from coopera.evaluation.agreement import l1
from coopera.evaluation.comparing import Comparison, Noise, Of, Unit, clustered_mean, compare, noise
from coopera.evaluation.counts import pool
from coopera.evaluation.grid import AGAIN, OF, SHARED
from coopera.evaluation.measuring import find_measure
from coopera.evaluation.results import Card, Row
from coopera.evaluation.statistics import Mean


@dataclass(frozen=True, slots=True)
class Endpoint:
    """The primary endpoint: which of a person's days of an episode count, by which measure, and what is tested.

    A person's days are counted from 0 here (`Row.round`), and from 1 in the grid and in words.

    Attributes:
        late: How many of the last days; None is the last third, rounded up.
        early: First and last of the early days, from 1; late days are never early.
        standing: When it was stated and whether it was kept, in words.
        measure: Its headline counts.
        reference: The method that others are compared with.
        against: Those of one family, which the correction is for; None is all.
        test: One of `coopera.evaluation.comparing.TESTS`.
        correction: One of `coopera.evaluation.comparing.CORRECTIONS`.
    """

    late: int | None = None
    early: tuple[int, int] = (2, 5)
    standing: str = "Not stated in a file"
    measure: str = "help"
    reference: str = "ours"
    against: tuple[str, ...] | None = None
    test: str = "sign_flip"
    correction: str = "holm"

    @classmethod
    def of(cls, grid: Mapping[str, Any], standing: str | None = None) -> Endpoint:
        """As a card's grid says; grids of before there was an endpoint have the default, and that is said.

        Args:
            grid: As a card has it.
            standing: When it was stated and whether it was kept; cards of before this was noted do not say.
        """
        first, last = grid.get("early_days") or cls().early
        said = dict(grid.get("endpoint") or {})
        against = said.pop("against", None)
        before = "Stated in the grid, without a date" if "late_days" in grid else "Not stated by this grid"
        return cls(
            grid.get("late_days"),
            (first, last),
            standing or before,
            **said,
            against=tuple(against) if against else None,
        )

    @property
    def title(self) -> str:
        """The endpoint's measure as tables name it."""
        return find_measure(self.measure).title

    def late_days(self, days: int) -> range:
        """The late days of a person who lived so many."""
        return range(max(0, days - (self.late or -(-days // 3))), days)

    def early_days(self, days: int) -> range:
        """The early days; none where all but the first are late."""
        return range(min(self.early[0] - 1, days), min(self.early[1], self.late_days(days).start))

    def __str__(self) -> str:
        """In words."""
        last = {None: "last third of the days", 1: "last day"}.get(self.late, f"last {self.late} days")
        days = f"late days: each person's {last} of an episode; early days: {self.early[0]} to {self.early[1]}"
        return f"{self.standing}; {days}"


STATED = Endpoint()


def endpoint_of(card: Card) -> Endpoint:
    """The primary endpoint of a results folder."""
    return Endpoint.of(card.grid, card.endpoint.words if card.endpoint else None)


class Cell(NamedTuple):
    """A figure with its interval and of how many episodes' people it is."""

    interval: Mean
    n: int


def score(rows: Iterable[Row], measure: str, figure: str | None = None) -> float | None:
    """A figure of some hours by a measure, by default its headline."""
    hours = [row for row in rows if row.status == "ok"]
    spec = find_measure(measure)
    return spec.pool([figures for row in hours if (figures := row.of(spec)) is not None])[figure or spec.headline]


def units(rows: Iterable[Row], measure: str) -> dict[str, dict[Of, Unit]]:
    """The last day of each person in each episode as a unit, by method; days without a figure are left out."""
    return _units(rows, measure, lambda days: range(days - 1, days))


def late_units(rows: Iterable[Row], measure: str, endpoint: Endpoint = STATED) -> dict[str, dict[Of, Unit]]:
    """The mean of each person's late days in each episode as a unit, by method: the primary endpoint."""
    return _units(rows, measure, endpoint.late_days)


def variants(rows: Iterable[Row], word: str) -> list[Row]:
    """The rows of a variant such as `shared`, under the names of the methods themselves."""
    ending = f"{OF}{word}"
    mine = [row for row in rows if row.method.endswith(ending)]
    return [row.model_copy(update={"method": row.method.removesuffix(ending)}) for row in mine]


def plain(rows: Iterable[Row]) -> list[Row]:
    """The rows of methods as they are, without variants."""
    return [row for row in rows if OF not in row.method]


def control(rows: Sequence[Row], endpoint: Endpoint = STATED) -> dict[str, tuple[Cell, Cell, Comparison]]:
    """By method that ran with shared common sense, too: with its own, with the shared, and what it gains by it."""
    own = late_units(plain(rows), endpoint.measure, endpoint)
    shared = late_units(variants(rows, SHARED), endpoint.measure, endpoint)
    found = {}
    for method, each in shared.items():
        if compared := compare(own.get(method, {}), {method: each}, test=endpoint.test, correction="none"):
            found[method] = (_cells(own)[method], _cells(shared)[method], compared[0])
    return found


def noise_floors(rows: Sequence[Row], endpoint: Endpoint = STATED) -> dict[str, Noise]:
    """By method the noise floor of the endpoint between seeds, where there are several."""
    found = late_units(plain(rows), endpoint.measure, endpoint)
    return {method: floor for method, each in found.items() if (floor := noise(each))}


def sampling_floors(rows: Sequence[Row], endpoint: Endpoint = STATED) -> dict[str, Noise]:
    """By method that met the same days several times: the endpoint's noise floor between single samples of models."""
    words: dict[str, set[str]] = defaultdict(set)
    for method, _, word in (row.method.partition(OF) for row in rows):
        if word.startswith(AGAIN):
            words[method].add(word)
    found = {}
    once = late_units(plain(rows), endpoint.measure, endpoint)
    for method, again in words.items():
        samples: dict[Of, Unit] = {}
        repeated = [late_units(variants(rows, word), endpoint.measure, endpoint) for word in sorted(again)]
        for number, each in enumerate([once, *repeated]):
            for (setting, collab, *episode), unit in each.get(method, {}).items():
                samples[setting, collab, number, *episode] = unit  # a sample where a seed stands
        if floor := noise(samples, once.get(method)):
            found[method] = floor
    return found


def growth(rows: Sequence[Row], measure: str, endpoint: Endpoint = STATED) -> dict[str, Cell]:
    """Each method's growth from the early to the late days, over the people who have both."""
    early, late = _units(rows, measure, endpoint.early_days), late_units(rows, measure, endpoint)
    found = {}
    for method, after in late.items():
        before = early.get(method, {})
        grown = [one._replace(value=one.value - before[key].value) for key, one in after.items() if key in before]
        if grown:
            found[method] = Cell(clustered_mean(grown), len(grown))
    return found


def late_day_values(rows: Iterable[Row], endpoint: Endpoint) -> dict[str, dict[Of, dict[int, float]]]:
    """The endpoint's measure on each late day, by method and unit; days without a figure are left out."""
    found = _days(rows, endpoint.measure, endpoint.late_days)
    return {method: {key: days for key, (_, days) in each.items()} for method, each in found.items()}


def _units(rows: Iterable[Row], measure: str, chosen: Callable[[int], range]) -> dict[str, dict[Of, Unit]]:
    """The mean over some of each person's days, a day pooling its hours; `chosen` has them from how many there were."""
    return {
        method: {
            key: Unit(one.person, one.scene, one.seed, float(np.mean(list(days.values()))))
            for key, (one, days) in each.items()
        }
        for method, each in _days(rows, measure, chosen).items()
    }


def _days(
    rows: Iterable[Row], measure: str, chosen: Callable[[int], range]
) -> dict[str, dict[Of, tuple[Row, dict[int, float]]]]:
    """Some of each person's days with their figure, and a row to tell whose they are."""
    key: Of
    lives: dict[tuple[str, Of], dict[int, list[Row]]] = defaultdict(lambda: defaultdict(list))
    for row in rows:
        key = (row.setting, row.collab, row.seed, row.episode, row.person)
        lives[row.method, key][row.round].append(row)
    found: dict[str, dict[Of, tuple[Row, dict[int, float]]]] = defaultdict(dict)
    for (method, key), days in sorted(lives.items(), key=lambda item: str(item[0])):
        values = {day: score(days[day], measure) for day in chosen(max(days) + 1) if day in days}
        if given := {day: value for day, value in values.items() if value is not None}:
            found[method][key] = (next(iter(days.values()))[0], given)
    return dict(found)


def last_day(rows: Sequence[Row], measure: str = "predicate") -> dict[str, Cell]:
    """Each method's mean over people's last days, the paper's endpoint."""
    return _cells(units(rows, measure))


def late_days(rows: Sequence[Row], measure: str = "help", endpoint: Endpoint = STATED) -> dict[str, Cell]:
    """Each method's mean over people's late days, the primary endpoint."""
    return _cells(late_units(rows, measure, endpoint))


def _cells(found: dict[str, dict[Of, Unit]]) -> dict[str, Cell]:
    return {method: Cell(clustered_mean(list(every.values())), len(every)) for method, every in found.items()}


def comparisons(
    rows: Sequence[Row], reference: str, measure: str = "predicate", late: Endpoint | None = None
) -> list[Comparison]:
    """Each method against the reference on the same days: the last ones, or the late ones of an endpoint.

    With an endpoint its test and its correction hold, the latter for the methods that it names; the others follow and
    have no corrected p. Variants are none of the methods. Where there is a single seed, and the reference's models were
    sampled again and did answer otherwise, the noise floor is that of two such samples.
    """
    sampled = sampling_floors(rows, late).get(reference) if late else None
    rows = plain(rows)
    if late is None:
        found = units(rows, measure)
        return compare(found.pop(reference, {}), found)
    found = late_units(rows, measure, late)
    base = found.pop(reference, {})
    named = found if late.against is None else {name: found[name] for name in late.against if name in found}
    others = {name: each for name, each in found.items() if name not in named}
    explored = compare(base, others, test=late.test, correction="none")
    compared = [
        *compare(base, named, test=late.test, correction=late.correction),
        *(one._replace(p_corrected=None) for one in explored),
    ]
    two = sampled._replace(floor=2**0.5 * sampled.floor) if sampled and sampled.sd else None
    return [one._replace(noise=one.noise or two) for one in compared]


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
