"""What the person told of earlier days, hour by hour, and how much each of these hours says about now.

An account gives an hour's intention and its tasks together. The memory keeps them in two streams; here they are joined
again. A robot that lives with somebody for weeks counts such hours. What counts is how they looked, at which time of
day and on which kind of day they were, what was wanted, and how many days have passed.
DEVIATES: the paper weighs memories by hours alone and keeps intentions and tasks apart.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, lru_cache
from typing import Any, NamedTuple, TypeAlias

from coopera.core.clock import Clock
from coopera.core.hour import Observation
from coopera.core.household import Use, plain, use_of
from coopera.graphs.robots.recall import DAYS, NARROW, WIDE, as_memory, weights
from coopera.graphs.robots.robot_view import RobotView
from coopera.graphs.robots.turns import Uses as ThingsByHour
from coopera.graphs.robots.turns import still_counts, things_of
from coopera.memory import Texts

SAME_FIRST, SAME_ANY, OTHER_THING = 1.0, 0.5, 0.05  # what the thing in hand says of an hour, by its part in it
SAME_PLACE, OTHER_PLACE = 0.6, 0.15  # and the furniture, where the thing was not recognised
UNLIKE, ALIKE = 0.3, 0.65  # cosines of intentions below and above which they are different, and the same


class ToldHour(NamedTuple):
    """An hour of an account. `uses` are its tasks as things and places, in the order in which they were done.

    Attributes:
        now: Global hour index.
        intention: In the person's words.
        tasks: In words, the first one first.
        uses: The same, as far as they can be read.
        near: How much it counts at this hour of this day, whatever was seen, in (0, 1].
        looks: How well it fits what is seen, in (0, 1].
        wide: As `near`, with more patience for another time of day.
    """

    now: int
    intention: str
    tasks: tuple[str, ...]
    uses: tuple[Use, ...]
    near: float
    looks: float
    wide: float

    @property
    def speaks(self) -> float:
        """How much it says of what is wanted now."""
        return self.near * self.looks


def told_hours(view: RobotView, saw: str = "", *, turns: bool = False) -> list[ToldHour]:
    """Join what was told of the last `DAYS` days before today, oldest first.

    Args:
        view: What the robot knows.
        saw: What a robot that looks at pictures says it saw; how well an hour fits goes by that where nothing else is
            known of this one.
        turns: Whether hours from before a turn in the person's life count less (`graphs.robots.turns`).
    """
    clock, since = view.clock, (view.clock.day - DAYS) * 24
    told = [_Columns.of(stream.texts(since)) for stream in view.history]
    hours, things = _joined(*told, clock.day)
    counts = still_counts(things) if turns else {}
    looks = _looks(held(view.observation), _near(view.observation), saw)
    at = [hour[0] for hour in hours]
    weighed = zip(hours, weights(clock, at, NARROW), weights(clock, at, WIDE), strict=True)
    return [
        ToldHour(
            now,
            text,
            done,
            uses,
            near=narrow * counts.get(now // 24, 1.0),
            looks=looks(uses),
            wide=wide * counts.get(now // 24, 1.0),
        )
        for (now, text, done, uses), narrow, wide in weighed
    ]


_Hour: TypeAlias = tuple[int, str, tuple[str, ...], tuple[Use, ...]]
"""What of a `ToldHour` is the same whenever one looks back at it: all but how much it says."""


class _Columns(NamedTuple):
    """`Texts` that can be a key."""

    texts: tuple[str, ...]
    hours: tuple[int, ...]

    @classmethod
    def of(cls, told: Texts) -> _Columns:
        return cls(tuple(told.texts), tuple(told.hours))


@lru_cache(maxsize=1)  # what was told before today stays so all day
def _joined(intentions: _Columns, tasks: _Columns, day: int) -> tuple[tuple[_Hour, ...], ThingsByHour]:
    """The hours before a day, oldest first, and by what was used in them the turns of a life are seen."""
    done: dict[int, list[str]] = defaultdict(list)
    for text, now in zip(*tasks, strict=True):
        done[now].append(text)
    wanted = {now: text for text, now in zip(*intentions, strict=True) if now < day * 24}
    uses = {now: tuple(use for task in done[now] if (use := use_of(task)) is not None) for now in wanted}
    return tuple((now, text, tuple(done[now]), uses[now]) for now, text in wanted.items()), things_of(uses.items())


def likeness(view: RobotView, told: Sequence[ToldHour], intentions: Sequence[str]) -> list[list[float]]:
    """How like each intention is to that of each told hour, by meaning, in [0, 1]; the same words give 1."""
    if not told or not intentions:
        return [[] for _ in intentions]
    stream = view.history.intentions
    _, hours, cosines = stream.relevances(intentions, view.clock.now, told[0].now, (UNLIKE, ALIKE))
    place = {hour: at for at, hour in enumerate(hours)}
    of_told = cosines[:, [place[hour.now] for hour in told]]
    alike: list[list[float]] = ((of_told - UNLIKE) / (ALIKE - UNLIKE)).tolist()
    return alike


def best_hours(told: Sequence[ToldHour], weights: Sequence[float], most: int) -> list[tuple[ToldHour, float]]:
    """The hours of most weight with their weights, the newer of equals first; none without weight."""
    some = [pair for pair in zip(told, weights, strict=True) if pair[1] > 0.01]
    return sorted(some, key=lambda pair: (-round(pair[1], 9), -pair[0].now))[:most]


def as_told(hours: Iterable[tuple[ToldHour, float]], now: Clock, *, without: Use | None = None) -> list[dict[str, Any]]:
    """The variable `told` of `coopera.core.asks`, without tasks with the thing that the person holds already."""
    return [
        {
            **{key: value for key, value in as_memory("", hour.now, now).items() if key in ("when", "hours_ago")},
            "intention": hour.intention,
            "tasks": [task for task in hour.tasks if without is None or not same(use_of(task), without)],
            "weight": round(weight, 4),
        }
        for hour, weight in hours
    ]


def held(seen: Observation) -> Use | None:
    """What the person has in hand, or has just put somewhere; None where nobody knows."""
    if seen.first_task:
        return use_of(seen.first_task)
    thing = seen.percept.in_hand if seen.percept else None
    return Use(plain(thing)) if thing else None


def same(one: Use | None, other: Use) -> bool:
    """Whether an act is about the same thing and, where both name one, the same place."""
    if one is None or one.thing.lower() != other.thing.lower():
        return False
    return one.place is None or other.place is None or one.place.lower() == other.place.lower()


Uses: TypeAlias = Mapping[str, Mapping[Use, Sequence[int]]]
"""In which told hours each thing was used, by their places in order of time: first by its name in small letters."""


def uses_of(told: Sequence[ToldHour]) -> Uses:
    """Look once at what was used in the told hours, for all that is asked of them now."""
    places: dict[Use, list[int]] = defaultdict(list)
    for place, hour in enumerate(told):
        for use in dict.fromkeys(hour.uses):
            places[use].append(place)
    found: dict[str, dict[Use, list[int]]] = defaultdict(dict)
    for use, used in places.items():
        found[use.thing.lower()][use] = used
    return found


def used_in(uses: Uses, use: Use) -> list[int]:
    """The places of the told hours in which a thing was used, ascending."""
    alike = uses.get(use.thing.lower(), {})
    return sorted({place for one, places in alike.items() if same(one, use) for place in places})


def share(used: Sequence[int], weights: Sequence[float], *, usual: float, patience: float) -> float:
    """The share by weight of the hours at some places; `patience` hours of the `usual` share come on top."""
    return (sum(weights[place] for place in used) + patience * usual) / (sum(weights) + patience)


def shares(
    told: Sequence[ToldHour], weights: Sequence[float], without: Use | None, *, places: bool
) -> dict[Use, float]:
    """The share of the hours, by weight, in which each thing was used, with `places` each at each place.

    What was used in hours without weight alone is left out.
    """
    total = sum(weights) or 1.0
    found: dict[Use, float] = defaultdict(float)

    @cache  # the same few things are used in hour after hour
    def counted(use: Use) -> Use | None:
        if without is not None and same(use, without):
            return None
        return use if places else Use(use.thing)

    for hour, weight in zip(told, weights, strict=True):
        for use in dict.fromkeys(map(counted, hour.uses)) if weight else ():
            if use is not None:
                found[use] += weight / total
    return found


def _near(seen: Observation) -> list[str]:
    """The furniture near the person, in words."""
    return [plain(name) for name in seen.percept.near] if seen.percept else []


def _looks(has: Use | None, near: Sequence[str], saw: str) -> Callable[[Sequence[Use]], float]:
    """How well a told hour fits what is seen now: by the thing that the person has, else by the furniture near them."""

    @cache  # the same few things are used in hour after hour
    def with_it(use: Use) -> bool:
        return has is not None and same(use, has)

    def looks(uses: Sequence[Use]) -> float:
        if not uses:
            return OTHER_PLACE
        if has is not None:
            return SAME_FIRST if with_it(uses[0]) else SAME_ANY if any(map(with_it, uses)) else OTHER_THING
        if near:
            return SAME_PLACE if uses[0].place in near else OTHER_PLACE
        return _mentioned(saw, uses) if saw else SAME_FIRST

    return looks


def _mentioned(saw: str, uses: Sequence[Use]) -> float:
    """The same by words: which of the hour's things is named in them, else whether its first place is."""
    words = f" {' '.join(re.findall(r'[a-z0-9]+', saw.lower()))} "
    named = [f" {use.thing.lower()} " in words for use in uses]
    if any(named):
        return SAME_FIRST if named[0] else SAME_ANY
    return SAME_PLACE if f" {(uses[0].place or '?').lower()} " in words else OTHER_PLACE
