"""From published personas to people: nothing invented, and Big Five that spread."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.people import TRAITS, BigFive
from memory.embeddings import bundled
from models.offline.knowledge import Household, shipped
from models.offline.person import PrivateLife
from models.offline.persona import shipped_markers
from models.offline.sense import CommonSense
from tests.models.offline_questions import ask

CONVERSATION = """User 1: Hello, how are you?
User 2: I am fine. I have a boat and I sail it.
User 1: That sounds fun! I work in a bakery downtown. Do you like bread?
User 2: Yes.
User 1: I am glad to hear that. I'm always happy to help you. I like to go to [place]. My sister lives in Ohio."""


def _profile(one: str, conversation: str = CONVERSATION) -> str:
    asked = {"profile_1": one, "profile_2": "I am old.\nI sail.", "conversation": conversation}
    return str(ask("persona/profile", **asked).profile)


def test_a_profile_is_the_persons_own_sentences_and_facts_and_nothing_else() -> None:
    text = _profile("i love to bake\nI have two dogs.\nI love to bake")
    assert text == "I love to bake. I have two dogs. I work in a bakery downtown. My sister lives in Ohio."


def test_a_fact_that_was_said_already_is_not_repeated() -> None:
    assert _profile("I work in a bakery downtown.", "User 1: I work in a bakery downtown now!").count("bakery") == 1


def test_a_person_who_says_nothing_is_not_made_up() -> None:
    assert _profile("", "User 2: I paint a lot these days.") == "I say nothing of myself."


def _big_five(profile: str) -> Any:
    return ask("persona/big_five", profile=profile).big_five


def test_statements_of_a_pole_move_the_score_towards_it() -> None:
    markers = shipped_markers().markers
    for trait in TRAITS:
        for_it = " ".join(f"{m.says}." for m in markers if m.trait == trait and m.sign > 0)
        against = " ".join(f"{m.says}." for m in markers if m.trait == trait and m.sign < 0)
        assert getattr(_big_five(for_it), trait) > 3 > getattr(_big_five(against), trait)


def test_an_empty_profile_is_in_the_middle_of_every_scale() -> None:
    assert set(_big_five("").model_dump().values()) == {3.0}


def test_the_markers_are_ten_items_a_trait_of_both_poles_but_for_the_norms_of_the_test() -> None:
    markers = shipped_markers().markers
    assert [sum(m.trait == trait for m in markers) for trait in TRAITS] == [10] * 5
    assert {m.trait for m in markers if m.sign > 0} == {m.trait for m in markers if m.sign < 0} == set(TRAITS)
    assert set(shipped_markers().norms) == set(TRAITS)


@pytest.fixture(scope="module")
def real() -> CommonSense:
    """Common sense of six activities with the real sentence encoder."""
    some = ("bake", "knit", "video_games", "strength", "read", "pet_play")
    activities = [shipped().activities[shipped().index[name]].model_copy(update={"follows": ()}) for name in some]
    return CommonSense(Household(looks_like=shipped().looks_like, activities=tuple(activities)), bundled())


@pytest.mark.parametrize(
    ("profile", "drawn_to", "not_to"),
    [
        ("I love making cookies and cakes.", "bake", "strength"),
        ("Two puppies live with me.", "pet_play", "video_games"),
        ("I go to the gym four times a week.", "strength", "knit"),
        ("My father is a gamer. I devour novels.", "read", "video_games"),
    ],
)
def test_with_the_real_encoder_a_text_draws_to_what_it_speaks_of(
    real: CommonSense, profile: str, drawn_to: str, not_to: str
) -> None:
    life = PrivateLife(real, "x", profile, BigFive())
    assert int(np.argmax(life.affinity)) == real.household.index[drawn_to]
    assert life.affinity[real.household.index[not_to]] < 0.5
    assert life.evidence(real.household.activities[real.household.index[drawn_to]]) is not None


def test_with_the_real_encoder_an_aversion_draws_away(real: CommonSense) -> None:
    plain_life = PrivateLife(real, "x", "I like tea.", BigFive())
    averse = PrivateLife(real, "x", "I like tea. I hate reading books.", BigFive())
    read = real.household.index["read"]
    assert averse.affinity[read] < plain_life.affinity[read]


def test_with_the_real_encoder_foreign_words_are_recognised(real: CommonSense) -> None:
    assert real.recognise("Make some biscuits in the oven").activity.id == "bake"
    assert real.recognise("Finish the scarf I am making").activity.id == "knit"
