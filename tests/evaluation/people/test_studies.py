from __future__ import annotations

import pytest

from coopera.core.errors import ConfigError
from coopera.evaluation.people.studies import Answers, Key, Made, describe_traits, make_study, score_answers
from coopera.evaluation.statistics import mean_over_people
from tests.evaluation.people.lived import day, lives, persona

NAMES = ["ann", "bob", "cyd", "dan"]
KEY = Key(study="s", choices={"C1": "A", "C2": "B"}, matches={"M1": "A", "M2": "B", "M3": "C"}, people={})


def made(seed: int = 0) -> Made:
    days = [day(name, scene, n, does=[f"{name} does {scene}{n}"]) for name in NAMES for scene in "xy" for n in (0, 1)]
    found = make_study(lives(days), seed=seed)
    assert found is not None
    return found


def test_each_question_has_the_persons_own_day_among_days_of_others_in_the_same_home() -> None:
    study, key = made()
    assert len(study.choices) == len(NAMES)
    for choice in study.choices:
        person = key.people[choice.id]
        shown = {option.letter: option.hours[0].intention for option in choice.options}
        own = [letter for letter, text in shown.items() if text.startswith(person)]
        assert own == [key.choices[choice.id]]
        assert sorted(shown) == ["A", "B", "C"]
        assert len({text.split()[-1] for text in shown.values()}) == 1  # one home, one number of day
        assert choice.profile == f"I am {person}."


def test_each_description_matches_one_day_and_each_day_one_description() -> None:
    study, key = made()
    assert sorted(key.matches.values()) == ["A", "B", "C", "D"]
    shown = {one.letter: one.hours[0].intention for one in study.days}
    assert all(shown[letter].startswith(key.people[name]) for name, letter in key.matches.items())


def test_the_study_does_not_hold_its_answers_and_is_the_same_for_a_seed() -> None:
    study, key = made()
    assert made() == (study, key)
    assert made(1).study.id != study.id
    letters = {letter for seed in range(6) for letter in made(seed).key.choices.values()}
    assert letters == {"A", "B", "C"}
    assert key.study == study.id


def test_two_people_are_too_few_for_a_study() -> None:
    assert make_study(lives([day(name, does=["rest"]) for name in ("ann", "bob")])) is None


def test_scores_are_means_over_participants_of_what_they_answered() -> None:
    """p answers 1 of 2 right, q 1 of 1: mean 0.75. Matching: p 1 of 3; q nothing, so it counts neither way."""
    p = Answers(study="s", participant="p", answers={"C1": "A", "C2": "A", "M1": "A", "M2": "C", "M3": "B"})
    q = Answers(study="s", participant="q", answers={"C2": "B", "C1": ""})
    choice, match = score_answers(KEY, [p, q])
    assert (choice.value, choice.n, choice.low) == (0.75, 2, None)
    assert (match.value, match.n, match.low) == (pytest.approx(1 / 3), 1, None)
    assert (choice.paper, match.paper) == (0.764, 0.712)


def test_three_participants_have_an_interval_over_people() -> None:
    """0.5, 1 and 1 right: mean 0.8333, SD 0.2887; 4.3027 x 0.2887 / sqrt 3 = 0.7171 up, farther down by skewness."""
    given = [{"C1": "A", "C2": "A"}, {"C1": "A", "C2": "B"}, {"C2": "B"}]
    answers = [Answers(study="s", participant=str(n), answers=one) for n, one in enumerate(given)]
    choice, _ = score_answers(KEY, answers)
    assert (choice.low, choice.high) == (mean_over_people([0.5, 1, 1]).low, pytest.approx(0.8333 + 0.7171, abs=1e-3))
    assert choice.low is not None
    assert choice.low < 0.8333 - 0.7171


def test_nobodys_answers_score_nothing() -> None:
    assert [figure.value for figure in score_answers(KEY, [])] == [None, None]


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ([Answers(study="t", participant="p", answers={})], "answered study t, but the key is of s"),
        ([Answers(study="s", participant="p", answers={"C9": "A"})], "no question 'C9'"),
        ([Answers(study="s", participant="p", answers={})] * 2, "answered twice"),
    ],
)
def test_answers_that_do_not_belong_are_refused(answers: list[Answers], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        score_answers(KEY, answers)


def test_traits_are_described_in_words_with_their_scores() -> None:
    said = describe_traits(persona("ann", openness=5, conscientiousness=1, extroversion=3))
    assert said.startswith("openness very high (5.0), conscientiousness very low (1.0), extroversion middling (3.0)")
