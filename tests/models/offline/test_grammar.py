"""Wordings with alternatives: what they stand for, what is refused, and how a wording is found within a touch."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.models.offline.household.grammar import MOST, cores, parse
from coopera.models.offline.household.knowledge import key, shipped


def test_a_template_stands_for_each_choice_of_its_alternatives() -> None:
    template = parse("{Have|Enjoy} a {quiet|slow|} meal")
    assert template.count == 6
    assert list(template.expansions()) == [
        "Have a quiet meal",
        "Have a slow meal",
        "Have a meal",
        "Enjoy a quiet meal",
        "Enjoy a slow meal",
        "Enjoy a meal",
    ]
    assert template.canonical == "Have a quiet meal"
    assert template.filled([1, 0, 2, 0]) == "Enjoy a meal"


@pytest.mark.parametrize("text", ["Cook  a meal", "cook | eat", "Read, then rest", "éat"])
def test_a_wording_without_braces_stands_for_itself(text: str) -> None:
    assert list(parse(text).expansions()) == [text] == [parse(text).canonical]


def test_empty_alternatives_leave_no_gap_and_the_first_letter_stays_a_capital() -> None:
    assert list(parse("{slowly |}rest {a little|}, in bed").expansions()) == [
        "Slowly rest a little, in bed",
        "Slowly rest, in bed",
        "Rest a little, in bed",
        "Rest, in bed",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{Have|Enjoy a meal", "without its partner"),
        ("Have|Enjoy} a meal", "without its partner"),
        ("{Have|{Enjoy|Eat}} a meal", "cannot stand in alternatives"),
        ("Have a {} meal", "nothing in them"),
        ("Have a {| |} meal", "nothing in them"),
        ("{a|b|c|d|e|f|g|h} " * 3, f"512 expansions: at most {MOST}"),
        ("{Eat|Rest}" + " well" * 40, "203 characters: 2 to 200"),
        ("{Eat|E}", "1 characters"),
        ("", "0 characters"),
    ],
)
def test_a_template_that_cannot_be_meant_is_refused_in_one_sentence(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        parse(text)


_WORDS = st.text("abcde ", min_size=1, max_size=4)


@given(st.lists(st.lists(_WORDS, min_size=1, max_size=3), min_size=1, max_size=4))
def test_expansions_are_as_many_as_counted_and_the_canonical_one_comes_first(slots: list[list[str]]) -> None:
    told = "Go " + " ".join("{" + "|".join(["on", *slot]) + "}" for slot in slots)
    texts = list(parse(told).expansions())
    assert len(texts) == parse(told).count
    assert texts[0] == parse(told).canonical


def test_a_text_is_sought_whole_and_then_part_by_part_the_longest_first() -> None:
    assert list(cores("Carry on: take a nap, at ease")) == [
        "Carry on: take a nap, at ease",
        "Carry on: take a nap",
        "take a nap, at ease",
        "Carry on",
        "take a nap",
        "at ease",
    ]
    assert list(cores("Take a nap")) == ["Take a nap"]
    assert len(list(cores("," * 10_000))) < 50


@pytest.mark.parametrize(
    "text",
    [
        "Take a short nap",
        "take a short nap.",
        "Carry on: Take a short nap",
        "Carry on: for a change, take a short nap, at ease",
        "Take a short nap, then see",
        "Well — take a short nap",
    ],
)
def test_a_wording_is_known_with_a_touch_around_it(text: str) -> None:
    named = shipped().named(text)
    assert named is not None
    assert named.id == "nap"


@pytest.mark.parametrize(
    "text", ["Take a short nap today", "Put the child down to take a short nap", "", ",", "Carry on:"]
)
def test_a_wording_within_other_words_is_not_taken_for_certain(text: str) -> None:
    assert shipped().named(text) is None


def test_every_way_of_putting_an_intention_is_known_and_each_names_one_activity() -> None:
    said = [(key(text), activity.id) for activity in shipped().activities for text in activity.expansions()]
    assert len(dict(said)) == len(said)
    assert {text: activity.id for text, activity in shipped().by_wording.items()} == dict(said)
