from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.hour import FeedbackItem, HourRecord, ModelCall, Observation, RobotHour
from coopera.core.household import HandOver, Outcome, SceneId
from coopera.core.people import PersonId
from coopera.core.success import Counts, Help
from coopera.evaluation.agreement import l1
from coopera.evaluation.counts import pool
from coopera.evaluation.latency import robot_seconds
from coopera.evaluation.measures.help import Need, false_help, help_given, need, pool_help
from coopera.evaluation.measures.people import by_person


def done(metres: float = 2.0, *, ok: bool = True) -> Outcome:
    return Outcome(agent="robot", act=HandOver(object="cup"), ok=ok, metres=metres)


def test_help_is_counted_as_by_hand() -> None:
    """Four tasks remain. Act 1 (3 m) helps tasks 1 and 2; act 2 (5 m) helps nothing; act 3 (2 m) fails.

    One of three accepted acts helped: precision 1/3. Two of four tasks were helped: recall 1/2. F1 = 2/6 / (5/6) = 0.4.
    Two were done, one of them useless; driven 10 m, of which 3 m saved the person something.
    """
    rows = [[True, True, False, False], [False] * 4, [False, False, True, False]]
    given = help_given([done(3), done(5), done(2, ok=False)], rows, remaining=4)
    assert given == Help(remaining=4, helped=2, accepted=3, done=2, useless=1, metres=10, saved_metres=3)
    assert need(given) == pytest.approx((1 / 3, 1 / 2, 0.4))
    assert false_help(given, hours=1) == 1


def test_a_second_act_for_the_same_task_saves_nothing_and_is_not_false() -> None:
    given = help_given([done(3), done(4)], [[True], [True]], remaining=1)
    assert (given.helped, given.useless, given.saved_metres) == (1, 0, 3)


def test_a_robot_that_proposed_nothing_has_need_f1_zero_where_the_papers_f1_has_no_meaning() -> None:
    assert need(help_given([], [], remaining=4)) == Need(None, 0, 0)
    assert need(help_given([done()], [[False] * 4], remaining=4)) == Need(0, 0, 0)


def test_where_no_task_remained_there_is_no_score() -> None:
    given = help_given([done()], [[]], remaining=0)
    assert need(given) == Need(0, None, None)
    assert given.useless == 1


def test_without_a_scored_hour_there_is_no_rate_of_false_help() -> None:
    assert false_help(pool_help([]), hours=0) is None
    assert need(pool_help([])) == Need(None, None, None)


def test_hours_are_pooled_before_the_rate_is_taken() -> None:
    """1 of 1 and 0 of 3 tasks helped: 1 / 4, not the mean of 1 and 0; 1 of 3 accepted acts helped; F1 = 2/12 / (7/12).

    Two useless acts in two hours: 1 per hour.
    """
    hours = [
        Help(remaining=1, helped=1, accepted=1, done=1),
        Help(remaining=3, accepted=2, done=2, useless=2, metres=1.5),
    ]
    assert need(pool_help(hours)) == pytest.approx((1 / 3, 1 / 4, 2 / 7))
    assert false_help(pool_help(hours), len(hours)) == 1
    assert pool_help(hours).metres == 1.5


@given(st.lists(st.tuples(st.booleans(), st.lists(st.booleans(), min_size=3, max_size=3)), max_size=6))
def test_help_never_counts_a_task_or_an_act_twice(acts: list[tuple[bool, list[bool]]]) -> None:
    given = help_given([done(1, ok=ok) for ok, _ in acts], [row for _, row in acts], remaining=3)
    assert given.helped <= 3
    assert given.useless <= given.done <= len(acts)
    assert given.saved_metres <= given.metres
    assert all(0 <= value <= 1 for value in need(given) if value is not None)
    assert (given.helped == 0) == (given.saved_metres == 0)


def test_the_persons_own_answers_are_counted_task_by_task() -> None:
    """Accepted and helpful, accepted and not, declined and helpful, unreadable; the intention is not a task."""
    items = [said("cup", True, True), said("hat", True, False), said("pen", False, True), said("jar", True, None)]
    items.append(said("Cook", True, True).model_copy(update={"kind": "intention"}))
    found = by_person(items)
    assert found.verdicts == [True, False, True, None]
    assert pool([found]) == Counts(tp=1, fp=1, fn=1, unscored=1, f1=0.5, precision=0.5, recall=0.5)


def test_what_the_person_meant_counts_and_not_their_slip() -> None:
    """The robot learns from the slip; a measure that counted it would be wrong on purpose."""
    slip = said("cup", True, False).model_copy(update={"slip": True})
    assert by_person([slip]).verdicts == [True]
    assert (by_person([slip]).tp, by_person([slip]).fp) == (1, 0)


def test_the_l1_distance_is_taken_over_hours_that_both_measured() -> None:
    """|0.5 - 0.4| and |1 - 0.8|: 0.3 / 2."""
    assert l1([0.5, None, 1.0, 0.3], [0.4, 0.9, 0.8, None]) == pytest.approx(0.15, abs=1e-12)
    assert l1([None], [0.5]) is None
    assert l1([], []) is None


def test_latency_is_what_the_robots_own_fresh_calls_took() -> None:
    calls = [call("human/intention", 9), call("robot/intentions", 2), call("robot/tasks_type2", 0.5)]
    cached = call("robot/tasks_type2", 7).model_copy(update={"cached": True})
    ok = hour(calls=[*calls, cached])
    assert robot_seconds([ok, hour(calls=calls).model_copy(update={"status": "failed"})]) == [2.5]


def said(text: str, accepted: bool, helpful: bool | None) -> FeedbackItem:
    return FeedbackItem(hour=9, kind="task", text=text, accepted=accepted, helpful=helpful)


def call(prompt: str, seconds: float) -> ModelCall:
    return ModelCall(node="n", prompt=prompt, prompt_sha="0", model="m", messages=[], reply="", seconds=seconds)


def hour(calls: list[ModelCall]) -> HourRecord:
    robot = RobotHour(observation=Observation(), intentions=[], tasks=[])
    return HourRecord(
        day=0,
        episode=0,
        episode_day=0,
        hour=9,
        person=PersonId("mara"),
        scene=SceneId("toy"),
        human=None,
        robot=robot,
        world={},
        success=None,
        status="ok",
        calls=calls,
    )
