"""Where people want their things: each in their own way, always the same, and never without reason."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from pathlib import Path
from typing import Any

import yaml

from coopera.models.offline.household.knowledge import Activity, shipped
from coopera.models.offline.household.reading import Surroundings, class_of
from coopera.models.offline.human.belongings import of_use, people_say
from tests.models.offline.lives import somebody
from tests.models.offline.questions import FIXED, MOVABLE, ask, person, when

HOME = Surroundings(FIXED)
PEOPLE = [somebody(f"I am person number {number}.") for number in range(12)]
HOUSEKEEP = 0.27
"""How often two of Housekeep's people choose the same first place for a thing in a room."""


@lru_cache(maxsize=1)
def _catalogue() -> Any:
    file = Path(__file__).parents[3] / "simulation/homes/catalogue.yaml"
    return yaml.safe_load(file.read_text(encoding="utf-8"))


def _wishes(activity: Activity) -> list[list[str]]:
    """Where each of the people wants each thing of an activity that is not only put to use."""
    theirs = [life.at_home(activity, HOME).places for life in PEOPLE]
    return [[places[i][1] for places in theirs] for i, (_, usual) in enumerate(activity.places) if not of_use(usual)]


def test_two_people_want_a_thing_at_the_same_place_as_often_as_two_of_housekeeps() -> None:
    chosen = [wished for activity in shipped().activities for wished in _wishes(activity)]
    pairs = [one == other for wished in chosen for one, other in combinations(wished, 2)]
    assert abs(sum(pairs) / len(pairs) - HOUSEKEEP) < 0.06


def test_a_person_wants_a_thing_at_the_same_place_on_every_day() -> None:
    who = person()
    found: dict[str, set[str]] = {}
    for day in range(30):
        given = {
            **when(day, 16),
            **who,
            "recalled_intentions": [],
            "recalled_tasks": [],
            "fixed": FIXED,
            "movable": MOVABLE,
        }
        reply = ask("human/tasks_type1", seed=day, **given, intention="Make a homemade treat", n_tasks=3)
        for task in reply.tasks:
            found.setdefault(class_of(task.act.object), set()).add(class_of(task.act.receptacle))
    bake = shipped().activities[shipped().index["bake"]]
    often = [thing for thing, _ in bake.places]
    assert len(found) >= 4
    assert [(thing, places) for thing, places in found.items() if len(places) > often.count(thing)] == []


def test_a_wish_is_what_people_call_right_or_what_the_household_file_has() -> None:
    for activity in shipped().activities:
        for life in PEOPLE:
            wished = life.at_home(activity, HOME).places
            assert [thing for thing, _ in wished] == [thing for thing, _ in life.own(activity).places]
            assert len(set(wished)) == len(wished)
            assert [
                p for p in wished if p[1] not in people_say().get(p[0], ()) and p not in shipped().usual_places
            ] == []


def test_what_is_put_to_use_stays_where_it_is_of_use() -> None:
    for activity in shipped().activities:
        for life in PEOPLE:
            both = zip(life.own(activity).places, life.at_home(activity, HOME).places, strict=True)
            assert [usual for usual, wished in both if of_use(usual[1]) and wished != usual] == []


def test_a_home_without_the_favourite_place_gets_the_next_one_and_the_favourite_stays_the_favourite() -> None:
    life, read = PEOPLE[0], shipped().activities[shipped().index["read"]]
    first = life.at_home(read, HOME).places[0][1]
    less = Surroundings({name: said for name, said in FIXED.items() if class_of(name) != first})
    assert life.at_home(read, less).places[0][1] != first
    assert life.at_home(read, HOME).places[0][1] == first


def test_the_table_speaks_of_things_and_places_that_homes_have_and_of_none_where_things_are_put_to_use() -> None:
    catalogue = _catalogue()
    assert set(people_say()) <= set(catalogue["movable"])
    places = {place for said in people_say().values() for place in said}
    assert places <= set(catalogue["fixed"])
    assert not any(map(of_use, places))
    assert all(weight > 0 for said in people_say().values() for weight in said.values())
