from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.hour import Example
from coopera.core.people import BigFive, PersonId
from coopera.core.randomness import rng_at
from coopera.models.classifiers import Inputs
from coopera.models.classifiers.features import Similarity, centre_of, read
from coopera.models.classifiers.kernel import _ridge
from tests.models.classifiers.feedback import THINGS, WORDS, ask, days, kernel, tea_in_the_morning


def test_untrained_it_is_undecided_about_everything() -> None:
    assert kernel().probabilities([ask("drink tea", 9), ask("", 21)]) == [0.5, 0.5]


@pytest.mark.parametrize("label", [True, False])
def test_with_one_kind_of_answer_nothing_is_learned(label: bool) -> None:
    judge = kernel()
    measured = judge.train(days(lambda *_: label), seed=0)
    assert judge.probabilities([ask("drink tea", 9)]) == [0.5]
    assert measured["examples"] == 195


def test_with_one_kind_of_answer_what_was_learned_stays() -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    before = judge.probabilities([ask("drink tea", 9)])
    judge.train(days(lambda *_: True), seed=0)
    assert judge.probabilities([ask("drink tea", 9)]) == before


def test_examples_without_an_answer_teach_nothing() -> None:
    taught = days(tea_in_the_morning)
    unanswered = [e.model_copy(update={"label": None}) for e in days(lambda *_: True)]
    one, two = kernel(), kernel()
    assert one.train(taught, seed=0) == two.train([*unanswered, *taught], seed=0)
    assert one.probabilities(taught) == two.probabilities(taught)


def test_it_learns_what_is_liked_when() -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    questions = [ask(thing, hour) for thing in THINGS for hour in (9, 11, 20)]
    answers = [p >= 0.5 for p in judge.probabilities(questions)]
    assert answers == [tea_in_the_morning(q.candidate, q.hour) for q in questions]


def test_a_task_is_judged_with_its_intention() -> None:
    judge = kernel(kind="task")
    teach = [
        ask("bring the mug", hour, intention=aim, label=aim == "drink tea").model_copy(update={"day": day})
        for day in range(3)
        for hour in (9, 12, 15)
        for aim in ("drink tea", "lift weights", "wash clothes")
    ]
    judge.train(teach, seed=0)
    tea, weights = judge.probabilities(
        [ask("bring the mug", 12, intention="drink tea"), ask("bring the mug", 12, intention="lift weights")]
    )
    assert tea >= 0.5 > weights


def test_what_one_person_says_does_not_overwrite_another() -> None:
    judge = kernel()
    ann = days(lambda thing, _: thing == "drink tea", person="ann", profile="A quiet writer.")
    bob = days(lambda thing, _: thing == "lift weights", person="bob", profile="A loud sportsman.", n=5)
    judge.train([*ann, *bob], seed=0)
    who = {"ann": "A quiet writer.", "bob": "A loud sportsman."}
    answers = {
        (person, thing): judge.probabilities([ask(thing, 12, person, profile=profile)])[0] >= 0.5
        for person, profile in who.items()
        for thing in ("drink tea", "lift weights")
    }
    assert answers == {
        ("ann", "drink tea"): True,
        ("ann", "lift weights"): False,
        ("bob", "drink tea"): False,
        ("bob", "lift weights"): True,
    }


def test_a_stranger_is_taken_to_be_like_those_with_a_like_profile() -> None:
    judge = kernel()
    ann = days(lambda thing, _: thing == "drink tea", person="ann", profile="A quiet writer.")
    bob = days(lambda thing, _: thing == "lift weights", person="bob", profile="A loud sportsman.")
    judge.train([*ann, *bob], seed=0)
    tea, weights = judge.probabilities(
        [ask(thing, 12, "eve", profile="A quiet writer and poet.") for thing in ("drink tea", "lift weights")]
    )
    assert tea > weights


def test_without_traits_people_cannot_be_told_apart() -> None:
    judge = kernel(inputs=Inputs(traits=False))
    traits = BigFive(openness=5)
    ann = days(tea_in_the_morning, person="ann", profile="A quiet writer.", big_five=traits)
    judge.train([*ann, *days(lambda thing, _: thing == "wash clothes", person="bob")], seed=0)
    known, stranger = ask("drink tea", 9, "ann", profile="A quiet writer.", big_five=traits), ask("drink tea", 9, "x")
    assert len(set(judge.probabilities([known, stranger]))) == 1


