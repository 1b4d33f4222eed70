"""A grid of runs as data: which methods meet which lives, in which order.

A *life* is one episode of one setting: some people in some homes for some days, under one seed. Each method meets it in
a run of its own; the life itself is lived once, without a robot.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle, product
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field, ValidationError

from coopera.core.clock import HOURS_PER_DAY
from coopera.core.errors import ConfigError
from coopera.core.people import Frozen
from coopera.evaluation.measuring import find_measure
from coopera.evaluation.settings import SETTINGS

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_+-]{0,39}$")]
Count = Annotated[int, Field(strict=True, ge=1, le=10_000)]


OF = "+"
"""Between a method and its variant."""
SHARED, AGAIN = "shared", "again"


class Schedule(Frozen):
    """An order of days of one's own, by position: person 0, 1, … and home 0, 1, … of an episode, one pair a day."""

    people: Annotated[int, Field(strict=True, ge=1, le=100)]
    scenes: Annotated[int, Field(strict=True, ge=1, le=100)]
    days: Annotated[list[tuple[int, int]], Field(min_length=1, max_length=366)]
    episodes: tuple[Count, Count] = (1, 1)
    """How many groups of people and of homes there are, each pair of groups being an episode."""


SCHEDULES: dict[str, Schedule] = {
    **{
        str(number): Schedule(
            people=setting.people,
            scenes=setting.scenes,
            days=[(day % setting.people, day // setting.people % setting.scenes) for day in range(setting.days)],
            episodes=episodes,
        )
        # PAPER §4.3, Setup: 5 humans in 2 scenes; 10 humans; 3 scenes; 9 humans
        for (number, setting), episodes in zip(SETTINGS.items(), ((5, 2), (10, 1), (1, 3), (3, 1)), strict=True)
    },
    # PAPER §4.3, generalisation: setting 3, and then a fourth person whom the robot has never met (5 new people)
    "3+1": Schedule(people=4, scenes=1, days=[*((day % 3, 0) for day in range(9)), (3, 0)], episodes=(5, 1)),
}
"""The paper's settings, and the one in which a stranger comes at the end, by name."""


class Primary(Frozen):
    """What a benchmark is to show, as its file states it beforehand.

    Attributes:
        measure: Its headline is the endpoint; `help` is need F1.
        reference: The method that others are compared with.
        against: Those others; by default all of the grid. The rest is compared too, outside of the correction.
        test: Over people, two-sided.
        correction: For several comparisons.
    """

    measure: str = "help"
    reference: str = "ours"
    against: Annotated[list[str], Field(min_length=1)] | None = None
    test: Literal["sign_flip", "t"] = "sign_flip"
    correction: Literal["holm", "none"] = "holm"


class Grid(Frozen):
    """What a benchmark covers.

    Attributes:
        methods: Names, in the order in which they are run in each life.
        settings: Names in `SCHEDULES` or `schedules`.
        collab: Collaboration types.
        seeds: How many seeds, from 0; or which.
        humans: People in the order in which they take part; a number takes so many of those there are.
        scenes: Homes, likewise.
        episodes: At most so many episodes of each setting; by default the paper's number.
        days: At most so many days of each episode.
        pairing: `every` group of people in every group of homes (the paper's), or each group of people in one of them,
            the homes `in_turn`.
        hours: Hours of each day.
        schedules: Orders of days of one's own, by name.
        with_shared: Methods that are run with shared common sense, too, as a control of how much a robot gains by
            reading the person's household file: `all`, or by default the endpoint's reference.
        noise: How often the endpoint's reference meets each life again, its models sampled anew.
        endpoint: The measure of the primary endpoint, and how methods are compared in it.
        late_days: The primary endpoint is the mean of so many of each person's last days of an episode; by default of
            the last third of them, rounded up (of 15 days the last 5).
        early_days: First and last of the days, counted from 1, that growth is measured from; late days are none.
        run: Anything else that `coopera run` takes, such as `models` or `classifier`.
    """

    methods: Annotated[list[str], Field(min_length=1)] = ["ours"]
    settings: Annotated[list[Name], Field(min_length=1)] = ["1"]
    collab: Annotated[list[Literal[1, 2]], Field(min_length=1)] = [2]
    seeds: Count | Annotated[list[Annotated[int, Field(strict=True, ge=0, lt=2**63)]], Field(min_length=1)] = 1
    humans: Annotated[list[str], Field(min_length=1)] | Count | None = None
    scenes: Annotated[list[str], Field(min_length=1)] | Count | None = None
    episodes: Count | None = None
    days: Count | None = None
    pairing: Literal["every", "in_turn"] = "every"
    hours: Annotated[int, Field(strict=True, ge=1, le=15)] = HOURS_PER_DAY
    schedules: dict[Name, Schedule] = {}
    with_shared: Literal["all"] | list[str] | None = None
    noise: Annotated[int, Field(strict=True, ge=0, le=100)] = 0
    endpoint: Primary = Primary()
    late_days: Count | None = None
    early_days: tuple[Count, Count] = (2, 5)
    run: dict[str, Any] = {}

    @property
    def seed_list(self) -> Sequence[int]:
        """The seeds themselves."""
        return self.seeds if isinstance(self.seeds, list) else range(self.seeds)

    @property
    def variants(self) -> list[Variant]:
        """What runs beside the methods; it enters no comparison of methods."""
        reference = [self.endpoint.reference] if self.endpoint.reference in self.methods else []
        chosen = {None: reference, "all": self.methods}
        shared = self.with_shared if isinstance(self.with_shared, list) else chosen[self.with_shared]
        again = [Variant(name, f"{AGAIN}{n}", n) for name in reference for n in range(1, self.noise + 1)]
        return [*(Variant(name, SHARED) for name in shared), *again]


class Variant(NamedTuple):
    """A method under another condition: with shared common sense, or with its models sampled once more."""

    method: str
    word: str
    sample: int = 0

    @property
    def name(self) -> str:
        """As the column `method` of tables has it."""
        return f"{self.method}{OF}{self.word}"


class Life(NamedTuple):
    """One episode: who lives where on which day."""

    setting: str
    collab: Literal[1, 2]
    seed: int
    episode: int
    days: list[tuple[str, str]]

    @property
    def name(self) -> str:
        """As its folder is called."""
        return f"s{self.setting}-type{self.collab}-seed{self.seed}-ep{self.episode:02d}"


def read_grid(data: Mapping[str, Any], source: str) -> Grid:
    """Check a grid as it was read from a file or from flags.

    Raises:
        ConfigError: Naming the file, the field and what was expected.
    """
    try:
        return Grid.model_validate(dict(data))
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = ".".join(str(part) for part in first["loc"] if not str(part).startswith(("list[", "constrained")))
        if first["type"] == "extra_forbidden":
            name = str(first["loc"][-1])
            known = (
                Primary.model_fields if first["loc"][0] == "endpoint" and len(first["loc"]) > 1 else Grid.model_fields
            )
            near = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise ConfigError(f"{source}: there is no field {name!r} ({hint}).") from None
        if first["type"] == "too_short":
            raise ConfigError(f"{source}: {field} is empty, so there is nothing to run.") from None
        raise ConfigError(f"{source}: {field} cannot be {first['input']!r} ({first['msg'].lower()}).") from None


def check_names(grid: Grid) -> None:
    """Refuse an endpoint and controls that this grid cannot have.

    Raises:
        ConfigError: If a measure is unknown, or methods are named that the grid has not.
    """
    stated = grid.endpoint
    if odd := [name for name in grid.methods if OF in name]:
        raise ConfigError(f"methods: {odd[0]}: the name of a method in a benchmark has no {OF}.")
    asked = grid.with_shared if isinstance(grid.with_shared, list) else []
    if odd := [name for name in asked if name not in grid.methods]:
        raise ConfigError(f"with_shared: {odd[0]} is none of the grid's methods ({', '.join(grid.methods)}).")
    find_measure(stated.measure)
    # a grid of baselines alone has nothing to compare, unless it says so
    named = [stated.reference] if "reference" in stated.model_fields_set else []
    for name in [*named, *(stated.against or [])]:
        if name not in grid.methods:
            raise ConfigError(f"endpoint: {name} is none of the grid's methods ({', '.join(grid.methods)}).")
    if stated.reference in (stated.against or []):
        raise ConfigError(f"endpoint: {stated.reference} cannot be compared with itself.")


def lives(grid: Grid, people: Sequence[str], scenes: Sequence[str]) -> list[Life]:
    """Lay out the lives of a grid, seed by seed, then episode by episode, so that an early stop leaves whole episodes.

    Args:
        grid: What is covered.
        people: Who there is, in the order in which they take part.
        scenes: Which homes there are.

    Raises:
        ConfigError: If a setting is unknown or needs more people or homes than there are.
    """
    known = {**SCHEDULES, **grid.schedules}
    found: list[tuple[int, int, int, Life]] = []
    for setting in grid.settings:
        if setting not in known:
            raise ConfigError(f"settings: there is no setting {setting!r} (known are {', '.join(known)}).")
        for place, (collab, seed) in enumerate(product(grid.collab, grid.seed_list)):
            for number, days in enumerate(_episodes(setting, known[setting], people, scenes, grid)):
                found.append((seed, number, place, Life(setting, collab, seed, number, days)))
    return [life for *_, life in sorted(found, key=lambda entry: entry[:3])]


def _episodes(
    name: str, plan: Schedule, people: Sequence[str], scenes: Sequence[str], grid: Grid
) -> Iterator[list[tuple[str, str]]]:
    if any(who >= plan.people or where >= plan.scenes or min(who, where) < 0 for who, where in plan.days):
        raise ConfigError(f"schedules.{name}: days may name people 0 to {plan.people - 1} and homes 0 to "
                          f"{plan.scenes - 1} only.")  # fmt: skip
    crowds = _groups(f"setting {name}", "people", people, plan.people, plan.episodes[0], grid.humans is not None)
    places = _groups(f"setting {name}", "homes", scenes, plan.scenes, plan.episodes[1], grid.scenes is not None)
    if grid.pairing == "in_turn":
        pairs = list(zip(crowds, cycle(places), strict=False))
    else:  # homes change slowest, so that the first episodes are of different people
        pairs = [(crowd, place) for place in places for crowd in crowds]
    for crowd, place in pairs[: grid.episodes]:
        yield [(crowd[who], place[where]) for who, where in plan.days[: grid.days]]


def _groups(setting: str, what: str, ids: Sequence[str], size: int, count: int, chosen: bool) -> list[Sequence[str]]:
    """As many whole groups as the paper has, or as the chosen ids give."""
    whole = len(ids) // size
    if not whole:
        raise ConfigError(f"{setting} needs {size} {what}, and there are {len(ids)}: {', '.join(ids) or 'none'}.")
    return [ids[n * size : (n + 1) * size] for n in range(whole if chosen else min(whole, count))]
