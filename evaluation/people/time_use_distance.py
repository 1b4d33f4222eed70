"""Do simulated people spend their hours as people do? Their distance to a table of time use, by hour and category."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple, TypeAlias

import numpy as np
from scipy import stats

from coopera.core.randomness import rng_at
from coopera.core.time_use import CATEGORIES, DAY_TYPES, DayType
from coopera.evaluation.people.divergence import earth_mover, jensen_shannon
from coopera.evaluation.people.figures import IN_DETAIL, Figure, unmeasured
from coopera.evaluation.people.hours_spent import SpentDay
from coopera.evaluation.people.learners import Floats
from coopera.evaluation.people.rhythm import ENOUGH
from coopera.evaluation.people.time_use import TimeUse

CHECK = "time use"
(BY_CATEGORY,) = IN_DETAIL
RESAMPLES = 2000
NULLS = 1000
_TV, _TV_HOUR = CATEGORIES.index("tv"), 20
_EVERY_HOUR = list(range(24))

Statistic: TypeAlias = Callable[[Floats], Floats]
"""Shares by hour and category, shape (..., hours, 9), to numbers of shape (...)."""


class Tally(NamedTuple):
    """Sums of shares over some days, by unit (person): `totals` (units, hours, 9), `counts` of days (units, hours)."""

    units: list[Hashable]
    hours: list[int]
    totals: Floats
    counts: Floats
    days: int

    def shares(self, weights: Floats) -> Floats:
        """Shares over the units, each taken `weights` times; (..., units) to (..., hours, 9), nan where no day is."""
        with np.errstate(invalid="ignore"):
            return np.asarray(
                np.tensordot(weights, self.totals, axes=1) / np.tensordot(weights, self.counts, axes=1)[..., None]
            )

    @property
    def pooled(self) -> Floats:
        """Shares over all days, shape (hours, 9)."""
        return self.shares(np.ones(len(self.totals)))


class HourRow(NamedTuple):
    """One line of the detailed table: shares in percent, and the distance of its hour (the same in nine lines)."""

    variant: str
    stratum: str
    day_type: DayType
    hour: int
    category: str
    simulated_pct: float
    table_pct: float
    difference_points: float
    hour_distance: float
    person_days: int


class Question(NamedTuple):
    """One number to be measured of the simulated shares of one day type, and how to say it."""

    check: str
    measure: str
    note: str
    statistic: Statistic
    least: float
    most: float
    null: bool = False
    """Whether a sample of the table shows something, too."""


def tally(days: Sequence[SpentDay], unit: Callable[[SpentDay], Hashable], hours: Sequence[int] | None = None) -> Tally:
    """Sum the days up by unit (such as the person), over the hours that somebody lived or the ones given."""
    lived = {id(day): ~np.isnan(day.shares[:, 0]) for day in days}
    chosen = [hour for hour in _EVERY_HOUR if any(one[hour] for one in lived.values())] if hours is None else [*hours]
    units = sorted({unit(day) for day in days}, key=repr)
    place = {name: at for at, name in enumerate(units)}
    totals, counts = np.zeros((len(units), len(chosen), len(CATEGORIES))), np.zeros((len(units), len(chosen)))
    for day in days:
        totals[place[unit(day)]] += np.nan_to_num(day.shares[chosen])
        counts[place[unit(day)]] += lived[id(day)][chosen]
    return Tally(units, chosen, totals, counts, len(days))


def time_use_figures(days: Sequence[SpentDay], table: TimeUse, *, seed: int = 0) -> list[Figure]:
    """All figures of how far some days are from a table of time use.

    For each stratum and day type, over the hours that were lived: the Jensen-Shannon divergence of simulated and real
    shares (mean over the hours, and the worst hour), television at 8 pm, and for each category how many hours a day it
    has more than in the table, and by how many hours of the clock it is shifted (earth mover's distance). The control
    is what as many person-days would show that were drawn hour by hour from the table itself. Then, how far weekday
    and weekend are from each other. Intervals resample people (`half_width`); with fewer than three there are
    none.

    Args:
        days: What the simulated days were spent on.
        table: What to compare them with.
        seed: Of all that is drawn.
    """
    figures: list[Figure] = []
    by_type = {kind: [day for day in days if day.day_type == kind] for kind in DAY_TYPES}
    for stratum, kind in table.shares:
        name = f"{kind}, {stratum}"
        if not by_type[kind]:
            figures += unmeasured(CHECK, f"distance, {name}", why=f"no {kind} was lived (day 0 is a Monday)")
            continue
        lived = tally(by_type[kind], lambda day: day.person)
        figures += _against(lived, table.shares[stratum, kind][lived.hours], name, rng_at(seed, "time use", name))
    return [*figures, _week(days, seed)]


def hour_rows(days: Sequence[SpentDay], table: TimeUse, variant: str) -> Iterator[HourRow]:
    """The shares behind the figures, by stratum, day type, hour and category."""
    for stratum, kind in table.shares:
        lived = tally([day for day in days if day.day_type == kind], lambda day: day.person)
        real = table.shares[stratum, kind][lived.hours]
        shares = lived.pooled
        apart = jensen_shannon(shares, real)
        for at, hour in enumerate(lived.hours):
            for place, category in enumerate(CATEGORIES):
                ours, theirs = (100 * float(side[at, place]) for side in (shares, real))
                yield HourRow(
                    variant=variant,
                    stratum=stratum,
                    day_type=kind,
                    hour=hour,
                    category=category,
                    simulated_pct=round(ours, 3),
                    table_pct=round(theirs, 3),
                    difference_points=round(ours - theirs, 3),
                    hour_distance=round(float(apart[at]), 6),
                    person_days=int(lived.counts[:, at].sum()),
                )


def _against(lived: Tally, real: Floats, name: str, rng: np.random.Generator) -> Iterator[Figure]:
    """One day type against one stratum."""
    people = len(lived.totals)
    resampled = lived.shares(rng.multinomial(people, np.full(people, 1 / people), size=RESAMPLES).astype(np.float64))
    drawn = _drawn(lived, real, rng)
    for question in _questions(lived, real):
        value = float(question.statistic(lived.pooled))
        if np.isnan(value):
            yield from unmeasured(question.check, f"{question.measure}, {name}", why=question.note)
            continue
        low, high, notes = None, None, [question.note]
        if people < ENOUGH:
            notes.append(f"an interval takes {ENOUGH} people")
        elif half := half_width(question.statistic(resampled), people):
            low, high = max(value - half, question.least), min(value + half, question.most)
        control = None
        chance = _numbers(question.statistic(drawn)) if question.null else np.empty(0)
        if len(chance):
            control = float(chance.mean())
            notes.append(f"95 % of samples of the table below {np.quantile(chance, 0.95):.3f}")
        yield Figure(
            check=question.check,
            measure=f"{question.measure}, {name}",
            value=value,
            low=low,
            high=high,
            n=people,
            unit="people",
            control=control,
            control_is="drawn from the table" if control is not None else "",
            note="; ".join(filter(None, notes)),
        )


def _questions(lived: Tally, real: Floats) -> Iterator[Question]:
    hours, pooled = lived.hours, lived.pooled
    worst = hours[int(np.argmax(jensen_shannon(pooled, real)))]
    span = f"{len(hours)} hours from {hours[0]} to {hours[-1]}, {lived.days} person-days"
    yield Question(CHECK, "distance", span, lambda shares: jensen_shannon(shares, real).mean(axis=-1), 0, 1, null=True)
    yield Question(
        CHECK, "worst hour", f"at {worst}", lambda shares: jensen_shannon(shares, real).max(axis=-1), 0, 1, null=True
    )
    if _TV_HOUR in hours:
        at = hours.index(_TV_HOUR)
        ours, theirs = float(pooled[at, _TV]), float(real[at, _TV])
        said = f"{100 * ours:.1f} % simulated, {100 * theirs:.1f} % real: {100 * (ours - theirs):+.1f} points"
        yield Question(CHECK, f"tv at {_TV_HOUR}", said, lambda shares: shares[..., at, _TV] - theirs, -theirs, 1)
    for place, category in enumerate(CATEGORIES):
        yield from _of_category(place, category, hours, pooled, real)


def _of_category(place: int, category: str, hours: list[int], pooled: Floats, real: Floats) -> Iterator[Question]:
    ours, theirs = float(pooled[:, place].sum()), float(real[:, place].sum())

    def more(shares: Floats) -> Floats:
        return np.asarray(shares[..., place].sum(axis=-1) - theirs)

    def shift(shares: Floats) -> Floats:
        return earth_mover(shares[..., place], real[:, place], hours)

    said = f"{ours:.2f} h a day simulated, {theirs:.2f} h real"
    yield Question(BY_CATEGORY, f"{category}, more hours a day", said, more, -theirs, len(hours) - theirs)
    nobody = "nobody simulated does it" if not ours else "nobody in the table does it" if not theirs else ""
    yield Question(BY_CATEGORY, f"{category}, hours shifted", nobody, shift, 0, hours[-1] - hours[0], null=True)


def _drawn(lived: Tally, real: Floats, rng: np.random.Generator) -> Floats:
    """Shares in samples of the table, of as many days at each hour as were lived; (samples, hours, 9).

    Each sampled hour is of one category, and hours are drawn apart: a table does not say what follows what.
    """
    counts = lived.counts.sum(axis=0).astype(int)
    sampled = [rng.multinomial(n, share, size=NULLS) / n for n, share in zip(counts, real, strict=True)]
    return np.stack(sampled, axis=1)


def _week(days: Sequence[SpentDay], seed: int) -> Figure:
    """How far weekdays and weekends are from each other, against the same days with these two words shuffled.

    The words are shuffled among the days of each person and seed. Days of one number and seed, in several homes, go
    together, since they share their random draws.
    """
    measure = "weekday from weekend"
    hours = _common_hours(days)
    if not hours:
        return unmeasured(CHECK, measure, why="it takes a weekday and a weekend day (day 0 is a Monday)")[0]
    units = tally(days, _twins, hours)
    kinds = {_twins(day): day.day_type for day in days}
    lives = {_twins(day): (day.person, day.seed) for day in days}
    weekend = np.array([float(kinds[unit] == "weekend") for unit in units.units])
    value = float(_apart(units, weekend))
    rng = rng_at(seed, "time use", "week")
    shuffled = np.tile(weekend, (NULLS, 1))
    for life in dict.fromkeys(lives[unit] for unit in units.units):
        of = [at for at, unit in enumerate(units.units) if lives[unit] == life]
        shuffled[:, of] = rng.permuted(shuffled[:, of], axis=1)
    chance = _apart(units, shuffled)
    p = (1 + int((chance >= value - 1e-12).sum())) / (1 + len(chance))
    return Figure(
        check=CHECK,
        measure=measure,
        value=value,
        n=len({day.person for day in days}),
        unit="people",
        control=float(chance.mean()),
        control_is="days shuffled",
        note=f"p {p:.3f} of {len(chance)} shuffles of each person's days",
    )


def _twins(day: SpentDay) -> Hashable:
    return day.person, day.seed, day.number


def _common_hours(days: Sequence[SpentDay]) -> list[int]:
    """The hours that were lived on weekdays as well as on weekends."""
    both = [{*tally([day for day in days if day.day_type == kind], _twins).hours} for kind in DAY_TYPES]
    return sorted(set.intersection(*both))


def _apart(units: Tally, weekend: Floats) -> Floats:
    """Mean over the hours of the divergence of weekday and weekend; `weekend` 0 or 1, shape (..., units)."""
    apart = jensen_shannon(units.shares(1 - weekend), units.shares(weekend))
    known = ~np.isnan(apart)
    return np.asarray(np.where(known, apart, 0.0).sum(axis=-1) / np.maximum(known.sum(axis=-1), 1))


def within_table(days: Sequence[SpentDay], table: TimeUse) -> Iterator[Figure]:
    """The table's own distances over the lived hours: weekday from weekend, and one stratum from another.

    They say how large a distance is: people who are as far from employed 30-year-olds as retired couples are.
    """
    hours = tally(days, _twins).hours
    pairs: Mapping[str, tuple[Floats, Floats]] = {
        f"weekday from weekend, {stratum}": (table.shares[stratum, "weekday"], table.shares[stratum, "weekend"])
        for stratum in table.strata
        if all((stratum, kind) in table.shares for kind in DAY_TYPES)
    } | {
        f"{one} from {other}, {kind}": (table.shares[one, kind], table.shares[other, kind])
        for kind in DAY_TYPES
        for one, other in combinations([name for name in table.strata if (name, kind) in table.shares], 2)
    }
    for measure, (one, other) in pairs.items():
        value = float(jensen_shannon(one, other)[hours].mean())
        yield Figure(check=CHECK, measure=measure, variant="table", value=value, note=f"{len(hours)} hours")


def _numbers(values: Floats) -> Floats:
    return np.asarray(values[~np.isnan(values)])


def half_width(resampled: Floats, people: int) -> float | None:
    """Half a 95 % interval: Student's t times the standard deviation over resamples of the people.

    Percentiles of the resamples would not do: a resample repeats people, so its distance is larger than theirs, and the
    interval would lie above the value. The standard deviation is scaled by n / (n - 1), so that of a mean it is the
    usual standard error. None where the resamples do not differ, as they cannot say how sure one is.
    """
    spread = float(np.std(known)) if len(known := _numbers(resampled)) else 0.0
    if spread < 1e-9:
        return None
    return float(stats.t.ppf(0.975, people - 1) * spread * np.sqrt(people / (people - 1)))
