from __future__ import annotations

import numpy as np
import pytest
from langchain_core.embeddings import Embeddings

from coopera.models.learners.choices import Choices
from coopera.models.learners.places import nearest, places


class Words(Embeddings):
    """Unit vectors of the words of a text: texts are alike as they share words."""

    def __init__(self) -> None:
        self._words: dict[str, int] = {}

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [self.embed_query(text) for text in texts]

    def embed_query(self, text: str) -> list[float]:
        vector = np.zeros(200)
        for word in text.lower().split():
            vector[self._words.setdefault(word, len(self._words))] += 1
        return list(vector / np.linalg.norm(vector))


NEEDS = [f"{need} now" for need in ("thirsty", "hungry", "tired", "cold", "bored", "ill")]
THINGS = ["green tea", "dark bread", "soft pillow"]


def lived(learner: Choices, days: int, *, shift: int) -> Choices:
    for day in range(days):
        for place, need in enumerate(NEEDS):
            learner.told(f"{need} day{day}", THINGS, THINGS[(place + shift) % 3])
    return learner


def right(learner: Choices, *, shift: int) -> float:
    found = [learner.probabilities(f"{need} please", THINGS).argmax() for need in NEEDS]
    return float(np.mean([at == (place + shift) % 3 for place, at in enumerate(found)]))


def test_before_anything_was_told_all_is_equally_likely() -> None:
    assert Choices(Words()).probabilities("thirsty now", THINGS).tolist() == pytest.approx([1 / 3] * 3)
    assert Choices(Words()).probabilities("thirsty now", []).tolist() == []


def test_a_like_request_gets_what_was_chosen_and_probabilities_sum_to_one() -> None:
    learner = lived(Choices(Words()), 3, shift=0)
    assert right(learner, shift=0) == 1.0
    assert learner.probabilities("thirsty please", THINGS).sum() == pytest.approx(1.0)


def test_a_change_of_taste_is_followed_though_nobody_told_of_it() -> None:
    learner = lived(lived(Choices(Words()), 4, shift=0), 2, shift=1)
    never = lived(lived(Choices(Words(), fades=False), 4, shift=0), 2, shift=1)
    assert right(learner, shift=1) == 1.0
    assert right(never, shift=1) < 0.5


def test_nothing_is_forgotten_while_taste_stays() -> None:
    learner = lived(Choices(Words()), 6, shift=0)
    assert learner.fading.of(np.arange(36)).min() > 0.8
    assert right(learner, shift=0) == 1.0


def test_a_choice_that_was_not_to_be_had_is_refused() -> None:
    with pytest.raises(ValueError, match="'coffee' is not among the things to choose from"):
        Choices(Words()).told("thirsty", THINGS, "coffee")


SEEN = {"red wool sock": "drawer", "blue wool sock": "drawer", "red story book": "shelf", "blue story book": "shelf"}


def test_a_thing_goes_where_its_kind_went() -> None:
    assert places(SEEN, ["green wool hat", "green story tape"], Words()) == {
        "green wool hat": "drawer",
        "green story tape": "shelf",
    }


def test_things_to_be_placed_help_each_other() -> None:
    """Nothing ties a cap to the seen things but the hats that lie there with it."""
    asked = ["wool cap hat", "cap hat felt", "cap hat felt straw", "story tape", "tape story case"]
    assert places(SEEN, asked, Words())["cap hat felt straw"] == "drawer"


def test_a_thing_may_be_placed_alone_and_the_yardstick_takes_the_nearest_name() -> None:
    assert places(SEEN, ["green wool hat"], Words(), together=False) == {"green wool hat": "drawer"}
    assert nearest(SEEN, ["blue story"], Words()) == {"blue story": "shelf"}
    assert places(SEEN, [], Words()) == nearest(SEEN, [], Words()) == {}


def test_places_are_not_guessed_from_nothing() -> None:
    with pytest.raises(ValueError, match="nothing was seen"):
        places({}, ["hat"], Words())
