"""What a run costs: foretold, limited, and nothing at all where it was paid before."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from benchmarks.prompt_costs import Scripted, Writer, counter
from benchmarks.prompt_costs import serving as scripted
from coopera import Config, run_study
from coopera.cli import main
from coopera.config.schema import Models
from coopera.models.recorded import PREFIXES
from coopera.models.settings import Budget
from coopera.report.progress import days_table
from coopera.rundir.directory import RunDir
from tests.serving import done, serving
from tests.test_household import truth

SMALL: dict[str, Any] = {"days": 1, "hours": 1, "pictures": "none"}


@pytest.fixture(scope="module")
def data_dir(letters: Path) -> Path:
    """What is paid does not depend on how texts are compared."""
    return letters


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory, data_dir: Path) -> Path:
    out = tmp_path_factory.mktemp("costs") / "whole"
    run_study(Config(**SMALL, out=out, data_dir=data_dir))
    return out


def study_like(run: Path, **more: Any) -> Path:
    """A study file that describes a run, but for what is given."""
    path = run.parent / "study.yaml"
    path.write_text(json.dumps({**RunDir.open(run).config.model_dump(mode="json", exclude={"out"}), **more}))
    return path


def test_a_budget_stops_a_run_that_resumes_to_the_same_end(lived: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = lived.parent / "stopped"
    study = study_like(lived)
    assert main(["run", str(study), "--out", str(out), "--budget-calls", "8"]) == 1
    said = capsys.readouterr().err
    assert "the budget of 8 calls is spent (8 calls" in said
    assert f"Continue with: coopera resume {out}" in said
    info = json.loads((out / "run.json").read_text())
    assert info["state"] == "stopped"
    assert info["spent"]["calls"] == 8
    assert main(["resume", str(out)]) == 1, "what is spent stays spent"
    assert main(["resume", str(out), "--budget-calls", "1000"]) == 0
    (out / "config.yaml").write_text((lived / "config.yaml").read_text())
    assert truth(out) == truth(lived)
    spent = RunDir.open(out).spent()
    assert spent.calls > json.loads((out / "summary.json").read_text())["calls"], "the broken hour was paid for too"


@pytest.mark.parametrize("flag", ["--budget-calls", "--budget-tokens"])
def test_a_budget_of_nothing_is_refused(flag: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", flag, "0"]) == 2
    assert f"{flag} must be a whole number from 1 up, not 0." in capsys.readouterr().err


def test_money_that_nobody_can_count_limits_no_run(
    lived: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    prices = tmp_path / "prices.yaml"
    prices.write_text('as_of: 2026-05-01\ncurrency: EUR\nmodels: {"openai:dear-*": {in: 1, out: 10}}\n')
    out = ["--out", str(tmp_path / "run"), "--budget-money", "1"]
    assert main(["run", *out]) == 2
    assert "--prices FILE that it began with, and has none" in capsys.readouterr().err
    assert main(["run", *out, "--robot-model", "openai:m", "--prices", str(prices)]) == 2
    assert "the model openai:m has no price in" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()
    begun = tmp_path / "begun"
    assert main(["run", str(study_like(lived)), "--out", str(begun), "--budget-calls", "1"]) == 1
    before = truth(begun)
    capsys.readouterr()
    assert main(["resume", str(begun), "--budget-money", "1"]) == 2
    assert "--prices FILE that it began with, and has none" in capsys.readouterr().err
    assert truth(begun) == before, "a run that cannot go on is left as it is"


@pytest.mark.parametrize("prefix", PREFIXES)
def test_a_recorded_run_is_the_same_without_any_model(
    prefix: str, lived: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = lived.parent / prefix
    assert main(["run", "--model", f"{prefix}:{lived}", "--out", str(out)]) == 0
    now, before = truth(out), truth(lived)
    assert {name for name in before if name.startswith("trace")} <= set(now)
    for name in before:
        if name not in {"config.yaml", "summary.json"}:  # these name the models
            assert now[name] == before[name], name
    capsys.readouterr()
    assert main(["run", "--model", f"{prefix}:{lived}", "--seed", "1", "--out", str(out) + "-1"]) == 1
    assert "never asked this" in capsys.readouterr().err
    assert main(["run", "--model", f"{prefix}:nowhere"]) == 2
    assert main(["run", "--human-model", f"{prefix}:nowhere"]) == 2
    assert "recorded:nowhere cannot be opened: this folder holds no run" in capsys.readouterr().err


def test_an_estimate_foretells_the_calls_of_the_run(lived: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = study_like(lived, models={"human": "openai:tiny"}, base_url="http://127.0.0.1:9/v1")
    assert main(["run", str(study), "--estimate", "--json"]) == 0
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    calls = [call for hour in RunDir.open(lived).hours() for call in hour.calls]
    calls += [call for evening in RunDir.open(lived).evenings() for call in evening.calls]
    asked = [call for call in calls if call.prompt.startswith("human/")]
    assert found["roles"]["human"]["calls"] == found["calls"] == len(asked)
    assert found["tokens_in"] > 100 * len(asked)
    assert found["roles"]["robot"]["paid"] is False


@pytest.fixture(scope="module", params=[1, 2])
def asked(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, data_dir: Path) -> Path:
    """A run whose models are a server that answers well and at length, with what they cost."""
    folder = tmp_path_factory.mktemp("asked")
    prices = folder / "prices.yaml"
    prices.write_text('as_of: 2026-05-01\ncurrency: EUR\nmodels: {"openai:*": {in: 1, out: 10}}\n')
    models = Models(human="openai:scripted", robot="openai:scripted", judge="openai:scripted")
    budget = Budget(prices=prices)
    given = {**SMALL, "collab": request.param, "scenes": ["maple"], "models": models, "budget": budget}
    with scripted(Scripted(Writer(), counter(None), 0.0)) as url:
        run_study(Config(**given, base_url=url, out=folder / "run", cache=folder / "c.sqlite", data_dir=data_dir))
    return folder / "run"


def test_an_estimate_is_within_a_tenth_of_the_tokens_that_a_server_counts(
    asked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(study_like(asked)), "--estimate", "--json"]) == 0
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    run = RunDir.open(asked)
    made = [call for one in [*run.hours(), *run.evenings()] for call in one.calls]
    again = [call for hour in run.hours() for call in hour.calls if call.prompt.startswith("human/reflect_scene")][1:]
    made = [call for call in made if not any(call is one for one in again)]  # who lives other days reflects anew or not
    foretold, asked_for = found["calls"], len(made)
    assert abs(foretold - asked_for) <= 2
    sent = sum(call.tokens_in for call in made)
    assert found["tokens_in"] / foretold == pytest.approx(sent / asked_for, rel=0.1)
    both = found["tokens_in"] + found["tokens_out"]
    written = sum(call.tokens_out for call in made)
    assert both / foretold == pytest.approx((sent + written) / asked_for, rel=0.1)
    paid = (found["tokens_in"] + 10 * found["tokens_out"]) / 1e6
    assert found["money"]["spent"] == pytest.approx(paid, abs=1e-6)


def test_what_a_run_cost_stands_in_its_summary_and_is_told_at_its_end(
    asked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    summary = json.loads((asked / "summary.json").read_text())
    spent = (summary["tokens_in"] + 10 * summary["tokens_out"]) / 1e6
    assert summary["money"]["spent"] == pytest.approx(spent, abs=1e-6)
    assert (summary["money"]["currency"], summary["money"]["unpriced"]) == ("EUR", [])
    days_table(summary, asked, Console(highlight=False))
    assert f"Cost: {spent:.2f} EUR, by the prices of 2026-05-01." in capsys.readouterr().out
    assert RunDir.open(asked).spent().money == pytest.approx(spent, abs=1e-6)


def test_a_judge_that_was_asked_in_the_evening_is_so_in_the_recorded_run_too(asked: Path) -> None:
    hours = RunDir.open(asked).hours()
    assert [call.late for hour in hours for call in hour.calls if call.prompt == "judge/tasks"] == [True]
    assert all(hour.success and hour.success.judge for hour in hours)
    out = asked.parent / "again"
    assert main(["run", "--model", f"recorded:{asked}", "--out", str(out)]) == 0
    now, before = truth(out), truth(asked)
    for name in before:
        if name.startswith(("trace", "metrics")):
            assert now[name] == before[name], name


@pytest.mark.slow
def test_a_rerun_and_another_method_pay_only_for_what_is_new(tmp_path: Path, data_dir: Path) -> None:
    with serving() as url:

        def run(name: str, **changes: Any) -> tuple[dict[str, Any], int]:
            models = Models(human="openai:tiny", robot="openai:tiny", judge="openai:tiny")
            options = {**SMALL, "models": models, "base_url": url, "data_dir": data_dir, **changes}
            before = len(done(url))
            summary = run_study(Config(**options, out=tmp_path / name))
            return summary, len(done(url)) - before

        first, paid = run("first")
        assert paid == first["calls"]
        assert run("again") == ({**first, "calls_cached": paid, "tokens_cached": first["tokens"]}, 0)
        other, more = run("other", method="random")
        lived = [call for hour in RunDir.open(tmp_path / "other").hours() for call in hour.calls]
        assert all(call.cached for call in lived if call.node in {"propose", "decompose", "reflect_profile"})
        assert more == other["calls"] - other["calls_cached"] < paid
