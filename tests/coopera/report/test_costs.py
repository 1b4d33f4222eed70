from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from coopera.cli import main
from coopera.core.hour import ModelCall
from coopera.report.costs import costs_of
from coopera.report.progress import days_table
from tests.coopera.fake_run import fake_run


def call(node: str, seconds: float, **more: Any) -> ModelCall:
    given = {"prompt": "judge/tasks", "model": "openai:m", "tokens_in": 100, "tokens_out": 10, **more}
    return ModelCall(node=node, prompt_sha="0", messages=[], reply="", seconds=seconds, **given)


def run(hour: list[ModelCall], evening: list[ModelCall]) -> Any:
    """A run of one hour and its evening."""
    lived = SimpleNamespace(day=0, hour=9, calls=hour)
    told = SimpleNamespace(day=0, calls=evening)
    return SimpleNamespace(hours=lambda: [lived], evenings=lambda: [told], prices=None)


def test_what_is_asked_at_once_takes_one_round_trip_and_as_long_as_its_slowest_reply() -> None:
    """Propose, decompose (asked twice), both reflections at once, the second again, and two questions at once: 6."""
    hour = [
        call("propose", 1.0),
        call("decompose", 2.0, attempts=2),
        call("reflect_profile", 3.0),
        call("reflect_scene", 4.0),
        call("reflect_scene", 5.0),
        call("imagine_tasks", 6.0),
        call("imagine_tasks", 7.0),
        call("score", 8.0, late=True),
    ]
    evening = [call("feedback", 1.0), call("feedback", 9.0), call("infer_traits", 2.0)]
    found = costs_of(run(hour, evening))
    assert found["hours"] == [
        {"day": 0, "hour": 9, "calls": 7, "round_trips": 6, "tokens_in": 700, "tokens_out": 70, "seconds": 19.0}
    ]
    assert found["evenings"] == [
        {"day": 0, "calls": 4, "round_trips": 2, "tokens_in": 400, "tokens_out": 40, "seconds": 11.0}
    ]


def test_replies_from_the_cache_take_nothing() -> None:
    found = costs_of(run([call("propose", 1.0, cached=True)], []))
    assert {found["hours"][0][name] for name in ("calls", "round_trips", "tokens_in", "seconds")} == {0}


def test_nobody_waits_for_an_offline_model() -> None:
    hour = [
        call("propose", 1.0),
        call("reflect_profile", 2.0, model="offline"),
        call("score", 3.0, model="offline:words", attempts=2),
    ]
    found = costs_of(run(hour, [call("feedback", 1.0, model="offline:home.yaml")]))
    assert (found["hours"][0]["calls"], found["hours"][0]["round_trips"]) == (3, 1)
    assert found["evenings"][0]["round_trips"] == 0


def test_the_command_says_what_a_run_asked_and_what_it_cost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, prices = tmp_path / "run", tmp_path / "prices.yaml"
    fake_run(out, days=1, hours=2, frames=1, finished=False)
    prices.write_text('as_of: 2026-05-01\ncurrency: EUR\nmodels: {"openai:*": {in: 1, out: 1}}\n')
    assert main(["models", "cost", str(out)]) == 0
    said = capsys.readouterr().out
    assert "an hour, on average" in said
    assert "Cost:" not in said
    assert main(["models", "cost", str(out), "--prices", str(prices), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [(one["day"], one["hour"]) for one in found["hours"]] == [(0, 9), (0, 10)]
    assert len(found["evenings"]) == 1
    assert found["money"]["currency"] == "EUR"


def test_an_hour_whose_judge_is_still_to_be_asked_is_shown_without_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = fake_run(tmp_path / "run", days=1, hours=2, frames=1, finished=False)
    for hour in made.hours():
        assert hour.success is not None
        made.write_hour(hour.model_copy(update={"success": hour.success.model_copy(update={"judge": None})}))
    assert main(["trace", str(made.root), "--day", "0"]) == 0
    said = capsys.readouterr().out
    assert "predicate" in said
    assert "judge     " not in said
    assert main(["report", str(made.root)]) == 0
    (day,) = made.summary()["days"]
    assert (day["judge"]["f1"], day["judge"]["unscored"]) == (None, 0)
    assert day["predicate"]["f1"] is not None
    days_table(made.summary(), made.root)
    assert "–" in capsys.readouterr().out
