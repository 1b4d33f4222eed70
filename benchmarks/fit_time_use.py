"""Fit the rhythm of the offline person's days to a time-use table: who works when, who sleeps late, what takes long.

    python -m benchmarks.fit_time_use [TABLE.csv] [--stratum O1] [--out models/offline/human/rhythm.yaml]

People whose profiles are drawn from the statements of aspects.yaml live two weeks in each round; a category that took
too little of an hour is made more attractive there. No other figure of the person is touched, and nobody on whom the
result is judged takes part.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import yaml
from scipy.optimize import nnls

from coopera.config.schema import default_data_dir
from coopera.core.people import TRAITS, BigFive
from coopera.core.randomness import rng_at
from coopera.core.time_use import CATEGORIES, DAY_TYPES
from coopera.evaluation.people.divergence import jensen_shannon
from coopera.evaluation.people.hours_spent import filled
from coopera.evaluation.people.time_use import named_time_use
from coopera.memory import bundled
from coopera.models.offline.household.knowledge import FIRST, LAST, Floats, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human import rhythm as human_rhythm
from coopera.models.offline.human.circumstances import Circumstances
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.persona import shipped_aspects
from coopera.models.offline.human.rhythm import Rhythm, Schedule, of_day_type
from coopera.models.offline.human.routine import Done, Moment, live_day

HOURS = range(FIRST, LAST + 1)
PEOPLE, DAYS, ROUNDS = 200, 14, 12
STEP = 0.7  # share of the error in logits that a round takes away
LEAST, MOST = -6.0, 6.0  # logits beyond which a category is as good as never, or always
FITTED = ("sleeping", "food_prep", "laundry", "tv", "eating", "exercise", "travel")
FEW = 0.002  # share of an hour that is added before logs are taken
LONGEST = 10  # hours of work a day
UNSCHEDULED = -3.0  # logit of work outside the hours of work
WORKDAYS = ((0, 1, 2, 3, 4), (0, 1, 2, 3), (1, 2, 3, 4, 5), (2, 3, 4, 5, 6), (0, 1, 4, 5, 6), (5, 6))


def main() -> None:
    """Fit and write the file; say how near each round came."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", nargs="?", default="shipped", help="a table of time use; default: the shipped one")
    parser.add_argument("--stratum", default="O1")
    parser.add_argument("--out", type=Path, default=Path(human_rhythm.__file__).with_name("rhythm.yaml"))
    given = parser.parse_args()
    real = _shares(given.table, given.stratum)
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        sense = CommonSense(shipped(), embeddings)
        fitted = fit(sense, real, list(somebody(PEOPLE)))
    written = {
        "source": f"{named_time_use(given.table).source}; stratum {given.stratum}",
        "command": f"python -m benchmarks.fit_time_use {given.table} --stratum {given.stratum}",
        **fitted.model_dump(mode="json", exclude={"source", "command"}),
    }
    head = "# Fitted, not written by hand: see `source` and `command`, and models/offline/human/rhythm.py.\n"
    given.out.write_text(
        head + yaml.safe_dump(written, sort_keys=False, default_flow_style=None, width=120), encoding="utf-8"
    )


def fit(sense: CommonSense, real: Floats, people: Sequence[tuple[str, BigFive]]) -> Rhythm:
    """Return the rhythm by which these people spend their hours as the table has it.

    Args:
        sense: Of the household.
        real: The table's shares of time, (day types, hours, categories).
        people: Profiles and traits.
    """
    work = real[:, :, CATEGORIES.index("work")]
    wanted = work.copy()
    logits = np.zeros((len(DAY_TYPES), len(CATEGORIES), len(HOURS)))
    logits[:, CATEGORIES.index("work")] = UNSCHEDULED
    asleep = real[:, :, CATEGORIES.index("sleeping")]
    rhythm = _rhythm(asleep, schedules(wanted), logits)
    lives = [PrivateLife(sense, profile, big_five, rhythm) for profile, big_five in people]
    for turn in range(ROUNDS):
        rhythm = _rhythm(asleep, schedules(wanted), logits)
        lived = population([life.keeping(rhythm) for life in lives])
        apart = jensen_shannon(lived, real)
        print(f"round {turn}: {apart.mean():.4f} bits from the table, {apart.max():.4f} in the worst hour")
        missing = (work + FEW) / (lived[:, :, CATEGORIES.index("work")] + FEW)
        wanted = np.clip(wanted * np.clip(missing, 0.8, 1.25), 0.0, 1.0)
        error = np.log(real + FEW) - np.log(lived + FEW)
        error = error - error[:, :, CATEGORIES.index("other")][:, :, None]
        for name in FITTED:
            at = CATEGORIES.index(name)
            logits[:, at] = np.clip(logits[:, at] + STEP * error[:, :, at], LEAST, MOST)
    return rhythm


