"""Do days have what a day has? Meals, washing, and the dishes after dinner, as shares of days."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from coopera.core.people import PersonId
from coopera.evaluation.people.divergence import Named
from coopera.evaluation.people.figures import Figure, over_people, unmeasured
from coopera.evaluation.people.lives import LivedDay, Lives
from coopera.models.offline.household.knowledge import shipped

CHECK = "days with"
AFTER_DINNER = 2
"""Hours after dinner within which the dishes count as done after it."""
AT_HOME = 3
"""Hours away up to which a day is one at home; who is out at work has their meals there."""
ENOUGH = 3
"""People for an interval that resamples them."""

MEALS = ("breakfast", "lunch", "dinner")
_WASHING = {"wash_up", "bath"}
_DAY: dict[str, Callable[[set[str]], bool]] = {
    **{meal: lambda done, meal=meal: meal in done for meal in MEALS},  # type: ignore[misc]
    "all three meals": lambda done: done.issuperset(MEALS),
    "washing oneself": lambda done: not done.isdisjoint(_WASHING),
}


class Share(NamedTuple):
    """Of how many of one person's days something is true."""

    yes: int
    days: int


def rhythm(lives: Lives, named: Named, *, seed: int = 0) -> list[Figure]:
    """Shares of days at home with each meal, all three, washing, and of the dinners after which the dishes were done.

    A dinner in a day's last lived hour has no hour after it and is left out.

    Args:
        lives: The days; those with more than `AT_HOME` hours away do not count.
        named: An intention's text -> the id of its activity in the household file.
        seed: Of the resampling of people.
    """
    away = {activity.id for activity in shipped().activities if activity.away}
    every = [(day, [named(text) for text in day.intentions]) for day in lives.days]
    days = [(day, names) for day, names in every if sum(name in away for name in names) <= AT_HOME]
    found = {
        measure: _by_person([(day, has(set(names))) for day, names in days if names]) for measure, has in _DAY.items()
    }
    dishes = [(day, washed) for day, names in days if (washed := dishes_done(day.hours, names)) is not None]
    found[f"dishes within {AFTER_DINNER} h of dinner"] = _by_person(dishes)
    return [figure for measure, units in found.items() for figure in _figures(measure, units, seed)]


def dishes_done(hours: Sequence[int], activities: Sequence[str]) -> bool | None:
    """Whether dishes followed the day's last dinner within two hours; None without a dinner, or an hour after it."""
    dinners = [hour for hour, name in zip(hours, activities, strict=True) if name == "dinner"]
    if not dinners:
        return None
    after = {
        name for hour, name in zip(hours, activities, strict=True) if dinners[-1] < hour <= dinners[-1] + AFTER_DINNER
    }
    return "dishes" in after if after else None


def _by_person(days: Sequence[tuple[LivedDay, bool]]) -> dict[PersonId, Share]:
    found: dict[PersonId, Share] = {}
    for day, yes in days:
        before = found.get(day.person, Share(0, 0))
        found[day.person] = Share(before.yes + yes, before.days + 1)
    return found


def _share(units: Sequence[Share]) -> float:
    return sum(unit.yes for unit in units) / sum(unit.days for unit in units)


def _figures(measure: str, units: dict[PersonId, Share], seed: int) -> list[Figure]:
    if not units:
        return unmeasured(CHECK, measure, why="no day had a dinner with an hour after it")
    days = sum(unit.days for unit in units.values())
    few = len(units) < ENOUGH
    note = f"of {days} days at home" + (f"; an interval takes {ENOUGH} people" if few else "")
    figure = over_people(CHECK, measure, units, _share, chance={}, seed=seed, n=len(units), unit="people", note=note)
    return [figure.model_copy(update={"low": None, "high": None}) if few else figure]
