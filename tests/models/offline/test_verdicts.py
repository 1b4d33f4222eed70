"""The person's yes and no in the evening, and the judge's."""

from __future__ import annotations

from typing import Any

import pytest

from coopera.models.offline.household.offers import wants
from tests.models.offline.questions import ask, person, when

BAKE = "Make a homemade treat"
MOVES = [
    {"target_id": 1, "target": "kitchen_counter_1", "in_hand": "whisk", "motion": "stir a pot"},
    {"target_id": 1, "target": "kitchen_counter_1", "in_hand": "rolling pin", "motion": "knead dough"},
]
PLACES = [{"object_id": 1, "object": "sugar_box_1", "receptacle_id": 2, "receptacle": "kitchen_counter_1"}]


def _tasks(acts: list[dict[str, Any]]) -> list[dict[str, Any]]:
    def text(act: dict[str, Any]) -> str:
        if "motion" in act:
            return f"{act['motion']} at the kitchen counter with the {act['in_hand']} in hand"
        return "put the sugar box on the kitchen counter"

    return [{"id": f"9.{i}", "thought": "", "text": text(act), "act": act} for i, act in enumerate(acts, start=2)]


def _feedback(offers: list[str], acts: list[dict[str, Any]]) -> Any:
    data = [{"thought": "", "text": text} for text in offers]
    return ask(
        "human/feedback_tasks", **when(0, 10), **person(), intention=BAKE, tasks=_tasks(acts), offers=data
    ).verdicts


def _judge(offers: list[str], acts: list[dict[str, Any]], intention: str = BAKE) -> list[bool]:
    data = [{"thought": "", "text": text} for text in offers]
    asked = {"time": "10 am", "intention": intention, "tasks": _tasks(acts), "offers": data}
    return [verdict.yes for verdict in ask("judge/tasks", **asked).verdicts]


def test_a_guess_is_right_if_it_means_what_the_person_meant_in_whichever_words() -> None:
    guesses = [BAKE, "Bake for the fun of it, with a warm heart", "Make a homemade treat today", "Take a short nap"]
    reply = ask("human/feedback_intentions", **when(0, 10), **person(), intention=BAKE, guesses=guesses)
    assert [v.yes for v in reply.verdicts] == [True, True, True, False]
    assert BAKE in reply.verdicts[3].reason


def test_a_thing_helps_if_a_task_that_is_left_needs_it_or_its_like() -> None:
    yes = [v.yes for v in _feedback(["bring the whisk", "bring the big whisk", "bring the guitar"], MOVES)]
    assert yes == [True, True, False]


def test_a_reason_names_the_task() -> None:
    helped, useless = _feedback(["bring the rolling pin", "bring the guitar"], MOVES)
    assert "knead dough at the kitchen counter" in helped.reason
    assert "no use" in useless.reason


def test_putting_a_thing_somewhere_helps_only_if_the_place_is_right_too() -> None:
    right, elsewhere = "put the sugar box on the kitchen counter", "put the sugar box on the piano"
    assert [v.yes for v in _feedback([right, elsewhere], PLACES)] == [True, False]


def test_where_nothing_is_left_nothing_helps_and_no_offers_get_no_verdicts() -> None:
    assert [v.yes for v in _feedback(["bring the whisk"], [])] == [False]
    assert _feedback([], MOVES) == []


def test_the_judge_says_yes_to_what_is_needed_and_no_to_what_is_not() -> None:
    assert _judge(["bring the whisk", "bring the guitar", "bring the phone charger"], MOVES) == [True, False, False]
    right, elsewhere = "put the sugar box on the kitchen counter", "put the sugar box on the bed"
    assert _judge([right, elsewhere], PLACES) == [True, False]


def test_the_judge_also_takes_what_serves_the_same_purpose_which_the_persons_rule_does_not() -> None:
    offers = ["bring the mixing bowl"]  # one stirs with it, as with the whisk
    assert _judge(offers, MOVES) == [True]
    assert [v.yes for v in _feedback(offers, MOVES)] == [False]
    assert _judge(offers, MOVES, intention="Take a short nap") == [False]


@pytest.mark.parametrize(
    ("text", "thing", "spot", "motion"),
    [
        ("bring the tea bag", "tea bag", None, ""),
        ("put the potted plant on the coffee table", "potted plant", "coffee table", ""),
        ("sit and read at the sofa with the book in hand", "book", "sofa", "sit and read"),
        ("sing a song", "sing a song", None, ""),
    ],
)
def test_offers_are_read_from_their_words(text: str, thing: str, spot: str | None, motion: str) -> None:
    assert wants([text]) == wants([{"text": text}])
    assert (wants([text])[0].thing, wants([text])[0].spot, wants([text])[0].motion) == (thing, spot, motion)


def test_an_act_that_is_given_counts_more_than_words() -> None:
    assert wants([{"text": "bring the tea bag", "act": {"object": "mug_2"}}])[0].thing == "mug"
