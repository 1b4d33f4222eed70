"""The evening: all that waits for nobody is asked at once, and the judge has held no hour up."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from langgraph.runtime import Runtime

from coopera.core.randomness import Address
from coopera.graphs import build_day_graph, first_day
from coopera.graphs.day import DayState, feedback
from coopera.graphs.players.simulated import Simulated
from coopera.graphs.players.together import together
from tests.fakes import MARA, ScriptedAsk, type2_answers
from tests.graphs.conftest import MakeServices
from tests.graphs.test_day import DyingAsk, Killed, days, files, run_saved
from tests.graphs.test_robot import robot, watch

EVENING = ("human/feedback_intentions", "human/feedback_tasks", "judge/tasks")
HOURS = 3


def slow_judge(answers: dict[str, Any] | None = None) -> ScriptedAsk:
    ask = ScriptedAsk(answers or type2_answers())
    ask.slow = {"judge"}
    return ask


def slow_everywhere(answers: dict[str, Any]) -> ScriptedAsk:
    ask = ScriptedAsk(answers)
    ask.slow = {"human", "robot", "judge"}
    return ask


def answered_by(wait: Callable[[], object], *prompts: str) -> dict[str, Any]:
    """The usual answers, given only once `wait` is over."""
    answers = type2_answers()

    def after(answer: Callable[[dict[str, Any]], dict[str, Any]]) -> Callable[[dict[str, Any]], dict[str, Any]]:
        def waiting(variables: dict[str, Any]) -> dict[str, Any]:
            wait()
            return answer(variables)

        return waiting

    return {**answers, **{prompt: after(answers[prompt]) for prompt in prompts}}


def lived(services: Any) -> dict[str, Any]:
    """The day's trace as data."""
    build_day_graph().invoke(first_day(days(1, HOURS)[0]), context=services)
    hours = [json.loads(hour.model_dump_json()) for hour in services.recorder.read_day(0)]
    return {"hours": hours, "evening": json.loads(services.recorder.evenings[0].model_dump_json())}


def as_if_asked_in_the_hour(day: dict[str, Any]) -> dict[str, Any]:
    for hour in day["hours"]:
        for call in hour["calls"]:
            call.pop("late", None)
    return day


def test_all_questions_of_the_evening_and_the_judges_are_under_way_at_once(make_services: MakeServices) -> None:
    everybody = threading.Barrier(len(EVENING) * HOURS, timeout=30)
    ask = slow_everywhere(answered_by(everybody.wait, *EVENING))
    lived(make_services(ask=ask))
    assert not everybody.broken
    asked = [prompt for prompt, _, _ in ask.asked if prompt in EVENING]
    assert sorted(asked) == sorted(EVENING * HOURS)


def test_the_robots_questions_about_its_intentions_are_under_way_at_once(make_services: MakeServices) -> None:
    everybody = threading.Barrier(3, timeout=30)
    ask = slow_everywhere(answered_by(everybody.wait, "robot/tasks_type2"))
    assert watch(robot(make_services, ask=ask, method="paper")) == watch(robot(make_services, method="paper"))


def test_what_a_day_leaves_does_not_depend_on_who_answers_first(make_services: MakeServices, tmp_path: Path) -> None:
    everybody, turns = threading.Barrier(len(EVENING) * HOURS, timeout=30), threading.Condition()
    ended: list[int] = []

    def last_come_first_served() -> None:
        place = everybody.wait()
        with turns:
            assert turns.wait_for(lambda: len(ended) == place, timeout=30)
            ended.append(place)
            turns.notify_all()

    at_once = slow_everywhere(answered_by(last_come_first_served, *EVENING))
    threaded = lived(make_services(ask=at_once, folder=tmp_path / "at-once"))
    in_turn = lived(make_services(folder=tmp_path / "in-turn"))
    assert ended == list(range(len(EVENING) * HOURS))
    assert as_if_asked_in_the_hour(threaded) == in_turn


