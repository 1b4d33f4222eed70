from __future__ import annotations

import numpy as np
import pytest

from coopera.core.people import BigFive, PersonId
from coopera.evaluation.people.lives import InferredTraits, Lives
from coopera.evaluation.people.traits import coherence, diversity, mean_sd, pearson
from tests.evaluation.people.lived import day, lives, persona


def test_mean_sd_is_as_by_hand() -> None:
    """Openness 2 and 4: mean 3, squares 1 + 1 over n - 1 = 1, SD = sqrt 2; the others do not vary: sqrt 2 / 5."""
    assert mean_sd([BigFive(openness=2), BigFive(openness=4)]) == pytest.approx(2**0.5 / 5, abs=1e-12)


def test_diversity_has_an_interval_over_people() -> None:
    who = {name: persona(name, openness=score) for name, score in (("ann", 1), ("bob", 3), ("cyd", 5))}
    (figure,) = diversity(lives([day(name, does=["rest"]) for name in who], **who))
    assert figure.value == pytest.approx(2 / 5, abs=1e-12)
    assert (figure.n, figure.low) == (3, 0)  # a resample may be three times the same person
    assert figure.high is not None
    assert figure.high >= 0.4


def test_pearson_is_as_by_hand_and_has_no_meaning_without_variation() -> None:
    """x = 1 2 3, y = 1 3 2: covariance 1, squares 2 and 2, r = 1 / 2."""
    assert pearson(np.array([1.0, 2.0, 3.0]), np.array([1.0, 3.0, 2.0])) == pytest.approx(0.5, abs=1e-12)
    assert np.isnan(pearson(np.array([1.0, 2.0]), np.array([4.0, 4.0])))


def test_robots_that_know_people_agree_with_their_own_and_not_with_the_next() -> None:
    figures = {figure.measure: figure for figure in coherence(known_people([0.0, 0.0, 0.0]))}
    assert figures["aligned"].value == pytest.approx(1, abs=1e-12)
    # true openness 1 3 5, believed of the next: 3 5 1; r = (-2·0 + 0·2 + 2·-2) / 8 = -1/2; the other step the same
    assert figures["mismatched"].value == pytest.approx(-0.5, abs=1e-12)
    assert figures["mismatched"].control == pytest.approx(-0.5, abs=1e-12)
    assert figures["aligned"].n == 3


def test_knowing_what_people_are_like_on_average_counts_only_in_the_pooled_figure() -> None:
    """Believed: the same of everybody (openness 3, agreeableness 5): no trait varies, but pooled there is a pattern."""
    same = known_people([2.0, 0.0, -2.0], agreeableness=5.0)
    figures = {figure.measure: figure for figure in coherence(same)}
    assert figures["aligned"].value is None
    assert figures["aligned, pooled"].value is not None
    assert figures["aligned, pooled"].value > 0.5


def test_what_several_robots_believe_of_a_person_is_averaged() -> None:
    who = known_people([0.0, 0.0, 0.0])
    wrong = [InferredTraits(belief.person, BigFive(openness=6 - belief.big_five.openness)) for belief in who.beliefs]
    both = Lives(who.days, who.personas, [*who.beliefs, *wrong])
    assert {f.measure: f.value for f in coherence(both)}["aligned"] is None  # they cancel: 3 for everybody


def test_without_robots_or_people_coherence_is_unmeasured_with_the_reason() -> None:
    nobody = lives([day("ann", does=["rest"])])
    assert {f.note for f in coherence(nobody)} == {"no robot in these runs has inferred traits"}
    two = known_people([0.0, 0.0])
    assert {f.note for f in coherence(two)} == {"it takes at least 3 people to correlate"}


def known_people(errors: list[float], **average: float) -> Lives:
    """People of openness 1, 3, 5 of whom robots believe that, plus an error each."""
    names = ["ann", "bob", "cyd"][: len(errors)]
    scores = [1.0, 3.0, 5.0]
    who = {n: persona(n, openness=s, **average) for n, s in zip(names, scores, strict=False)}
    found = lives([day(name, does=["rest"]) for name in names], **who)
    beliefs = [
        InferredTraits(PersonId(n), BigFive(openness=s + e, **average))
        for n, s, e in zip(names, scores, errors, strict=False)
    ]
    return Lives(found.days, found.personas, beliefs)
