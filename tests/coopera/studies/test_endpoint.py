from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from coopera.benchmark.grid_runs import Benchmark, claimed_folder, plan
from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.evaluation.grid import Grid


def benchmark(folder: Path, data_dir: Path, late_days: int | None = None) -> Benchmark:
    grid = Grid(humans=["amara"], scenes=["maple"], episodes=1, days=2, hours=1, late_days=late_days)
    return plan(grid, folder, Config(data_dir=data_dir, pictures="none"))


def claim(bench: Benchmark) -> None:
    with claimed_folder(bench):
        pass


def test_the_endpoint_is_stated_before_the_first_run_and_stays(tmp_path: Path, data_dir: Path) -> None:
    claim(benchmark(tmp_path / "out", data_dir, 2))
    claim(benchmark(tmp_path / "out", data_dir, 2))
    with pytest.raises(ConfigError, match="holds a grid with other late_days"):
        claim(benchmark(tmp_path / "out", data_dir, 1))


def test_a_grid_of_before_there_was_an_endpoint_goes_on(tmp_path: Path, data_dir: Path) -> None:
    claim(benchmark(tmp_path / "out", data_dir))
    path = tmp_path / "out" / "grid.yaml"
    old = yaml.safe_load(path.read_text())
    del old["late_days"], old["early_days"]
    path.write_text(yaml.safe_dump(old))
    claim(benchmark(tmp_path / "out", data_dir))
    with pytest.raises(ConfigError, match="holds a grid with other late_days"):
        claim(benchmark(tmp_path / "out", data_dir, 1))
