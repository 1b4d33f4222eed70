"""From published personas to people: own words first, the rest of a life filled in, and Big Five that spread."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from coopera.core.big_five_test import ITEMS, score
from coopera.core.people import TRAITS, BigFive
from coopera.core.randomness import rng_at
from coopera.memory.embeddings import bundled
from coopera.models.offline.household.knowledge import Household, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.big_five import infer, shipped_norms, take_test
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.persona import shipped_aspects
from tests.models.offline.questions import ask

CONVERSATION = """User 1: Hello, how are you?
User 2: I am fine. I have a boat and I sail it.
User 1: That sounds fun! I work in a bakery downtown. Do you like bread?
User 2: Yes.
User 1: I am glad to hear that. I'm always happy to help you. I like to go to [place]. My sister lives in Ohio."""


def _profile(one: str, conversation: str = CONVERSATION) -> str:
    asked = {"name": "Mara", "profile_1": one, "profile_2": "I am old.\nI sail.", "conversation": conversation}
    return str(ask("persona/profile", **asked).profile)


def test_a_profile_begins_with_the_persons_own_sentences_and_facts() -> None:
    text = _profile("i love to bake\nI have two dogs.\nI love to bake")
    assert text.startswith("I love to bake. I have two dogs. I work in a bakery downtown. My sister lives in Ohio. ")


def test_a_fact_that_was_said_already_is_not_repeated() -> None:
    assert _profile("I work in a bakery downtown.", "User 1: I work in a bakery downtown now!").count("bakery") == 1


def test_a_person_who_says_nothing_is_not_made_up() -> None:
    assert _profile("", "User 2: I paint a lot these days.") == "I say nothing of myself."


def test_every_aspect_of_a_life_is_said_by_the_person_or_filled_in_once() -> None:
    own = ["I work in a bakery.", "I have two dogs."]
    text = _profile("\n".join(own), "")
    for aspect in shipped_aspects():
        filled = [one.says for one in aspect.statements if one.says in text]
        assert len(filled) == (0 if aspect.covered(own) else 1), aspect.name


def test_the_aspects_are_those_of_the_paper() -> None:
    names = {aspect.name for aspect in shipped_aspects()}
    assert {"job", "hobbies", "daily activities", "food preferences", "social life", "travel habits"} < names
    assert len(names) == len(shipped_aspects()) == 18


def test_what_the_person_dislikes_is_not_filled_in() -> None:
    text = _profile("I hate it to do yoga and stretch when I get up.\nI have two dogs.", "")
    assert "I do yoga" not in text


def test_two_people_with_the_same_notes_need_not_have_the_same_life() -> None:
    asked = {"name": "Mara", "profile_1": "I have two dogs.", "profile_2": "", "conversation": ""}
    lives = {str(ask("persona/profile", seed=seed, **asked).profile) for seed in range(5)}
    assert len(lives) == 5


def _big_five(profile: str, seed: int = 0) -> Any:
    return ask("persona/big_five", seed=seed, profile=profile).big_five


def _test(profile: str, seed: int = 0) -> Any:
    statements = [item.says for item in ITEMS]
    return score(ask("persona/big_five_test", seed=seed, profile=profile, statements=statements).answers)


@pytest.mark.parametrize("read", [_big_five, _test])
def test_an_empty_profile_is_in_the_middle_of_every_scale(read: Any) -> None:
    assert set(read("").model_dump().values()) == {3.0}


def test_readings_differ_as_attention_does() -> None:
    text = _profile("I love to bake\nI have two dogs.")
    assert len({str(_big_five(text, seed)) for seed in range(5)}) > 1
    assert _big_five(text, 1) == _big_five(text, 1)


def test_the_items_are_ten_a_trait_of_both_poles_and_every_one_has_its_norm() -> None:
    assert [sum(item.trait == trait for item in ITEMS) for trait in TRAITS] == [10] * 5
    assert {item.trait for item in ITEMS if item.sign > 0} == {item.trait for item in ITEMS if item.sign < 0}
    assert set(shipped_norms().traits) == set(TRAITS)


@pytest.fixture(scope="module")
def real() -> CommonSense:
    """Common sense of six activities with the real sentence encoder."""
    some = ("bake", "knit", "video_games", "strength", "read", "pet_play")
    activities = [shipped().activities[shipped().index[name]].model_copy(update={"follows": ()}) for name in some]
    return CommonSense(Household(looks_like=shipped().looks_like, activities=tuple(activities)), bundled())


@pytest.mark.parametrize("trait", TRAITS)
def test_with_the_real_encoder_statements_of_a_pole_move_both_readings_towards_it(
    real: CommonSense, trait: str
) -> None:
    poles = [" ".join(f"I {i.says[0].lower()}{i.says[1:]}" for i in ITEMS if i[1:] == (trait, s)) for s in (1, -1)]
    high, low = (getattr(infer(real, text, rng_at(0)).big_five, trait) for text in poles)
    assert high > 3 > low
    high, low = (getattr(score(take_test(real, text, rng_at(0)).answers), trait) for text in poles)
    assert high > low


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
    life = PrivateLife(real, profile, BigFive())
    assert int(np.argmax(life.affinity)) == real.household.index[drawn_to]
    assert life.affinity[real.household.index[not_to]] < 0.5
    assert life.evidence(real.household.activities[real.household.index[drawn_to]]) is not None


def test_with_the_real_encoder_an_aversion_draws_away(real: CommonSense) -> None:
    plain_life = PrivateLife(real, "I like tea.", BigFive())
    averse = PrivateLife(real, "I like tea. I hate reading books.", BigFive())
    read = real.household.index["read"]
    assert averse.affinity[read] < plain_life.affinity[read]


def test_with_the_real_encoder_foreign_words_are_recognised(real: CommonSense) -> None:
    assert real.recognise("Make some biscuits in the oven").activity.id == "bake"
    assert real.recognise("Finish the scarf I am making").activity.id == "knit"


@pytest.mark.parametrize(
    ("text", "activity"),
    [
        ("Wash the dishes after dinner", "dishes"),
        ("Brush my teeth before bed", "wash_up"),
        ("Look after the pets", "pet_care"),
        ("Listen to music", "listen"),
        ("Work at my job", "desk_work"),
    ],
)
def test_what_people_write_in_diaries_is_understood_whatever_meal_it_comes_after(text: str, activity: str) -> None:
    found = CommonSense(shipped(), bundled()).recognise(text)
    assert (found.activity.id, found.certainty) == (activity, 1.0)
