from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from coopera.benchmark.grid_runs import Benchmark, claimed_folder, plan
from coopera.benchmark.stated import FILE, Statement, read_statements, standing
from coopera.config.schema import Config
from coopera.core.errors import ConfigError, RunError
from coopera.evaluation.grid import Grid, read_grid


def benchmark(folder: Path, data_dir: Path, late_days: int | None = None, *, seeds: int = 1) -> Benchmark:
    grid = Grid(humans=["amara"], scenes=["maple"], episodes=1, days=2, hours=1, late_days=late_days, seeds=seeds)
    return plan(grid, folder, Config(data_dir=data_dir, pictures="none"))


def claim(bench: Benchmark, *, restate: bool = False) -> Statement:
    with claimed_folder(bench, restate=restate) as stated:
        return stated


def begin(bench: Benchmark) -> None:
    """As if a method had met the life."""
    folder = bench.root / "runs" / "s1-type2-seed0-ep00" / "ours"
    folder.mkdir(parents=True)
    (folder / "run.json").write_text("{}")


def words(folder: Path) -> tuple[bool, str]:
    found = standing(read_statements(folder))
    assert found is not None
    return found.kept, found.words.partition(" (SHA-256")[0]


def test_an_endpoint_is_stamped_before_the_first_run_and_stays(tmp_path: Path, data_dir: Path) -> None:
    bench = benchmark(tmp_path, data_dir, 2)
    first = claim(bench)
    assert (first.begun, first.endpoint["late_days"], first.endpoint["measure"]) == (0, 2, "help")
    assert first.sample["people"] == ["amara"]
    begin(bench)
    assert claim(bench) == first, "going on adds no statement"
    assert words(tmp_path) == (True, "Stated before the first run and kept")
    with pytest.raises(ConfigError, match=r"1 of its runs have begun \(late_days was 2, is 1\).*--restate"):
        claim(benchmark(tmp_path, data_dir, 1))
    assert words(tmp_path)[0]


def test_the_same_study_has_the_same_hash_wherever_it_is_stated(tmp_path: Path, data_dir: Path) -> None:
    one, two = (claim(benchmark(tmp_path / name, data_dir, 2)) for name in ("one", "two"))
    assert one.sha256 == two.sha256 != claim(benchmark(tmp_path / "three", data_dir, 1)).sha256


def test_before_any_run_an_endpoint_may_be_thought_over(tmp_path: Path, data_dir: Path) -> None:
    claim(benchmark(tmp_path, data_dir, 2))
    claim(benchmark(tmp_path, data_dir, 1))
    assert words(tmp_path) == (True, "Stated before the first run and kept")


def test_a_change_after_runs_have_begun_is_told_for_good(tmp_path: Path, data_dir: Path) -> None:
    bench = benchmark(tmp_path, data_dir, 2)
    claim(bench)
    begin(bench)
    claim(benchmark(tmp_path, data_dir, 1), restate=True)
    said = "Stated before the first run, and CHANGED: late_days was 2, is 1, when 1 runs had begun"
    assert words(tmp_path) == (False, said)
    claim(bench, restate=True)
    assert words(tmp_path)[0] is False, "changed back it is changed all the same"


def test_more_seeds_after_runs_have_begun_are_told_and_keep_the_endpoint(tmp_path: Path, data_dir: Path) -> None:
    bench = benchmark(tmp_path, data_dir)
    claim(bench)
    begin(bench)
    claim(benchmark(tmp_path, data_dir, seeds=2))
    kept, said = words(tmp_path)
    assert kept
    assert "the sample was changed: " in said
    assert said.endswith("seeds was 0, is 0,1, when 1 runs had begun")


def test_what_is_stated_when_runs_have_begun_is_not_called_stated_beforehand(tmp_path: Path, data_dir: Path) -> None:
    bench = benchmark(tmp_path, data_dir)
    claim(bench)
    begin(bench)
    (tmp_path / FILE).unlink()
    claim(bench)
    assert words(tmp_path) == (False, "Stated when 1 runs had begun already")


