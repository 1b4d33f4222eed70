"""What raters are shown, and who rates what: hours of runs, without the method, in an order of each rater's own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, NamedTuple, TypeAlias

import numpy as np
from pydantic import Field

from coopera.core.clock import Clock
from coopera.core.errors import ConfigError
from coopera.core.hour import HourRecord, TaskCandidate
from coopera.core.people import Frozen
from coopera.core.randomness import rng_at

RaterId: TypeAlias = str
SHOWN_FRAMES = 4
WRONG = (
    "pour the soup over the books",
    "throw the shoes into the oven",
    "cut the curtains into small pieces",
    "empty the rubbish onto the bed",
    "put the phone into the full sink",
    "tip the plant over and leave it there",
)
"""Attention checks that serve nobody's intention."""


class Item(Frozen):
    """One thing to be rated: a task that a robot proposed in an hour, or an attention check.

    Attributes:
        id: Names it, and says nothing of the method.
        text: The task in words.
        places: Its places among the robot's tasks of the hour: those that say the same are rated once.
        truth: Of an attention check, what is plainly right.
    """

    id: str
    text: str
    places: list[int] = []
    truth: bool | None = None


class Unit(Frozen):
    """One hour as a rater sees it, and where it comes from, which they do not see.

    Attributes:
        id: Names it, and says nothing of the method.
        run: Which run, by its place in the plan.
        time: The hour in words.
        intention: What the person wanted, truly.
        did: What they did, in words.
        frames: Pictures, as paths in the run.
    """

    id: str
    run: int
    day: int
    hour: int
    time: str
    intention: str
    did: list[str]
    frames: list[str] = []
    items: list[Item]


class Rated(Frozen):
    """A run that is rated; `folder` is where it lies."""

    folder: str
    method: str
    setting: int
    person: str


class RatingPlan(Frozen):
    """A whole rating: what is rated, and by whom, in which order.

    `order` gives each rater the ids of their units; `tokens` the secret of each rater's own address.
    """

    version: int = 1
    seed: int
    runs: list[Rated]
    units: list[Unit]
    order: dict[RaterId, list[str]]
    tokens: dict[RaterId, Annotated[str, Field(min_length=16)]]


class Sizes(NamedTuple):
    """How much is rated: raters, raters of each hour, hours of each run (None is all), hours from check to check."""

    raters: int
    share: int = 2
    hours: int | None = None
    checks: int = 3


def plan_rating(
    runs: Sequence[tuple[Rated, Sequence[HourRecord]]],
    sizes: Sizes,
    seed: int,
    tokens: Sequence[str],
) -> RatingPlan:
    """Choose hours, put attention checks in, and give each rater as many hours as the others.

    Hours are drawn for each run. Each hour goes to `share` raters, always those who have least so far; the order of
    units, and of tasks within one, is drawn anew for each rater, so that no method comes first.

    Args:
        runs: What is rated, with its hours.
        sizes: How much.
        seed: What the draws derive from.
        tokens: A secret for each rater.

    Raises:
        ConfigError: If there is nothing to rate, or fewer raters than each hour should have.
    """
    if not 1 <= sizes.share <= sizes.raters:
        raise ConfigError(f"share: each hour can have 1 to {sizes.raters} raters, not {sizes.share}.")
    units: list[Unit] = []
    for place, (rated, hours) in enumerate(runs):
        fit = [one for one in hours if one.human and one.robot and one.robot.tasks]
        if not fit:
            raise ConfigError(f"{rated.folder}: no hour of this run has tasks of a robot to be rated.")
        chosen = sorted(rng_at(seed, "hours", place).permutation(len(fit))[: sizes.hours].tolist())
        for record in (fit[number] for number in chosen):
            units.append(_unit(place, record, rng_at(seed, "unit", place, record.day, record.hour)))
    units = _with_checks(units, sizes.checks, rng_at(seed, "checks"))
    raters = [f"rater-{number:02d}" for number in range(1, sizes.raters + 1)]
    order = _assigned([one.id for one in units], raters, sizes.share, rng_at(seed, "assignment"))
    return RatingPlan(
        seed=seed,
        runs=[rated for rated, _ in runs],
        units=units,
        order=order,
        tokens=dict(zip(raters, tokens, strict=True)),
    )


def shown_to(plan: RatingPlan, rater: RaterId) -> list[Unit]:
    """A rater's units in their order, with the tasks of each in an order of this rater's own."""
    units = {one.id: one for one in plan.units}
    found = []
    for id in plan.order[rater]:
        items = units[id].items
        turn = rng_at(plan.seed, rater, id, "items").permutation(len(items))
        found.append(units[id].model_copy(update={"items": [items[place] for place in turn]}))
    return found


def _unit(run: int, record: HourRecord, rng: np.random.Generator) -> Unit:
    assert record.human is not None
    assert record.robot is not None
    id = _name(rng)
    frames = record.robot.observation.frames
    seen = [one for one in frames if "/human-" in one] or frames
    step = max(1, len(seen) // SHOWN_FRAMES)
    return Unit(
        id=id,
        run=run,
        day=record.day,
        hour=record.hour,
        time=Clock(day=record.episode_day, hour=record.hour).label,
        intention=record.human.intention.text,
        did=[task.act.describe() for task in record.human.tasks],
        frames=seen[::step][:SHOWN_FRAMES],
        items=[
            Item(id=f"{id}-{number}", text=text, places=places)
            for number, (text, places) in enumerate(_said_once(record.robot.tasks).items())
        ],
    )


def _said_once(tasks: Sequence[TaskCandidate]) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for place, task in enumerate(tasks):
        found.setdefault(task.act.describe(), []).append(place)
    return found


def _with_checks(units: list[Unit], every: int, rng: np.random.Generator) -> list[Unit]:
    """Put an attention check into every so many units, drawn: in turns one that is right and one that is wrong."""
    if every < 1:
        return units
    chosen = rng.permutation(len(units))[: -(-len(units) // every)].tolist()
    found = list(units)
    for turn, place in enumerate(chosen):
        unit = found[place]
        right = turn % 2 == 0 and unit.did
        text = f"help you to {unit.did[0]}" if right else WRONG[int(rng.integers(len(WRONG)))]
        check = Item(id=f"{unit.id}-{len(unit.items)}", text=text, truth=bool(right))
        found[place] = unit.model_copy(update={"items": [*unit.items, check]})
    return found


def _assigned(
    units: list[str], raters: list[RaterId], share: int, rng: np.random.Generator
) -> dict[RaterId, list[str]]:
    order: dict[RaterId, list[str]] = {rater: [] for rater in raters}
    for place in rng.permutation(len(units)):
        tie = {rater: float(draw) for rater, draw in zip(raters, rng.random(len(raters)), strict=True)}
        for rater in sorted(raters, key=lambda one: (len(order[one]), tie[one]))[:share]:
            order[rater].append(units[place])
    return {rater: [given[place] for place in rng.permutation(len(given))] for rater, given in order.items()}


def _name(rng: np.random.Generator) -> str:
    return f"u{int(rng.integers(1 << 48)):012x}"
