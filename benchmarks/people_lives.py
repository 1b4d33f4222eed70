"""How much of a life is the person, how much the id, how much the week, and what changes do to it.

    python -m benchmarks.people_lives [--humans ID,…] [--days 30] [--long 100] [--out DIR]

People live by the offline model's routine alone, at home and with weekends, without a world and without texts. Prints
Jensen-Shannon divergences, in bits, of how often each activity is done; with --out it draws long lives with changes.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy.stats import t as student

from benchmarks.fit_time_use import a_day
from coopera.config.schema import default_data_dir
from coopera.core.people import Persona, PersonId
from coopera.core.randomness import rng_at
from coopera.evaluation.people.divergence import jensen_shannon
from coopera.graphs.players.changes import Change, Work, as_variables
from coopera.memory import bundled
from coopera.models.offline.household.knowledge import Floats, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.circumstances import circumstances
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.rhythm import of_day_type
from coopera.people.shipped import find, shipped_ids

SHUFFLES = 500
WINDOW = 15  # days over which a life is compared with its beginning
CHANGES: dict[str, Change] = {
    "slow drift": Change(
        kind="drift",
        text="I move more",
        day=25,
        ramp=40,
        more={"cardio": 3.5, "yoga": 3.5, "nap": -2, "watch_series": -2},
    ),
    "new hobby": Change(kind="hobby", text="I have taken up painting", day=40, more={"paint": 4.0}),
    "new job": Change(
        kind="job",
        text="I have started a new job and work from home",
        day=40,
        work=Work(at="home", days=(0, 2, 4), start=12, end=18),
    ),
    "illness": Change(
        kind="illness",
        text="I have broken a leg",
        day=40,
        until=70,
        more={"watch_series": 2, "read": 2, "nap": 2},
        never=("cardio", "strength", "yoga", "sweep", "dust", "laundry"),
    ),
}
"""One change of each kind, at its own pace."""


def main() -> None:
    """Print the figures, and draw them if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--humans", default=",".join(shipped_ids()))
    parser.add_argument("--days", type=int, default=30)
    parser.add_argument("--long", type=int, default=100)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    people = [find(name, default_data_dir()) for name in given.humans.split(",")]
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        sense = CommonSense(shipped(), embeddings)
        lives = {one.id: PrivateLife(sense, one.profile, one.big_five) for one in people}
        _who(people, lives, given.days)
        _week(people, lives, given.days)
        courses = _changes(people, lives, given.long)
    if given.out:
        given.out.mkdir(parents=True, exist_ok=True)
        _draw(courses, given.out / "life-changes.png")


def _who(people: Sequence[Persona], lives: dict[PersonId, PrivateLife], days: int) -> None:
    once = {one.id: _shares(lives[one.id], f"{one.id} a", range(days)) for one in people}
    again = {one.id: _shares(lives[one.id], f"{one.id} b", range(days)) for one in people}
    same = [float(jensen_shannon(once[one.id], again[one.id])) for one in people]
    apart = [float(jensen_shannon(once[a.id], once[b.id])) for a, b in combinations(people, 2)]
    print(f"{len(people)} people, {days} days, divergence in bits:")
    print(f"- a persona under another id: {np.mean(same):.3f}, at most {max(same):.3f}")
    if apart:
        print(f"- two personas: {np.mean(apart):.3f}, at least {min(apart):.3f}")


def _week(people: Sequence[Persona], lives: dict[PersonId, PrivateLife], days: int) -> None:
    """Weekdays against weekends of each person, and against as many days drawn by chance."""
    found, chance = [], []
    for one in people:
        lived = np.stack([_counts(lives[one.id], one.id, day) for day in range(days)])
        kinds = np.array([of_day_type(day % 7) for day in range(days)])
        found.append(_between(lived, kinds))
        rng = rng_at(0, "shuffled week", one.id)
        chance.append(float(np.mean([_between(lived, rng.permutation(kinds)) for _ in range(SHUFFLES)])))
    more = np.subtract(found, chance)
    half = float(student.ppf(0.975, len(more) - 1) * more.std(ddof=1) / np.sqrt(len(more))) if len(more) > 2 else np.nan
    print(
        f"- weekday from weekend: {np.mean(found):.3f}, by chance {np.mean(chance):.3f}, "
        f"more by {more.mean():.3f} +- {half:.3f} (95 %, t over people)"
    )


def _changes(people: Sequence[Persona], lives: dict[PersonId, PrivateLife], days: int) -> dict[str, list[float]]:
    """How far the days around each day are from the first, by kind of change; means over the people."""
    courses: dict[str, list[float]] = {}
    for name, change in {"nothing changes": None, **CHANGES}.items():
        rows = []
        for one in people:
            lived = np.stack([_counts(lives[one.id], f"{one.id} long", day, change) for day in range(days)])
            first = lived[:WINDOW].sum(axis=0)
            ends = range(WINDOW, days + 1)
            rows.append([float(jensen_shannon(_share(first), _share(lived[e - WINDOW : e].sum(axis=0)))) for e in ends])
        courses[name] = [float(x) for x in np.mean(rows, axis=0)]
        at = {day: courses[name][day - WINDOW] for day in (30, 60, days)}
        print(f"- {name}: " + ", ".join(f"{value:.3f} in the {WINDOW} days to day {day}" for day, value in at.items()))
    return courses


def _draw(courses: dict[str, list[float]], path: Path) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - heavy
    from matplotlib.figure import Figure  # noqa: PLC0415

    picture = Figure(figsize=(8.0, 4.0), layout="constrained")
    FigureCanvasAgg(picture)
    axes = picture.subplots()
    for (name, course), style in zip(courses.items(), ("--", "-", "-", "-", "-"), strict=True):
        axes.plot(
            range(WINDOW, WINDOW + len(course)), course, style, label=name, color="#777777" if style == "--" else None
        )
    axes.set_xlabel(f"day (each point: the {WINDOW} days up to it)")
    axes.set_ylabel(f"divergence from the first {WINDOW} days, bits")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    picture.savefig(path, dpi=150)


def _shares(life: PrivateLife, who: str, days: range) -> Floats:
    return _share(np.sum([_counts(life, who, day) for day in days], axis=0))


def _counts(life: PrivateLife, who: str, day: int, change: Change | None = None) -> Floats:
    """How often each activity is done on a day."""
    active = [change] if change and change.strength(day) > 0 else []
    today = circumstances(life.household, as_variables(active, day), absence=False)
    done = [one.activity for one in a_day(life, who, day, absence=False, today=today)]
    return np.bincount(done, minlength=len(life.household.activities)).astype(np.float64)


def _share(counts: Floats) -> Floats:
    return np.asarray(counts / counts.sum(), dtype=np.float64)


def _between(lived: Floats, kinds: np.ndarray) -> float:
    return float(jensen_shannon(*(_share(lived[kinds == kind].sum(axis=0)) for kind in (0, 1))))


if __name__ == "__main__":
    main()