def ranked(n_days: int = 3) -> list[Example]:
    """Feedback where the robot's first guess is right four times of five and nothing else tells."""
    rng = rng_at(0, "ranks")
    return [
        Example(person=PersonId("ann"), day=day, hour=hour, candidate=str(thing), rank=rank, label=rank == right)
        for day in range(n_days)
        for hour in range(9, 22)
        for right in [0 if rng.random() < 0.8 else int(rng.integers(1, 5))]
        for rank, thing in enumerate(rng.permutation(THINGS))
    ]


def test_it_learns_how_far_to_trust_the_robots_own_order() -> None:
    judge, blind = kernel(), kernel(inputs=Inputs(rank=False))
    for one in (judge, blind):
        one.train(ranked(), seed=0)
    questions = [ask(thing, 12, rank=rank) for rank, thing in enumerate(THINGS)]
    assert [p >= 0.5 for p in judge.probabilities(questions)] == [True, False, False, False, False]
    assert blind.probabilities(questions) == blind.probabilities(
        [q.model_copy(update={"rank": None}) for q in questions]
    )


def test_intentions_added_in_the_evening_do_not_loosen_the_threshold() -> None:
    told = [ask("wash clothes", hour, label=True).model_copy(update={"day": d}) for d in range(3) for hour in range(24)]
    judge = kernel()
    assert judge.train([*ranked(), *told], seed=0)["f1"] > 0.7
    answers = judge.probabilities([ask(thing, 12, rank=rank) for rank in range(5) for thing in THINGS[:4]])
    assert np.mean([p >= 0.5 for p in answers]) < 0.4


@pytest.mark.parametrize(
    ("inputs", "fields"),
    [
        (Inputs(context=False), {"intentions": ["read books"], "tasks": ["bring the mug"]}),
        (Inputs(time=False), {"hour": 21}),
    ],
)
def test_what_a_method_hides_changes_nothing(inputs: Inputs, fields: dict[str, object]) -> None:
    judge, sighted = kernel(inputs=inputs), kernel()
    taught = days(tea_in_the_morning, intentions=["wash clothes"])
    judge.train(taught, seed=0)
    sighted.train(taught, seed=0)
    plain = ask("drink tea", 9)
    pair = [plain, plain.model_copy(update=fields)]
    assert len(set(judge.probabilities(pair))) == 1
    assert len(set(sighted.probabilities(pair))) == 2


def test_the_newest_profile_stands_for_all_earlier_days() -> None:
    first_day = days(tea_in_the_morning, n=1)
    second_day = [e.model_copy(update={"day": 1, "profile": "A quiet writer."}) for e in days(tea_in_the_morning, n=1)]
    rewritten = [e.model_copy(update={"profile": "A quiet writer."}) for e in first_day]
    one, two = kernel(), kernel()
    one.train([*first_day, *second_day], seed=0)
    two.train([*rewritten, *second_day], seed=0)
    question = [ask("drink tea", 9, profile="A quiet writer.")]
    assert one.probabilities(question) == two.probabilities(question)


def test_the_order_in_which_hours_are_told_does_not_matter() -> None:
    taught = days(tea_in_the_morning)
    one, two = kernel(), kernel()
    one.train(taught, seed=0)
    two.train([*taught[100:], *taught[:100]], seed=0)
    assert one.probabilities(taught) == two.probabilities(taught)


def test_an_answer_does_not_depend_on_what_is_asked_beside_it() -> None:
    judge = kernel()
    taught = days(tea_in_the_morning)
    judge.train(taught, seed=0)
    together = judge.probabilities(taught)
    assert together == [judge.probabilities([question])[0] for question in taught]


def test_yes_is_said_to_at_least_the_share_of_true_ones_and_to_few_more() -> None:
    rng = rng_at(0, "noise")
    taught = [e.model_copy(update={"label": bool(rng.random() < 0.2)}) for e in days(tea_in_the_morning, n=5)]
    judge = kernel()
    judge.train(taught, seed=0)
    fresh = [e.model_copy(update={"day": 7, "label": None}) for e in taught[:65]]
    share = np.mean([p >= 0.5 for p in judge.probabilities(fresh)])
    assert 0.05 < share < 0.7


