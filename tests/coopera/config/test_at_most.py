from __future__ import annotations

from pathlib import Path

import pytest

from coopera.benchmark.grid_runs import load_grid, plan, shared_config
from coopera.checks.method import check_method
from coopera.config.at_most import VARIABLE
from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.evaluation import METHODS
from coopera.studies.catalogues import resolve


def test_the_environment_cuts_a_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "days=1, hours=2")
    cut = resolve(Config(days=3, hours=13, out=tmp_path / "run"))
    assert (cut.days, cut.hours) == (1, 2)
    small = resolve(Config(hours=1, out=tmp_path / "run"))
    assert (small.days, small.hours) == (1, 1)


def test_the_environment_cuts_a_schedule_with_its_days(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "days=1")
    cut = resolve(Config(schedule=[["amara", "maple"], ["bruno", "maple"]], out=tmp_path / "run"))
    assert (cut.days, cut.schedule, cut.humans) == (1, [("amara", "maple")], ["amara"])
    assert resolve(cut) == cut


def test_the_environment_cuts_a_benchmark(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, "days=1,hours=1,episodes=1,settings=2,methods=1")
    grid = load_grid(None, {"methods": ["ours", "random"], "settings": ["1", "2", "3"]})
    planned = plan(grid, tmp_path / "grid", shared_config(grid, None, {}))
    assert {job.labels["method"] for job in planned.jobs} == {"none", "ours"}
    assert {job.labels["setting"] for job in planned.jobs} == {"1", "2"}
    assert {(job.config.hours, len(job.config.schedule or [])) for job in planned.jobs} == {(1, 1)}


def test_a_method_is_not_checked_on_less_than_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "days=1")
    with pytest.raises(ConfigError, match="COOPERA_AT_MOST: a method is checked on two days"):
        check_method(METHODS["random"], collabs=(2,))


@pytest.mark.parametrize("said", ["days", "days=0", "days=many", "weeks=1"])
def test_anything_but_sizes_is_refused(monkeypatch: pytest.MonkeyPatch, said: str) -> None:
    monkeypatch.setenv(VARIABLE, said)
    with pytest.raises(ConfigError, match="^COOPERA_AT_MOST must be sizes such as days=1,hours=2"):
        resolve(Config())
