"""Lived hours become minutes by category, and what an hour leaves over goes to its neighbours."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from coopera.core.time_use import CATEGORIES
from coopera.evaluation.people.hours_spent import ActivityUses, recognised, spent
from coopera.models.offline.household.knowledge import SHIPPED, load
from coopera.models.offline.household.sense import CommonSense
from tests.evaluation.people.lived import day, lives
from tests.evaluation.people.tables import says
from tests.models.offline.questions import WORDS


def _minutes(*does: str, hours: list[int] | None = None) -> list[dict[str, float]]:
    """By hour, the minutes of each category that has some."""
    lived = day("ann", does=list(does))
    shares = spent(lived.model_copy(update={"hours": hours}) if hours else lived, says).shares
    rows = shares[~np.isnan(shares[:, 0])] * 60
    return [{name: round(value, 6) for name, value in zip(CATEGORIES, row, strict=True) if value} for row in rows]


def test_an_hour_that_takes_all_its_minutes_is_of_its_categories() -> None:
    assert _minutes("tv", "work") == [{"tv": 60}, {"work": 60}]


def test_what_a_lunch_leaves_over_goes_half_and_half_to_the_whole_hours_around_it() -> None:
    assert _minutes("work", "eating 30", "tv")[1] == {"work": 15, "tv": 15, "eating": 30}


def test_it_goes_to_the_one_whole_hour_beside_it_and_to_other_where_there_is_none() -> None:
    assert _minutes("eating 30", "tv")[0] == {"tv": 30, "eating": 30}
    assert _minutes("work", "eating 30", "food_prep 20")[1] == {"work": 30, "eating": 30}
    assert _minutes("eating 30", "food_prep 20") == [{"eating": 30, "other": 30}, {"food_prep": 20, "other": 40}]


def test_an_hour_that_was_not_lived_is_nobodys_neighbour() -> None:
    assert _minutes("tv", "eating 30", hours=[9, 11])[1] == {"eating": 30, "other": 30}


def test_each_hour_of_the_clock_is_counted_and_the_others_are_unknown() -> None:
    shares = spent(day("ann", number=5, does=["tv"] * 3), says)
    assert [hour for hour in range(24) if not np.isnan(shares.shares[hour]).any()] == [9, 10, 11]
    assert shares.day_type == "weekend"


def test_minutes_beyond_the_hour_are_a_fault_of_whoever_says_so() -> None:
    with pytest.raises(ValueError, match="1 to 60 minutes, not 61"):
        spent(day("ann", does=["rest"]), lambda text: {"tv": 61})


@pytest.fixture
def uses(tmp_path: Path) -> ActivityUses:
    """A household of breakfast, which takes 30 minutes, and lunch, of which nothing is said."""
    data: dict[str, Any] = json.loads(json.dumps(yaml.safe_load(SHIPPED.read_text(encoding="utf-8"))))
    data["activities"] = [dict(one, follows=[]) for one in data["activities"][:2]]
    for activity in data["activities"]:
        activity.pop("uses", None)
    data["activities"][0]["uses"] = {"eating": 20, "food_prep": 10}
    path = tmp_path / "toy.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return ActivityUses(CommonSense(load(path), WORDS))


def test_a_known_wording_counts_as_its_activity_and_another_text_as_the_nearest_one(uses: ActivityUses) -> None:
    assert uses("Put together a quick breakfast") == {"eating": 20, "food_prep": 10}
    assert uses.activity("A breakfast in the sun") == "breakfast"
    assert uses.known("Put together a quick breakfast")
    assert not uses.known("A breakfast in the sun")


def test_an_activity_that_says_nothing_of_its_hour_is_other(uses: ActivityUses) -> None:
    assert uses("lunch") == {"other": 60}


def test_how_many_hours_were_of_a_known_wording_is_a_figure(uses: ActivityUses) -> None:
    figure = recognised(lives([day("ann", does=["Put together a quick breakfast", "lunch"])]), uses)
    assert (figure.value, figure.n, figure.unit) == (0.5, 2, "hours")
