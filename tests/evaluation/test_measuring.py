from __future__ import annotations

from typing import Any

import pytest

from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import Evening, FeedbackItem, HourRecord
from coopera.core.people import Belief, Frozen
from coopera.core.success import Counts, Help, Success
from coopera.evaluation.measuring import (
    MeasureSpec,
    all_measures,
    find_measure,
    known_measures,
    means,
    sums,
    told_in_the_evening,
)


class Steps(Frozen):
    steps: int = 0
    metres: float | None = None


def spec(figures: type[Frozen] = Steps, name: str = "walked") -> MeasureSpec[Any]:
    return MeasureSpec(name, "how far it went", "metres", figures, lambda _: figures(), sums(figures), "metres")


def test_the_measures_that_ship_have_their_order_and_say_what_they_are() -> None:
    assert [one.name for one in all_measures()][:5] == ["help", "predicate", "judge", "people", "similar"]
    assert sorted(one.name for one in all_measures()) == sorted(known_measures())
    assert all(one.about and one.headline in one.pool([]) for one in all_measures())


def test_figures_are_added_up_over_hours_and_averaged_over_those_that_have_them() -> None:
    hours = [Steps(steps=1, metres=0.1), Steps(steps=2, metres=0.2), Steps(steps=3)]
    assert sums(Steps)(hours) == {"steps": 6, "metres": 0.3}
    assert means(Steps)(hours) == {"steps": 2, "metres": 0.15}
    assert sums(Steps)([]) == {"steps": 0, "metres": 0}
    assert means(Steps)([]) == {"steps": None, "metres": None}


def test_a_name_that_means_something_else_in_the_files_is_refused() -> None:
    class Hours(Frozen):
        hour: int = 0

    for figures, name, wrong in ((Steps, "person", "person"), (Hours, "walked", "hour"), (Steps, "a-b", "a-b")):
        with pytest.raises(ConfigError, match=f"measure: {name}: '{wrong}' cannot be the name"):
            spec(figures, name)


def test_a_trace_of_before_a_measure_was_there_is_read_without_it() -> None:
    old = Success.model_validate({"predicate": {"tp": 1}, "judge": {}})
    assert find_measure("predicate").read(old) == Counts(tp=1)
    assert find_measure("help").read(old) is None
    assert spec().read(old) is None


def test_figures_of_further_measures_are_kept_in_traces() -> None:
    walked = {"steps": 3, "metres": None}
    success = Success.model_validate({"predicate": {}, "judge": {}, "help": {}, "walked": walked})
    assert success.model_dump(mode="json")["walked"] == walked
    again = Success.model_validate_json(success.model_dump_json())
    assert again == success
    assert again.help == Help()
    assert spec().read(again) == Steps(steps=3)


def test_figures_of_another_shape_are_refused_with_what_was_expected() -> None:
    success = Success.model_validate({"predicate": {}, "judge": {}, "walked": {"miles": 3}})
    with pytest.raises(RunError, match=r"success.walked: the trace has \{'miles': 3\}, and .* has steps, metres"):
        spec().read(success)


def test_a_measure_is_taken_in_the_hour_or_in_the_evening() -> None:
    for measure, answers in ((None, None), (lambda _: Steps(), lambda _: Steps())):
        with pytest.raises(ConfigError, match="one of `measure` and `answers` must be given, and one alone"):
            MeasureSpec("walked", "", "metres", Steps, measure, sums(Steps), "metres", answers=answers)


def test_the_evening_completes_the_hours_of_its_day_and_no_others() -> None:
    lived = [hour(9), hour(10), hour(9).model_copy(update={"day": 1}), hour(11).model_copy(update={"success": None})]
    told = told_in_the_evening(lived, [evening(answer(9, helpful=True), answer(10, helpful=False))])
    people = find_measure("people")
    found = [people.read(one.success) if one.success else None for one in told]
    assert found == [
        Counts(tp=1, f1=1, precision=1, recall=1, verdicts=[True]),
        Counts(fp=1, f1=0, precision=0, verdicts=[False]),
        None,
        None,
    ]
    assert told_in_the_evening(lived, []) == lived
    assert told_in_the_evening(told, [evening(answer(9, helpful=True), answer(10, helpful=False))]) == told


def hour(at: int) -> HourRecord:
    success = Success.model_validate({"predicate": {}, "judge": {}})
    where = {"day": 0, "episode": 0, "episode_day": 0, "hour": at, "person": "ann", "scene": "maple"}
    lived = {"human": None, "robot": None, "world": {}, "success": success, "status": "ok"}
    return HourRecord.model_validate(where | lived)


def evening(*feedback: FeedbackItem) -> Evening:
    where = {"day": 0, "episode": 0, "episode_day": 0, "person": "ann", "scene": "maple"}
    return Evening.model_validate({**where, "feedback": list(feedback), "belief": Belief()})


def answer(at: int, *, helpful: bool) -> FeedbackItem:
    return FeedbackItem(hour=at, kind="task", text="bring the mug", accepted=True, helpful=helpful)
