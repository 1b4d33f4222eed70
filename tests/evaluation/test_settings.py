from __future__ import annotations

import pytest

from coopera.core.errors import ConfigError
from coopera.core.household import SceneId
from coopera.core.people import PersonId
from coopera.evaluation import SETTINGS, schedule

PEOPLE = [PersonId(name) for name in "abcdef"]
SCENES = [SceneId(name) for name in ("s1", "s2", "s3", "s4", "s5")]


def lived(setting: int, people: int, scenes: int, **options: int) -> list[str]:
    return [f"{p.person}@{p.scene}" for p in schedule(SETTINGS[setting], PEOPLE[:people], SCENES[:scenes], **options)]


def test_setting_1_stays_with_one_person_in_one_home() -> None:
    assert lived(1, 1, 1) == ["a@s1"] * 5


def test_setting_2_moves_home_every_day() -> None:
    assert lived(2, 1, 5) == ["a@s1", "a@s2", "a@s3", "a@s4", "a@s5"]


def test_setting_3_takes_people_in_turn_for_three_rounds() -> None:
    assert lived(3, 3, 1) == ["a@s1", "b@s1", "c@s1"] * 3


def test_setting_4_moves_home_after_each_round() -> None:
    assert lived(4, 3, 3) == ["a@s1", "b@s1", "c@s1", "a@s2", "b@s2", "c@s2", "a@s3", "b@s3", "c@s3"]


def test_more_people_are_further_episodes_with_days_of_their_own_calendar() -> None:
    plans = schedule(SETTINGS[1], PEOPLE[:2], SCENES[:1], days=2, hours=1)
    assert [(p.day, p.episode, p.episode_day, p.person) for p in plans] == [
        (0, 0, 0, "a"),
        (1, 0, 1, "a"),
        (2, 1, 0, "b"),
        (3, 1, 1, "b"),
    ]
    assert plans[0].hours == [9]


@pytest.mark.parametrize(("setting", "people", "scenes"), [(2, 1, 1), (3, 2, 1), (4, 3, 2), (1, 0, 1)])
def test_groups_that_are_not_full_are_refused(setting: int, people: int, scenes: int) -> None:
    with pytest.raises(ConfigError, match=f"setting {setting}"):
        lived(setting, people, scenes)
