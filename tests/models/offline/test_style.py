"""How people put things: alike from day to day, unlike each other, and always so that it is understood."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache, partial

import numpy as np
import pytest

from coopera.core.people import BigFive
from coopera.core.randomness import rng_at
from coopera.models.offline.household.grammar import cores
from coopera.models.offline.household.knowledge import Activity, key, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.style import _TOUCHES, GAP, Style
from tests.models.offline.questions import WORDS

ACTIVITIES = shipped().activities


def _style(name: str, **traits: float) -> Style:
    return Style(partial(rng_at, 0, name), BigFive(**traits))


@lru_cache(maxsize=100)
def _said(name: str, n: int = 4, **traits: float) -> tuple[tuple[str, str], ...]:
    """What somebody says of each activity, n times: activity and text."""
    style, rng = _style(name, **traits), np.random.default_rng(7)
    return tuple((activity.id, style.word(activity, rng)) for activity in ACTIVITIES for _ in range(n))


def _core(text: str) -> str:
    return next(key(core) for core in cores(text) if key(core) in shipped().by_wording)


def _share_of_touches(*lives: tuple[tuple[str, str], ...]) -> float:
    return float(np.mean([key(text) not in shipped().by_wording for life in lives for _, text in life]))


def test_whatever_is_said_is_understood_for_certain_with_a_capital_and_no_full_stop() -> None:
    sense = CommonSense(shipped(), WORDS)
    for name, trait in (("ada", 1.0), ("bo", 3.0), ("cy", 5.0)):
        said = _said(name, openness=trait, conscientiousness=trait, extroversion=trait, neuroticism=trait)
        for activity, text in said:
            known = sense.recognise(text)
            assert (known.activity.id, known.certainty) == (activity, 1.0)
            assert sense.recognise(f"Carry on: {text}").activity.id == activity
            assert text[0].isupper()
            assert not text.endswith((".", " ", ","))
            assert GAP not in text
            assert len(text) <= 200


def test_the_same_person_says_the_same_and_another_one_something_else() -> None:
    assert _said("ada") == _said.__wrapped__("ada")
    assert sum(a != b for a, b in zip(_said("ada"), _said("bo"), strict=True)) > 150


def test_a_person_repeats_their_own_words_more_than_others_repeat_them() -> None:
    lives = [Counter((activity, _core(text)) for activity, text in _said(name, 6)) for name in "abcdefgh"]
    again = [sum(n * (n - 1) / 2 for n in life.values()) / (len(ACTIVITIES) * 15) for life in lives]
    met = [
        sum(n * other[said] for said, n in life.items()) / (len(ACTIVITIES) * 36)
        for i, life in enumerate(lives)
        for other in lives[:i]
    ]
    assert np.mean(again) > 3 * np.mean(met)


def test_a_life_is_put_in_hundreds_of_ways() -> None:
    assert len({text for name in "abcdefgh" for _, text in _said(name)}) > 800


def test_a_favourite_turn_of_phrase_is_favoured_in_every_activity() -> None:
    def enjoys(name: str, half: int) -> float:
        style = _style(name)
        offered = [
            float(weights[piece.index("Enjoy")])
            for activity in ACTIVITIES[half::2]
            for template, pieces in zip(activity.templates, style._favour(activity).pieces, strict=True)
            for piece, weights in zip(template.pieces, pieces, strict=True)
            if "Enjoy" in piece
        ]
        return float(np.mean(offered))

    people = [f"person {i}" for i in range(20)]
    assert np.corrcoef([[enjoys(name, half) for name in people] for half in (0, 1)])[0, 1] > 0.5


def test_open_people_choose_rarer_alternatives() -> None:
    def place(openness: float) -> float:
        places = []
        for name in "abcdefgh":
            style = _style(name, openness=openness)
            for activity in ACTIVITIES:
                for piece in (p for pieces in style._favour(activity).pieces for p in pieces if len(p) > 1):
                    places.append(float(piece @ np.arange(len(piece))) / (len(piece) - 1))
        return float(np.mean(places))

    assert place(1.5) + 0.05 < place(3.0) < place(4.5) - 0.05


def test_conscientious_people_are_steadier_in_their_words() -> None:
    def different(conscientiousness: float) -> int:
        return sum(
            len({(activity, _core(text)) for activity, text in _said(name, 10, conscientiousness=conscientiousness)})
            for name in "abcdef"
        )

    assert different(5.0) < 0.9 * different(1.0)


def test_extroverted_people_say_more_and_add_more_touches() -> None:
    def lives(extroversion: float) -> list[tuple[tuple[str, str], ...]]:
        return [_said(name, 6, extroversion=extroversion) for name in "abcdef"]

    words = [np.mean([len(_core(text).split()) for life in lives(e) for _, text in life]) for e in (1.0, 5.0)]
    assert words[0] + 0.2 < words[1]
    assert _share_of_touches(*lives(1.0)) + 0.1 < _share_of_touches(*lives(5.0))


@pytest.mark.parametrize(("trait", "way"), _TOUCHES)
def test_a_touch_speaks_of_a_trait_that_stands_out(trait: str, way: int) -> None:
    texts = [text for name in "abc" for _, text in _said(name, 10, **{trait: 3.0 + 2.0 * way})]
    assert all(any(_stands_in(frame, text) for text in texts) for frame in _TOUCHES[trait, way])
    assert sum(_stands_in(frame, text) for text in texts for frame in _TOUCHES[trait, way]) > 200
    assert not any(_stands_in(frame, text) for text in texts for frame in _TOUCHES[trait, -way])


def _stands_in(frame: str, text: str) -> bool:
    before, after = frame.split(GAP)
    return text.startswith(before) and text.endswith(after)


def test_there_are_several_touches_before_and_after_for_each_trait_and_none_is_a_wording() -> None:
    assert len(_TOUCHES) == 10
    for frames in _TOUCHES.values():
        assert len(set(frames)) >= 6
        assert 2 <= sum(frame.startswith(f"{GAP}, ") for frame in frames) <= len(frames) - 2
        for frame in frames:
            assert frame.startswith(f"{GAP}, ") or frame.endswith((f", {GAP}", f": {GAP}"))
            assert frame.count(GAP) == 1
            assert key(frame) not in shipped().by_wording
    assert len({frame for frames in _TOUCHES.values() for frame in frames}) == sum(map(len, _TOUCHES.values()))


def _own(*wordings: str) -> Activity:
    return Activity.model_validate({**shipped().activities[0].model_dump(), "wordings": wordings})


def test_a_touch_that_would_be_too_long_is_left_out() -> None:
    long = "Walk " + "on and on " * 19 + "today"
    rng = np.random.default_rng(0)
    style = _style("ada", extroversion=5.0)
    assert {style.word(_own(long, long.lower()), rng) for _ in range(60)} == {long}


def test_a_wording_of_ones_own_keeps_its_capitals_and_loses_its_full_stop() -> None:
    rng = np.random.default_rng(0)
    texts = {
        _style("ada", extroversion=5.0).word(_own("DIY in the shed.", "DIY in the garage."), rng) for _ in range(60)
    }
    assert len(texts) > 6
    assert all("DIY in the " in text and not text.endswith(".") and "shed." not in text for text in texts)
