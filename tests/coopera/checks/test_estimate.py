"""What an estimate foretells of models that are asked in other ways than the first server that comes to mind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from coopera.checks.estimate import estimate
from coopera.config.schema import Config, Models
from coopera.models.settings import Budget, CallSettings
from coopera.studies.catalogues import resolve


@pytest.fixture(scope="module")
def foretold(tmp_path_factory: pytest.TempPathFactory, letters: Path) -> Any:
    """Estimates an hour of a person whom a model plays, and of a robot that another one plays.

    What is foretold hardly depends on how texts are compared.
    """
    folder = tmp_path_factory.mktemp("estimates")

    def person(spec: str = "openai:m", robot: str = "offline", **calls: Any) -> dict[str, Any]:
        config = Config(
            days=1,
            hours=1,
            pictures="none",
            models=Models(human=spec, robot=robot),
            base_url="http://127.0.0.1:9/v1",
            calls=CallSettings(**calls),
            budget=Budget(prices=folder / "prices.yaml"),
            out=folder / "run",
            data_dir=letters,
        )
        (folder / "prices.yaml").write_text('as_of: 2026-05-01\ncurrency: EUR\nmodels: {"openai:*": {in: 1, out: 1}}\n')
        found = estimate(resolve(config))
        return {**found["roles"]["human"], "unpriced": found["money"]["unpriced"]}

    return person


@pytest.fixture(scope="module")
def plain(foretold: Any) -> Any:
    return foretold()


def test_a_schema_that_is_always_shown_is_foretold(foretold: Any, plain: Any) -> None:
    shown = foretold(show_schema="always")
    assert shown["calls"] == plain["calls"]
    assert shown["tokens_in"] > plain["tokens_in"] + 50 * plain["calls"]


def test_a_schema_that_only_stands_in_the_prompt_is_foretold_once(foretold: Any) -> None:
    in_words, as_json = foretold(structure="text"), foretold(structure="json_object")
    assert as_json["tokens_in"] == in_words["tokens_in"]


def test_brief_replies_are_foretold_as_such(foretold: Any, plain: Any) -> None:
    brief = foretold(brief=True)
    assert brief["tokens_out"] / brief["calls"] < 0.8 * plain["tokens_out"] / plain["calls"]


def test_the_model_in_the_box_is_foretold_unopened_brief_and_without_tokens_for_its_schema(
    foretold: Any, plain: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("coopera.models.small.weights.packed", lambda: pytest.fail("it was unpacked"))
    small, brief = foretold("smol", robot="smol"), foretold(brief=True)
    assert (small["calls"], small["tokens_out"]) == (brief["calls"], brief["tokens_out"])
    assert small["tokens_in"] < brief["tokens_in"]
    assert small["unpriced"] == []


def test_a_robot_that_looks_at_a_days_video_is_foretold_the_frames_of_it(letters: Path, tmp_path: Path) -> None:
    def pictures(taken: str) -> int:
        models = Models(human="offline", robot="openai:m+images")
        server = {"base_url": "http://127.0.0.1:9/v1", "data_dir": letters, "out": tmp_path / taken}
        config = Config(days=1, hours=1, pictures=taken, frames=4, models=models, **server)
        return estimate(resolve(config))["roles"]["robot"]["pictures"]

    assert pictures("video") == pictures("sampled") == 8
    assert pictures("none") == 0