def test_a_statement_that_was_altered_is_refused(tmp_path: Path, data_dir: Path) -> None:
    claim(benchmark(tmp_path, data_dir, 2))
    data = json.loads((tmp_path / FILE).read_text())
    data[0]["endpoint"]["late_days"] = 1
    (tmp_path / FILE).write_text(json.dumps(data))
    with pytest.raises(RunError, match="statement 0 was altered"):
        claim(benchmark(tmp_path, data_dir, 1))


def test_a_grid_of_before_there_was_an_endpoint_goes_on(tmp_path: Path, data_dir: Path) -> None:
    bench = benchmark(tmp_path / "out", data_dir)
    claim(bench)
    begin(bench)
    (bench.root / FILE).unlink()
    path = bench.root / "grid.yaml"
    old = yaml.safe_load(path.read_text())
    del old["late_days"], old["early_days"], old["endpoint"]
    path.write_text(yaml.safe_dump(old))
    with pytest.raises(ConfigError, match="late_days was the default, is 1"):
        claim(benchmark(tmp_path / "out", data_dir, 1))
    claim(benchmark(tmp_path / "out", data_dir))


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        ({"endpoint": {"test": "wilcoxon"}}, "endpoint.test cannot be 'wilcoxon'"),
        ({"endpoint": {"mesure": "help"}}, r"there is no field 'mesure' \(did you mean measure\?\)"),
        ({"endpoint": {"measure": "joy"}}, "joy"),
        ({"endpoint": {"reference": "oracle"}}, "endpoint: oracle is none of the grid's methods"),
        ({"endpoint": {"against": ["random"]}}, "endpoint: random is none of the grid's methods"),
        ({"endpoint": {"against": ["ours"]}}, "endpoint: ours cannot be compared with itself"),
    ],
)
def test_an_endpoint_that_cannot_be_is_refused_in_a_sentence(
    tmp_path: Path, data_dir: Path, data: dict[str, object], sentence: str
) -> None:
    with pytest.raises(ConfigError, match=sentence):
        plan(read_grid({"methods": ["ours"], **data}, "grid.yaml"), tmp_path, Config(data_dir=data_dir))


def test_separate_common_sense_is_the_default_and_shared_a_control_where_the_robot_has_one(
    tmp_path: Path, data_dir: Path
) -> None:
    def households(**config: object) -> dict[str, str]:
        made = plan(Grid(humans=["amara"], scenes=["maple"]), tmp_path, Config(data_dir=data_dir, **config))
        return {job.labels["method"]: job.config.household for job in made.jobs if job.after}

    assert households() == {"ours": "own", "ours+shared": "shared"}
    assert households(household="shared") == {"ours": "shared"}
    assert households(models={"robot": "openai:a-model"}) == {"ours": "own"}


def test_a_repeated_sample_changes_nothing_but_the_replies(tmp_path: Path, data_dir: Path) -> None:
    grid = Grid(humans=["amara"], scenes=["maple"], episodes=1, noise=1, with_shared=[])
    ours, again = (job.config for job in plan(grid, tmp_path, Config(data_dir=data_dir)).jobs if job.after)
    assert (ours.calls.sample, again.calls.sample) == (0, 1)
    same = {"calls": ours.calls, "out": None}
    assert ours.model_copy(update=same) == again.model_copy(update=same)


def test_a_benchmark_killed_before_its_grid_stood_is_begun_again_and_another_folder_is_refused(
    tmp_path: Path, data_dir: Path
) -> None:
    root = tmp_path / "bench"
    bench = benchmark(root, data_dir)
    first = claim(bench)
    (root / "grid.yaml").rename(root / ".grid.yaml.77.tmp")
    (root / f".{FILE}.77.tmp").write_text("[")
    assert claim(bench) == first
    (root / "grid.yaml").unlink()
    (root / "notes.txt").write_text("mine")
    with pytest.raises(ConfigError, match="bench is not empty and holds no benchmark"):
        claim(bench)