def population(lives: Sequence[PrivateLife], days: int = DAYS) -> Floats:
    """Return shares of time, (day types, hours, categories), of people who live some days where they please."""
    taken, lived = np.zeros((len(DAY_TYPES), len(HOURS), len(CATEGORIES))), np.zeros(len(DAY_TYPES))
    for number, life in enumerate(lives):
        activities = life.household.activities
        for day in range(days):
            spent = {one.hour: activities[one.activity].minutes for one in a_day(life, number, day)}
            taken[of_day_type(day % 7)] += filled(spent)[list(HOURS)]
            lived[of_day_type(day % 7)] += 1
    return taken / lived[:, None, None]


def a_day(
    life: PrivateLife, who: object, day: int, *, absence: bool = True, today: Circumstances | None = None
) -> list[Done]:
    """Live a day with nothing broken or dirty; `who` tells lives of one person apart."""
    count = len(life.household.activities)
    free = Moment(
        hour=FIRST,
        weekday=day % 7,
        today=(),
        lasting=True,
        absence=absence,
        possible=np.ones(count, dtype=bool) if today is None else today.can_do,
        extra=np.zeros(count) if today is None else today.pull,
        job=None if today is None else today.job,
    )
    lived = live_day(life, free, HOURS, (rng_at(0, "lived", who, day, hour) for hour in HOURS))
    return [Done(choice.activity, hour) for hour, choice in zip(HOURS, lived, strict=True)]


def somebody(count: int) -> Iterator[tuple[str, BigFive]]:
    """People of whom nothing is known but what the statements of aspects.yaml say."""
    for number in range(count):
        rng = rng_at(0, "somebody", number)
        says = [aspect.statements[int(rng.integers(len(aspect.statements)))].says for aspect in shipped_aspects()]
        traits = np.clip(rng.normal(3.0, 0.8, len(TRAITS)), 1.0, 5.0)
        yield ". ".join(says) + ".", BigFive(**{name: float(x) for name, x in zip(TRAITS, traits, strict=True)})


def schedules(work: Floats) -> tuple[Schedule, ...]:
    """The few hours of work whose mixture comes nearest to the shares of people at work; `work` (day types, hours)."""
    options = [
        Schedule(days=days, start=start, end=end)
        for days in WORKDAYS
        for start in range(6, 17)
        for end in range(start + 4, 25)
        if end - start <= LONGEST and end > FIRST
    ]
    columns = np.array([[_at_work(one, d, hour) for d in (0, 1) for hour in HOURS] for one in options]).T
    found, _ = nnls(columns, np.clip(work, 0, 1).ravel())
    found = found / max(1.0, float(found.sum()))
    return tuple(
        one.model_copy(update={"share": round(float(share), 4)})
        for one, share in zip(options, found, strict=True)
        if share >= 0.005
    )


def _at_work(one: Schedule, d: int, hour: int) -> float:
    """Share of the days of a type on which a schedule has an hour of work."""
    days = [day for day in range(7) if of_day_type(day) == d]
    return sum(one.covers(day, hour) for day in days) / len(days)


def _rhythm(asleep: Floats, hours: Sequence[Schedule], logits: Floats) -> Rhythm:
    named: Mapping[str, object] = {
        day: {name: [round(float(x), 2) for x in logits[d, c]] for c, name in enumerate(CATEGORIES) if name != "other"}
        for d, day in enumerate(DAY_TYPES)
    }
    sleepers = {day: [round(float(x), 4) for x in asleep[d]] for d, day in enumerate(DAY_TYPES)}
    return Rhythm.model_validate(
        {"source": "", "command": "", "asleep": sleepers, "schedules": tuple(hours), "logits": named}
    )


def _shares(name: str, stratum: str) -> Floats:
    """The table's shares of the simulated hours; (day types, hours, categories)."""
    table = named_time_use(name)
    return np.stack([table.shares[stratum, day][list(HOURS)] for day in DAY_TYPES])


if __name__ == "__main__":
    main()