def test_an_hour_is_on_record_before_its_judge_was_asked_and_complete_after_the_evening(
    make_services: MakeServices,
) -> None:
    services = make_services(ask=(ask := slow_judge()))
    stream = build_day_graph().stream(first_day(days(1, HOURS)[0]), context=services)
    for update in stream:
        if "hour" in update:
            last = services.recorder.read_day(0)[-1]
            assert last.success is not None
            assert last.success.judge is None
            assert last.success.predicate.f1 is not None
            assert last.success.help is not None
            assert "judge/tasks" not in {prompt for prompt, _, _ in ask.asked}
    for hour in services.recorder.read_day(0):
        assert hour.success is not None
        assert hour.success.judge is not None
        assert [(call.prompt, call.late) for call in hour.calls if call.late] == [("judge/tasks", True)]
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert "judge/tasks" not in {call.prompt for call in evening.calls}
    assert [at for prompt, at, _ in ask.asked if prompt == "judge/tasks"] == [
        Address(MARA.id, 0, hour, "score") for hour in (9, 10, 11)
    ]


class OneWhoIsAsked(Simulated):
    """A person who takes one question after another, since somebody sits there and answers."""

    one_by_one = True


def test_a_real_person_is_asked_one_thing_after_another_once_the_judge_has_been(make_services: MakeServices) -> None:
    ask = slow_judge()
    lived(make_services(ask=ask, player=OneWhoIsAsked()))
    evening = [(prompt, at.hour) for prompt, at, _ in ask.asked if prompt in EVENING]
    assert sorted(evening[:HOURS]) == [("judge/tasks", hour) for hour in (9, 10, 11)]
    assert evening[HOURS:] == [(prompt, hour) for hour in (9, 10, 11) for prompt in EVENING[:2]]


@pytest.mark.parametrize("moment", [1, 3])
def test_a_study_killed_while_the_judge_is_asked_and_resumed_equals_one_that_was_not(
    make_services: MakeServices, tmp_path: Path, moment: int
) -> None:
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    for folder in (whole, broken):
        folder.mkdir()
    run_saved(make_services(folder=whole, ask=slow_judge()), whole)
    dying = DyingAsk("score", moment)
    dying.slow = {"judge"}
    with pytest.raises(Killed):
        run_saved(make_services(folder=broken, ask=dying), broken)
    run_saved(make_services(folder=broken, ask=slow_judge()), broken, go_on=True)
    assert files(broken) == files(whole)


def test_an_evening_done_again_asks_only_for_what_is_still_missing(make_services: MakeServices) -> None:
    services = make_services(ask=(ask := slow_judge()))
    lived(services)
    first, second, third = services.recorder.read_day(0)
    assert second.success is not None
    services.recorder.write_hour(
        second.model_copy(update={"success": second.success.model_copy(update={"judge": None})})
    )
    services.recorder.evenings.clear()  # type: ignore[attr-defined]
    ask.asked.clear()
    services.ask.take_calls()
    state = DayState(plan=days(1, HOURS)[0], worlds={}, beliefs={}, learned=[])
    feedback(state, Runtime(context=services))
    assert [at.hour for prompt, at, _ in ask.asked if prompt == "judge/tasks"] == [second.hour]
    again = services.recorder.read_day(0)
    assert (again[0], again[2]) == (first, third)


def test_jobs_come_out_in_their_order_and_the_first_failure_is_the_one_that_is_told() -> None:
    later = threading.Event()

    def first() -> str:
        assert later.wait(timeout=30)
        return "first"

    def second() -> str:
        later.set()
        return "second"

    assert together([first, second]) == ["first", "second"]
    assert together([lambda: 1, lambda: 2], waits=False) == [1, 2]

    def fails(why: str) -> Callable[[], None]:
        def job() -> None:
            raise ValueError(why)

        return job

    with pytest.raises(ValueError, match="one"):
        together([fails("one"), fails("two")])
