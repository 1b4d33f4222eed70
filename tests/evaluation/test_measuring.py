from __future__ import annotations

from typing import Any

import pytest

from coopera.core.errors import ConfigError, RunError
from coopera.core.people import Frozen
from coopera.core.success import Counts, Help, Success
from coopera.evaluation.measuring import MeasureSpec, all_measures, find_measure, known_measures, means, sums


class Steps(Frozen):
    steps: int = 0
    metres: float | None = None


def spec(figures: type[Frozen] = Steps, name: str = "walked") -> MeasureSpec[Any]:
    return MeasureSpec(name, "how far it went", "metres", figures, lambda _: figures(), sums(figures), "metres")


def test_the_measures_that_ship_have_their_order_and_say_what_they_are() -> None:
    assert [one.name for one in all_measures()][:3] == ["help", "predicate", "judge"]
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

    for figures, name, wrong in ((Steps, "people", "people"), (Hours, "walked", "hour"), (Steps, "a-b", "a-b")):
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
