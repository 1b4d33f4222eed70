"""The robot's own common sense: another file than the person's, and what it does where it does not know something."""

from __future__ import annotations

from typing import Any

import pytest

from benchmarks.household_overlap import SAME
from coopera.core.asks import ASKS
from coopera.core.clock import Clock
from coopera.core.people import BigFive
from coopera.models.offline.chat import OfflineChatModel
from coopera.models.offline.household.knowledge import key, robots, shipped
from tests.models.offline.questions import FIXED, MOVABLE, ROOMS, WORDS, ask_model, memory, percept, sample, when

NOW = Clock(day=1, hour=15)
PRAYER = "Find some inner calm"
"""A wording of the person's for something that the robot's file has no word of."""


@pytest.fixture(scope="module")
def robot() -> OfflineChatModel:
    return OfflineChatModel(role="robot", embeddings=WORDS)


def _imagined(robot: OfflineChatModel, **changed: Any) -> list[str]:
    nothing = {"big_five": None, "profile": None, "recalled_intentions": [], "recalled_tasks": [], "first_task": None}
    seen = percept(room="living room")
    given = {**when(1, 15), **nothing, "rooms": ROOMS, "percept": seen, "n_intentions": 5, **changed}
    return [item.intention for item in ask_model(robot, "robot/intentions", **given).intentions]


def test_the_two_files_have_no_id_no_wording_and_no_statement_in_common() -> None:
    mine, theirs = shipped(), robots()
    assert not set(mine.index) & set(theirs.index)
    said = [{key(text) for a in one.activities for text in (*a.wordings, a.statement)} for one in (mine, theirs)]
    assert not said[0] & said[1]


def test_each_file_has_activities_that_the_other_lacks_and_cuts_the_day_elsewhere() -> None:
    assert set(SAME) == set(shipped().index)
    named = [id for ids in SAME.values() for id in ids]
    assert set(named) <= set(robots().index)
    assert sum(not ids for ids in SAME.values()) >= 8
    assert len(set(robots().index) - set(named)) >= 3
    assert any(len(ids) > 1 for ids in SAME.values())
    assert any(named.count(id) > 1 for id in named)


def test_some_half_of_the_persons_things_stand_in_the_robots_activity_and_others_that_nobody_uses() -> None:
    known = robots()
    pairs = [
        (set(mine.things), {thing for id in SAME[mine.id] for thing in known.activities[known.index[id]].things})
        for mine in shipped().activities
        if SAME[mine.id]
    ]
    same = sum(len(mine & theirs) for mine, theirs in pairs) / sum(len(mine) for mine, _ in pairs)
    assert 0.15 < same < 0.5  # in the very same words; by meaning it is more (benchmarks/household_overlap.py)
    assert all(theirs - mine for mine, theirs in pairs)


def test_every_hour_offers_the_robot_many_activities_and_an_average_person_is_drawn_to_none() -> None:
    known = robots()
    assert 35 <= len(known.activities) <= 42
    for hour in range(13):
        assert sum(activity.hours[hour] >= 0.5 for activity in known.activities) >= 10
    assert not known.trait_pull(BigFive()).any()


@pytest.mark.parametrize("prompt", sorted(name for name, spec in ASKS.items() if spec.role != "human"))
def test_robot_and_judge_answer_every_prompt_with_their_own_household(prompt: str) -> None:
    chat = OfflineChatModel(role=ASKS[prompt].role, embeddings=WORDS)
    ask_model(chat, prompt, **sample(prompt))


def test_it_speaks_in_its_own_words_until_it_is_told_the_persons(robot: OfflineChatModel) -> None:
    known = {wording for activity in robots().activities for wording in activity.wordings}
    assert set(_imagined(robot)) <= known
    told = [memory("Read a story of a good person", 0, 15, NOW)]
    assert told[0]["text"] in _imagined(robot, recalled_intentions=told)


def test_what_its_household_does_not_know_is_imagined_in_the_persons_own_words(robot: OfflineChatModel) -> None:
    at_this_hour, at_night = (memory(PRAYER, 0, hour, NOW) for hour in (15, 21))
    assert PRAYER in _imagined(robot, recalled_intentions=[at_this_hour], n_intentions=8)
    assert PRAYER not in _imagined(robot, recalled_intentions=[at_night], n_intentions=5)
    assert _imagined(robot, recalled_intentions=[at_this_hour] * 3)[0] == PRAYER
    today = memory(PRAYER, 1, 14, NOW)
    assert PRAYER not in _imagined(robot, recalled_intentions=[today])


def test_nothing_is_concluded_about_a_person_from_what_it_does_not_know(robot: OfflineChatModel) -> None:
    lived = [memory(PRAYER, 0, 9, Clock(day=0, hour=21))]
    found = ask_model(robot, "robot/traits", intentions=lived, tasks=[], profile=None, evening=True)
    assert found.big_five == BigFive()
    assert "Nothing is known of what this person does." in found.profile


def _asked_for(robot: OfflineChatModel, prompt: str, intention: str, **changed: Any) -> Any:
    nothing = {"big_five": None, "profile": None, "recalled_intentions": [], "recalled_tasks": []}
    return ask_model(robot, prompt, **{**when(1, 15), **nothing, "fixed": FIXED, "intention": intention, **changed})


def test_it_offers_a_thing_that_it_was_told_of_though_its_household_has_it_not(robot: OfflineChatModel) -> None:
    told = {
        "recalled_intentions": [memory(PRAYER, 0, 15, NOW)],
        "recalled_tasks": [memory("meditate at the rug with the singing bowl in hand", 0, 15, NOW)],
    }

    def offered(intention: str, **given: Any) -> list[str]:
        found = _asked_for(robot, "robot/tasks_type2", intention, n_tasks=5, **given)
        return [draft.act.object for draft in found.tasks]

    assert "singing bowl" not in offered(PRAYER)
    assert "singing bowl" in offered(PRAYER, **told)
    assert "singing bowl" not in offered("Water the houseplants", **told)
    elsewhen = {**told, "recalled_intentions": [memory(PRAYER, 0, 20, NOW)]}
    assert "singing bowl" not in offered(PRAYER, **elsewhen)


def test_it_puts_a_thing_where_it_was_told_though_its_household_knows_no_such_place(robot: OfflineChatModel) -> None:
    told = {
        "recalled_intentions": [memory(PRAYER, 0, 15, NOW)],
        "recalled_tasks": [memory("put the candle on the rug", 0, 15, NOW)],
    }

    def offered(**given: Any) -> list[str]:
        more = {"movable": MOVABLE, "first_task": None, "n_tasks": 3}
        found = _asked_for(robot, "robot/tasks_type1", PRAYER, **more, **given)
        return [draft.act.describe() for draft in found.tasks]

    assert "put the candle on the rug" not in offered()
    assert "put the candle on the rug" in offered(**told)
