"""Which things does a person move in which hour? `python -m benchmarks.homer DAYS.json --json`.

DAYS.json holds days of HOMER+ (Patel, Prakash and Chernova 2023, github.com/Maithili/HOMER_PLUS, MIT): it maps
"A/train/000" to {"schedule": [[activity, start, end], …], "moves": [[minute, thing, destination], …]}, in minutes from
midnight. Days of a household and part are numbered without a gap.

For each hour h from 9 to 21 of each day of "test" it is foretold which things are moved from h:00 to h:59. Known are
the first n days of "train", the hour, and what this day brought before h:00: the activity last begun by then, whether
it is over and since when, and which things were moved when and where to. F1 is over all hours, days and things; a thing
that was never seen counts as missed.

`counts` is the yardstick: the mean of a thing's frequency at this hour and after this activity, going on or over, with
yes from 0.4. `ours` is `coopera.models.learners.habits.Habits`. It chooses what it learns with, and its threshold, on
held-out days of "train"; the days of "test" only give the figure. `gain` holds the ends of a 95 % interval of the
difference, by a bootstrap over the days of "test".
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.outside import is_name, read_json, run
from coopera.core.errors import ConfigError
from coopera.evaluation.statistics import bootstrap
from coopera.models.learners.counts import Bools, Floats, Ints, Observations
from coopera.models.learners.habits import Habits

HOURS = range(9, 22)
TRAINED = (1, 5, 20, 65)
THRESHOLD = 0.4
MOST_DAYS, MOST_LINES, MOST_THINGS = 2_000, 5_000, 2_000
_KEY = re.compile(r"([\w-]{1,40})/(train|test)/(\d{3,4})")
_MIDNIGHT, _LATEST = 1440.0, 2880.0
_STAGES = (5, 15, 30, 60, 120)  # minutes since an activity began, or ended
_RESTED = (15, 60, 180, 1000)  # minutes since a thing was put where it lies


@dataclass(frozen=True, slots=True)
class Day:
    """A day: activities as (name, start, end) and moves as (minute, thing, destination), in order."""

    schedule: list[tuple[str, float, float]]
    moves: list[tuple[float, str, str]]

    def moved(self, hour: int) -> set[str]:
        """Return the things moved in an hour."""
        return {thing for minute, thing, _ in self.moves if 60 * hour <= minute < 60 * (hour + 1)}

    def last(self, hour: int) -> tuple[str, bool, float]:
        """Return the activity last begun by h:00, whether it is over, and the minutes since it began or ended."""
        begun = [one for one in self.schedule if one[1] <= 60 * hour]
        if not begun:
            return "", True, 60.0 * hour
        name, start, end = begun[-1]
        over = end <= 60 * hour
        return name, over, 60 * hour - (end if over else start)


Households = Mapping[str, Mapping[str, Sequence[Day]]]


def read_days(path: Path) -> Households:
    """Return the days of each household and part, in order.

    Raises:
        ConfigError: If the file is not as the module says.
    """
    found = read_json(path)
    if not isinstance(found, dict) or not found:
        raise ConfigError(f'{path}: expected a JSON object of days such as "A/train/000"')
    if len(found) > MOST_DAYS:
        raise ConfigError(f"{path}: has {len(found)} days, expected at most {MOST_DAYS}")
    days: dict[str, dict[str, dict[int, Day]]] = {}
    for key, value in found.items():
        named = _KEY.fullmatch(key)
        if named is None:
            raise ConfigError(f'{path}: {key!r} names no day, expected a name such as "A/train/000"')
        part = days.setdefault(named[1], {"train": {}, "test": {}})[named[2]]
        if int(named[3]) in part:
            raise ConfigError(f"{path}: {key!r} is a day that stands twice")
        part[int(named[3])] = _day(f"{path}: {key}", value)
    for household, parts in days.items():
        for part_name, part in parts.items():
            missing = sorted(set(range(max(part, default=-1) + 1)) - set(part))
            if missing:
                raise ConfigError(f"{path}: the day {household}/{part_name}/{missing[0]:03d} is missing")
    if (
        len(
            {
                thing
                for parts in days.values()
                for part in parts.values()
                for day in part.values()
                for _, thing, _ in day.moves
            }
        )
        > MOST_THINGS
    ):
        raise ConfigError(f"{path}: has more than {MOST_THINGS} things")
    return {
        name: {part: [those[number] for number in sorted(those)] for part, those in parts.items()}
        for name, parts in sorted(days.items())
    }


def _day(where: str, value: object) -> Day:
    if not isinstance(value, dict) or set(value) != {"schedule", "moves"}:
        raise ConfigError(f"{where}: expected an object with schedule and moves")
    for name in ("schedule", "moves"):
        if not isinstance(value[name], list) or len(value[name]) > MOST_LINES:
            raise ConfigError(f"{where}: {name}: expected a list of at most {MOST_LINES} entries")
    schedule: list[tuple[str, float, float]] = []
    for place, line in enumerate(value["schedule"]):
        if not (isinstance(line, list) and len(line) == 3 and is_name(line[0]) and all(map(_minute, line[1:]))):
            raise ConfigError(f"{where}: schedule[{place}]: expected [activity, start, end] in minutes from midnight")
        if line[2] < line[1] or (schedule and line[1] < schedule[-1][2]):
            raise ConfigError(f"{where}: schedule[{place}]: times are out of order, expected each to follow the last")
        schedule.append((line[0], float(line[1]), float(line[2])))
    moves: list[tuple[float, str, str]] = []
    for place, line in enumerate(value["moves"]):
        if not (
            isinstance(line, list)
            and len(line) == 3
            and _minute(line[0])
            and line[0] < _MIDNIGHT
            and all(map(is_name, line[1:]))
        ):
            raise ConfigError(f"{where}: moves[{place}]: expected [minute, thing, destination], the minute below 1440")
        if moves and line[0] < moves[-1][0]:
            raise ConfigError(f"{where}: moves[{place}]: times are out of order, expected each to follow the last")
        moves.append((float(line[0]), line[1], line[2]))
    return Day(schedule, moves)


def _minute(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= _LATEST


class Codes:
    """Numbers for things, activities and places of the days that were learned from; 0 is another activity or place."""

    def __init__(self, days: Iterable[Day]) -> None:
        days = list(days)
        self.things = sorted({thing for day in days for _, thing, _ in day.moves})
        self._activities = _numbered(name for day in days for name, _, _ in day.schedule)
        self._places = _numbered(place for day in days for _, _, place in day.moves)

    def observations(self, days: Sequence[Day]) -> Observations:
        """Return a row per day, hour and thing, in this order."""
        parts = [self._of_day(number, day) for number, day in enumerate(days)]
        day, thing, contexts, numbers, label = (np.concatenate(column) for column in zip(*parts, strict=True))
        return Observations(day, thing, contexts, numbers, label)

    def _of_day(self, number: int, day: Day) -> tuple[Ints, Ints, Ints, Floats, Bools]:
        count = len(self.things)
        place = {thing: at for at, thing in enumerate(self.things)}
        moves = [(minute, place[thing], to) for minute, thing, to in day.moves if thing in place]
        moved = np.zeros((24, count), dtype=bool)
        for minute, thing, _ in moves:
            moved[int(minute // 60), thing] = True
        contexts, numbers = [], []
        for hour in HOURS:
            name, over, since = day.last(hour)
            activity = self._activities.get(name, 0)
            state = 2 * activity + over
            stage = int(np.digitize(since, _STAGES))
            done = moved[:hour].sum(0)
            ago = np.where(done > 0, 1 + moved[:hour][::-1].argmax(0), 24)
            lies, rested = self._lie(moves, hour)
            at, before = hour - HOURS[0], np.minimum(done, 2)
            columns: list[Any] = [at, state, lies, activity, state * (len(_STAGES) + 1) + stage]
            columns += [lies * (len(_RESTED) + 1) + rested, at * 3 + before, state * 3 + before]
            contexts.append(np.stack([np.broadcast_to(column, count) for column in columns], 1))
            numbers.append(np.stack([np.full(count, hour), np.full(count, stage), done, ago], 1).astype(float))
        rows = len(HOURS) * count
        return (
            np.full(rows, number),
            np.tile(np.arange(count), len(HOURS)),
            np.concatenate(contexts),
            np.concatenate(numbers),
            moved[HOURS[0] : HOURS[-1] + 1].ravel(),
        )

    def _lie(self, moves: Sequence[tuple[float, int, str]], hour: int) -> tuple[Ints, Ints]:
        """Return where each thing was put last today, by h:00, and the stage of how long it has lain there."""
        lies, put = np.zeros(len(self.things), np.int64), np.full(len(self.things), -np.inf)
        for minute, thing, to in moves:
            if minute < 60 * hour:
                lies[thing], put[thing] = self._places.get(to, 0), minute
        return lies, np.digitize(60 * hour - put, _RESTED)


def _numbered(names: Iterable[str]) -> dict[str, int]:
    return {name: number for number, name in enumerate(sorted(set(names)), 1)}


def counts(train: Observations, test: Observations) -> Bools:
    """Return what plain frequencies foretell, shape (n,): the yardstick, without smoothing."""
    shares = []
    for column in (0, 1):
        width = int(max(train.contexts[:, column].max(), test.contexts[:, column].max())) + 1
        keys, asked = (one.thing * width + one.contexts[:, column] for one in (train, test))
        size = int(max(keys.max(), asked.max())) + 1
        met = np.bincount(keys, minlength=size)
        shares.append((np.bincount(keys, train.label, size) / np.maximum(met, 1))[asked])
    yes: Bools = (shares[0] + shares[1]) / 2 >= THRESHOLD - 1e-9
    return yes


def f1(yes: Bools, label: Bools, total: int) -> float:
    """Return F1, where `total` things were moved in all, seen before or not."""
    return round(float(2 * (yes & label).sum() / max(yes.sum() + total, 1)), 4)


def household(train: Sequence[Day], test: Sequence[Day]) -> dict[str, Any]:
    """Learn from the days of `train`; return F1 on those of `test`, the interval of the gain, and who speaks."""
    codes = Codes(train)
    total = sum(len(day.moved(hour)) for day in test for hour in HOURS)
    if not codes.things:
        return {"counts": 0.0, "ours": 0.0, "gain": [0.0, 0.0], "chosen": "counts"}
    seen, asked = codes.observations(train), codes.observations(test)
    habits = Habits()
    habits.train(seen)
    said = {"counts": counts(seen, asked), "ours": habits.says_yes(asked)}
    found = {name: f1(yes, asked.label, total) for name, yes in said.items()}
    return found | {"gain": gain(test, asked, said["counts"], said["ours"]), "chosen": habits.chosen.name}


def gain(test: Sequence[Day], asked: Observations, than: Bools, yes: Bools) -> list[float]:
    """Return the ends of a 95 % interval of the gain in F1 over `than`: the days asked about, resampled."""
    days = []
    for number, day in enumerate(test):
        own = asked.day == number
        total = sum(len(day.moved(hour)) for hour in HOURS)
        days.append([(2 * (said & asked.label)[own].sum(), said[own].sum() + total) for said in (than, yes)])

    def gained(drawn: Sequence[list[tuple[int, int]]]) -> float:
        both, all_ = np.sum(drawn, axis=0).T
        before, after = both / np.maximum(all_, 1)
        return float(after - before)

    _, low, high = bootstrap(days, gained)
    return [round(low, 4), round(high, 4)]


def measure(asked: argparse.Namespace) -> dict[str, Any]:
    """Return F1 by household and number of training days.

    Raises:
        ConfigError: If the file is wrong, or has fewer days than asked for.
    """
    households = read_days(asked.file)
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for name, parts in households.items():
        there = len(parts["train"])
        if not there or not parts["test"]:
            raise ConfigError(f"{asked.file}: household {name} has no day of {'test' if there else 'train'}")
        wanted = asked.days or [n for n in TRAINED if n <= there]
        if max(wanted) > there:
            raise ConfigError(
                f"{asked.file}: household {name} has {there} days of train, and --days asks for {max(wanted)}"
            )
        found[name] = {}
        for n in wanted:
            found[name][str(n)] = got = household(parts["train"][:n], parts["test"])
            low, high = got["gain"]
            print(
                f"{name} after {n:3} days: counts {got['counts']:.3f}, ours {got['ours']:.3f},"
                f" gain {low:+.3f} to {high:+.3f} ({got['chosen']})",
                flush=True,
            )
    return {"homer": found}


def _count(text: str) -> int:
    if not text.isdigit() or not 1 <= int(text) <= MOST_DAYS:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of days")
    return int(text)


def main(given: Sequence[str] | None = None) -> int:
    """Print a line per household and number of days; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--days", type=_count, nargs="+", help="days of train to learn from; default: 1 5 20 65")
    return run(measure, parser, given)


if __name__ == "__main__":
    raise SystemExit(main())
