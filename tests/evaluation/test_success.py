from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.affordances import Relation
from coopera.core.errors import ModelOutputError
from coopera.core.hour import Intention, Task, TaskCandidate
from coopera.core.household import FreeMotion, HandOver, Outcome, PickPlace
from coopera.core.randomness import Address
from coopera.core.success import Counts, Help
from coopera.evaluation import Measure, count, pool
from coopera.evaluation.predicate import Predicate
from tests.fakes import FakeHome, LetterEmbeddings, ScriptedAsk

AT = Address("mara", 0, 9, "score")


def test_f1_is_counted_over_the_superset_as_by_hand() -> None:
    """Accepted: yes yes yes yes no no; correct: yes yes yes no yes no. tp 3, fp 1, fn 1, tn 1; F1 = 6 / 8."""
    counts = count([True] * 4 + [False] * 2, [True, True, True, False, True, False])
    assert counts == Counts(tp=3, fp=1, fn=1, tn=1, f1=0.75, precision=0.75, recall=0.75)


def test_unscored_candidates_are_counted_apart() -> None:
    assert count([True, True, False], [None, True, None]) == Counts(tp=1, unscored=2, f1=1, precision=1, recall=1)


def test_rejecting_everything_when_nothing_was_right_has_no_f1() -> None:
    assert count([False, False], [False, False]) == Counts(tn=2)
    assert count([], []) == Counts()


def test_accepting_only_wrong_things_is_zero_and_not_undefined() -> None:
    assert count([True], [False]) == Counts(fp=1, f1=0, precision=0)


def test_hours_are_pooled_by_their_candidates() -> None:
    """tp 1 of 1 accepted, and fp 3: pooled F1 = 2 / (2 + 3) = 0.4, not the mean of 1 and 0."""
    pooled = pool([count([True], [True]), count([True] * 3, [False] * 3)])
    assert pooled.f1 == pytest.approx(0.4, abs=1e-12)


@given(st.lists(st.tuples(st.booleans(), st.one_of(st.none(), st.booleans()))))
def test_every_candidate_is_counted_once(pairs: list[tuple[bool, bool | None]]) -> None:
    counts = count([a for a, _ in pairs], [c for _, c in pairs])
    assert counts.tp + counts.fp + counts.fn + counts.tn + counts.unscored == len(pairs)
    assert counts.f1 is None or 0 <= counts.f1 <= 1


def test_type_1_matches_by_class_and_not_by_instance() -> None:
    predicate = Predicate(LetterEmbeddings())
    task = Task(id="9.2", thought="", act=place("mug_1", "desk_1"))
    assert predicate.matches(FakeHome(), candidate(place("mug_2", "desk_1")), [task])
    assert not predicate.matches(FakeHome(), candidate(place("mug_2", "sofa_1")), [task])
    assert not predicate.matches(FakeHome(), candidate(place("book_1", "desk_1")), [task])


def test_type_1_tells_apart_what_is_put_on_and_what_is_put_inside() -> None:
    predicate = Predicate(LetterEmbeddings())
    task = Task(id="9.2", thought="", act=place("plate_1", "dishwasher_1", "inside"))
    assert predicate.matches(FakeHome(), candidate(place("plate_2", "dishwasher_1", "inside")), [task])
    assert not predicate.matches(FakeHome(), candidate(place("plate_2", "dishwasher_1")), [task])


def test_type_2_matches_a_thing_as_near_as_the_threshold() -> None:
    predicate = Predicate(LetterEmbeddings())
    task = Task(id="9.2", thought="", act=FreeMotion(target_id=1, target="desk_1", in_hand="novel", motion="read"))
    assert predicate.matches(FakeHome(), candidate(HandOver(object="Novel_1")), [task])
    assert predicate.matches(FakeHome(), candidate(HandOver(object="novels")), [task])
    assert not predicate.matches(FakeHome(), candidate(HandOver(object="hat")), [task])


def test_an_unreadable_judge_leaves_candidates_unscored_and_never_wrong() -> None:
    def garbled(_: dict[str, Any]) -> dict[str, Any]:
        raise ModelOutputError("judge/tasks", "???", "not JSON")

    measure = Measure(ScriptedAsk({"judge/tasks": garbled}), LetterEmbeddings())
    _, success = measure(FakeHome(), AT, Intention(text="Read"), [], [candidate(HandOver(object="novel"))])
    assert success.judge == Counts(unscored=1, verdicts=[None])
    assert success.predicate == Counts(fp=1, f1=0, precision=0, verdicts=[False])


def test_a_judge_that_answers_another_number_of_questions_is_unreadable() -> None:
    measure = Measure(ScriptedAsk({"judge/tasks": lambda v: {"verdicts": [{"yes": True}] * 3}}), LetterEmbeddings())
    _, success = measure(FakeHome(), AT, Intention(text="Read"), [], [candidate(HandOver(object="novel"))])
    assert success.judge.unscored == 1


def test_what_was_done_is_measured_against_the_persons_tasks_and_not_against_the_superset() -> None:
    """Two tasks remain; the one thing brought helps one of them: help 1 of 2, where F1 over the superset is 1."""
    measure = Measure(ScriptedAsk({"judge/tasks": lambda v: {"verdicts": [{"yes": True}]}}), LetterEmbeddings())
    tasks = [
        Task(id=f"9.{n}", thought="", act=FreeMotion(target_id=1, target="desk_1", in_hand=thing, motion="use"))
        for n, thing in ((2, "novel"), (3, "hat"))
    ]
    brought = candidate(HandOver(object="novel"))
    outcome = Outcome(agent="robot", act=brought.act, ok=True, metres=4)
    _, success = measure(FakeHome(), AT, Intention(text="Read"), tasks, [brought], [outcome])
    assert success.predicate.f1 == 1
    assert success.help == Help(remaining=2, helped=1, accepted=1, done=1, metres=4, saved_metres=4)


def place(thing: str, receptacle: str, relation: Relation = "on") -> PickPlace:
    return PickPlace(object_id=0, object=thing, receptacle_id=0, receptacle=receptacle, relation=relation)


def candidate(act: PickPlace | HandOver) -> TaskCandidate:
    return TaskCandidate(intention="Read", thought="", act=act, accepted=True)
