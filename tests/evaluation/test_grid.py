from __future__ import annotations

from collections import Counter

import pytest

from coopera.core.errors import ConfigError
from coopera.evaluation.grid import Grid, check_names, lives, read_grid

PEOPLE = [f"p{n}" for n in range(20)]
HOMES = ["a", "b", "c", "d", "e"]


def test_the_settings_have_the_papers_episodes_and_rotations() -> None:
    found = lives(Grid(settings=["1", "2", "3", "4"]), PEOPLE, HOMES)
    assert Counter(life.setting for life in found) == {"1": 10, "2": 10, "3": 3, "4": 3}
    days = {life.setting: life.days for life in reversed(found)}
    assert days["1"] == [("p0", "a")] * 5
    assert days["2"] == [("p0", home) for home in HOMES]
    assert days["3"] == [("p0", "a"), ("p1", "a"), ("p2", "a")] * 3
    assert days["4"] == [(person, home) for home in "abc" for person in ("p0", "p1", "p2")]


def test_a_stranger_comes_on_the_tenth_day() -> None:
    [first, *_] = lives(Grid(settings=["3+1"]), PEOPLE, HOMES)
    assert [who for who, _ in first.days] == ["p0", "p1", "p2"] * 3 + ["p3"]


def test_homes_in_turn_give_each_person_one_home() -> None:
    grid = read_grid({"pairing": "in_turn", "humans": ["a", "b", "c", "d"], "scenes": ["x", "y", "z"], "days": 1}, "g")
    found = lives(grid, grid.humans, grid.scenes)
    assert [life.days for life in found] == [[("a", "x")], [("b", "y")], [("c", "z")], [("d", "x")]]


def test_the_first_episodes_are_of_different_people_and_seeds_come_last() -> None:
    found = lives(Grid(settings=["1"], seeds=2, episodes=3), PEOPLE, HOMES)
    assert [(life.seed, life.days[0]) for life in found] == [
        (seed, (person, "a")) for seed in (0, 1) for person in ("p0", "p1", "p2")
    ]
    assert len({life.name for life in found}) == len(found)


def test_a_schedule_of_ones_own_is_a_setting() -> None:
    grid = read_grid(
        {"settings": ["visit"], "schedules": {"visit": {"people": 2, "scenes": 1, "days": [[1, 0], [0, 0]]}}}, "g"
    )
    assert [life.days for life in lives(grid, PEOPLE[:2], HOMES)] == [[("p1", "a"), ("p0", "a")]]
    wrong = read_grid({"settings": ["x"], "schedules": {"x": {"people": 1, "scenes": 1, "days": [[1, 0]]}}}, "g")
    with pytest.raises(ConfigError, match="people 0 to 0"):
        lives(wrong, PEOPLE, HOMES)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        ({"method": ["ours"]}, r"grid.yaml: there is no field 'method' \(did you mean methods\?\)"),
        ({"methods": []}, "grid.yaml: methods is empty, so there is nothing to run"),
        ({"settings": []}, "settings is empty"),
        ({"seeds": 0}, "seeds cannot be 0"),
        ({"collab": [3]}, "collab.0 cannot be 3"),
        ({"hours": "13"}, "hours cannot be '13'"),
    ],
)
def test_a_wrong_grid_is_refused_with_the_field(data: dict[str, object], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        read_grid(data, "grid.yaml")


def test_what_there_is_too_little_of_is_said() -> None:
    with pytest.raises(ConfigError, match="setting 2 needs 5 homes, and there are 2: a, b"):
        lives(Grid(settings=["2"]), PEOPLE, HOMES[:2])
    with pytest.raises(ConfigError, match="there is no setting '7'"):
        lives(Grid(settings=["7"]), PEOPLE, HOMES)


def test_beside_the_methods_the_reference_runs_with_shared_common_sense_and_as_often_again_as_asked() -> None:
    def names(**given: object) -> list[str]:
        return [one.name for one in read_grid({"methods": ["ours", "habit"], **given}, "g").variants]

    assert names() == ["ours+shared"]
    assert names(noise=2) == ["ours+shared", "ours+again1", "ours+again2"]
    assert names(with_shared="all", endpoint={"reference": "habit"}) == ["ours+shared", "habit+shared"]
    assert names(with_shared=[]) == []
    with pytest.raises(ConfigError, match="with_shared: oracle is none of the grid's methods"):
        check_names(read_grid({"methods": ["ours"], "with_shared": ["oracle"]}, "g"))