def test_five_thousand_examples_are_learned_with_landmarks() -> None:
    taught = [e.model_copy(update={"day": e.day}) for e in days(tea_in_the_morning, n=77)]
    assert len(taught) > 5_000
    judge = kernel()
    measured = judge.train(taught, seed=3)
    assert measured["examples"] == 5_000
    assert [p >= 0.5 for p in judge.probabilities([ask("drink tea", 9), ask("drink tea", 20)])] == [True, False]


def test_thirty_examples_are_enough_to_start() -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning)[:30], seed=0)
    assert judge.probabilities([ask("drink tea", 10)])[0] > judge.probabilities([ask("wash clothes", 10)])[0]


CHILD = """
from tests.models.classifiers.test_kernel import answers_of_a_fresh_one
print(answers_of_a_fresh_one())
"""


def answers_of_a_fresh_one() -> list[float]:
    judge = kernel()
    judge.train(days(tea_in_the_morning, profile="A quiet writer.", intentions=["read books"]), seed=5)
    return judge.probabilities([ask(thing, hour) for thing in THINGS for hour in range(9, 22)])


def test_another_process_learns_exactly_the_same() -> None:
    environment = os.environ | {"PYTHONHASHSEED": "7", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": "."}
    done = subprocess.run([sys.executable, "-c", CHILD], capture_output=True, text=True, check=True, env=environment)
    here = answers_of_a_fresh_one()
    assert done.stdout.strip() == str(here)
    assert len(set(here)) > 20


def _some_examples(seed: int, n: int) -> Sequence[Example]:
    rng = rng_at(seed, "examples")
    return [
        ask(
            str(rng.choice(THINGS)),
            int(rng.integers(0, 24)),
            str(rng.choice(["ann", "bob", "eve"])),
            intention=str(rng.choice(["", *THINGS])),
            profile=str(rng.choice(["", "Reads. Writes.", "Runs far."])),
            rank=None if rng.random() < 0.3 else int(rng.integers(0, 5)),
            big_five=None if rng.random() < 0.5 else BigFive(openness=1 + 4 * rng.random()),
            intentions=[str(thing) for thing in rng.choice(THINGS, rng.integers(0, 4))],
            tasks=[str(thing) for thing in rng.choice(THINGS, rng.integers(0, 6))],
        )
        for _ in range(n)
    ]


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), task=st.booleans())
def test_likeness_is_a_kernel(seed: int, task: bool) -> None:
    batch = read(_some_examples(seed, 20), WORDS)
    similarity = Similarity(task=task, centre=centre_of(batch))
    points = similarity.points(batch)
    gram = similarity.gram(points, points)
    assert np.allclose(gram, gram.T, atol=1e-9)
    assert np.linalg.eigvalsh(gram).min() > -1e-8


@pytest.mark.parametrize("task", [True, False])
def test_two_examples_are_as_alike_among_many_as_alone(task: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coopera.models.classifiers.features._AT_ONCE", 50)  # two rows of 25 at a time
    batch = read(_some_examples(3, 25), WORDS)
    similarity = Similarity(task=task, centre=centre_of(batch))
    gram = similarity.gram(similarity.points(batch), similarity.points(batch))
    alone = [similarity.points(batch.take(np.array([row]))) for row in range(25)]
    pairs = [[float(similarity.gram(one, other)[0, 0]) for other in alone] for one in alone]
    assert np.allclose(gram, pairs, atol=1e-9)
    assert len(np.unique(gram.round(6))) > 100


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_scores_of_what_was_left_out_equal_those_of_fits_without_it(seed: int) -> None:
    rng = rng_at(seed, "ridge")
    features, labels = rng.normal(size=(24, 30)), rng.random(24) < 0.4
    labels[:2] = True, False
    group, counts = np.repeat(np.arange(6), 4), rng.uniform(0.1, 1.0, 24)
    _, unseen = _ridge(features, labels, counts, group)
    yes = (counts * labels).sum() / counts.sum()
    importance = counts * np.where(labels, 0.5 / yes, 0.5 / (1 - yes))
    for name in range(6):
        rest, out = group != name, group == name
        weighted = features[rest].T * importance[rest]
        weights = np.linalg.solve(
            weighted @ features[rest] + 3.0 * np.eye(30), weighted @ np.where(labels[rest], 1, -1)
        )
        assert np.allclose(unseen[out], features[out] @ weights, atol=1e-8)
