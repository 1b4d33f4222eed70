"""The four settings (PAPER §3.1): who lives where on which day, as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import TypeVar

from coopera.core.clock import FIRST_HOUR, HOURS_PER_DAY
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan
from coopera.core.household import Collab, SceneId
from coopera.core.people import PersonId

Id = TypeVar("Id", bound=str)


@dataclass(frozen=True, slots=True)
class Setting:
    """One setting. An episode takes `people` persons and `scenes` homes; several groups are several episodes.

    Attributes:
        days: The paper's number of days.
        people: How many people an episode rotates through, one a day.
        scenes: How many homes an episode rotates through.
    """

    number: int
    title: str
    days: int
    people: int
    scenes: int


SETTINGS: dict[int, Setting] = {
    setting.number: setting
    for setting in (
        Setting(1, "same human, same scene", days=5, people=1, scenes=1),
        Setting(2, "same human, a new scene each day", days=5, people=1, scenes=5),
        Setting(3, "different humans in turn, same scene", days=9, people=3, scenes=1),
        Setting(4, "different humans in turn, a new scene each round", days=9, people=3, scenes=3),
    )
}
"""All settings by number."""


def schedule(
    setting: Setting,
    people: Sequence[PersonId],
    scenes: Sequence[SceneId],
    *,
    days: int | None = None,
    hours: int = HOURS_PER_DAY,
    collab: Collab = 2,
) -> list[DayPlan]:
    """Lay out the days of a run.

    People and scenes are taken in groups of the sizes that the setting needs, and each pair of groups is one
    episode of `days` days (default: the paper's). Within an episode people change daily and the home changes
    after each round of its people (with one person: daily), in turn.

    Raises:
        ConfigError: If people or scenes do not fill whole groups.
    """
    people_groups = _groups("humans", people, setting.people, setting)
    scene_groups = _groups("scenes", scenes, setting.scenes, setting)
    groups = list(product(people_groups, scene_groups))
    length = setting.days if days is None else days
    return [
        DayPlan(
            day=episode * length + day,
            episode=episode,
            episode_day=day,
            person=who[day % len(who)],
            scene=where[day // len(who) % len(where)],
            hours=[FIRST_HOUR + n for n in range(hours)],
            collab=collab,
        )
        for episode, (who, where) in enumerate(groups)
        for day in range(length)
    ]


def episode(
    visits: Sequence[tuple[PersonId, SceneId]], hours: int = HOURS_PER_DAY, collab: Collab = 2
) -> list[DayPlan]:
    """Lay out one episode with a person and a home for each of its days."""
    return [
        DayPlan(
            day=day,
            episode_day=day,
            person=person,
            scene=scene,
            hours=[FIRST_HOUR + n for n in range(hours)],
            collab=collab,
        )
        for day, (person, scene) in enumerate(visits)
    ]


def _groups(field: str, ids: Sequence[Id], size: int, setting: Setting) -> list[list[Id]]:
    if not ids or len(ids) % size:
        raise ConfigError(
            f"{field}: setting {setting.number} ({setting.title}) takes {size} or a multiple of it, not {len(ids)}"
        )
    return [list(ids[start : start + size]) for start in range(0, len(ids), size)]
