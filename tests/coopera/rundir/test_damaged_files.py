"""Files of a run that somebody else's program wrote, or half a disk: one sentence with the file and the field."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from coopera.benchmark.grid_runs import RunJob, claimed_folder, gather, plan
from coopera.config.schema import Config
from coopera.core.errors import ConfigError, CooperaError, RunError
from coopera.core.hour import Evening, HourRecord
from coopera.evaluation.grid import Grid
from coopera.report.page import fill, texts
from coopera.report.pictures import Album
from coopera.report.tree import print_trees
from coopera.rundir.directory import RunDir
from coopera.rundir.seals import Seal, read_seal
from coopera.rundir.trace_files import read_record
from tests.coopera.fake_run import fake_run

HOUR = "trace/day-00/hour-09.json"
ODD: list[Any] = [None, True, -1, 10**400, 1e308, "", "\x1b[31m", [], {}, [[[]]], {"a": 1}]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> RunDir:
    return fake_run(tmp_path_factory.mktemp("damaged") / "run", days=1, hours=2, frames=1)


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("state", "asleep", "field state is damaged"),
        ("state", None, "field state is damaged"),
        ("models", ["offline"], "field models is damaged"),
        ("prompts", {"human/day": 3}, r"field prompts.human/day is damaged"),
        ("knowledge", "none", "field knowledge is damaged"),
        ("spent", {"calls": "many"}, "field spent.calls is damaged"),
        ("prices", 3, "field prices is damaged"),
        ("resumable", "perhaps", "field resumable is damaged"),
        ("schema", True, "field schema is missing"),
    ],
)
def test_a_run_json_of_the_wrong_shape_is_named_with_its_field(run: RunDir, field: str, value: Any, said: str) -> None:
    file = run.root / "run.json"
    before = file.read_text()
    try:
        file.write_text(json.dumps(json.loads(before) | {field: value}))
        with pytest.raises(RunError, match=rf"run.json: the {said}"):
            RunDir.open(run.root)
    finally:
        file.write_text(before)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[]", "the file is damaged"),
        ("NaN", "the file is damaged .NaN is no number"),
        ('{"seconds": 1e999}', "the file is damaged .1e999 is no number"),
        ("[" * 100_000, "the file is damaged"),
        ("", "the file is damaged"),
    ],
)
def test_a_record_that_is_none_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "hour-09.json").write_text(text)
    for kind in (HourRecord, Evening):
        with pytest.raises(RunError, match=rf"hour-09.json: {said}"):
            read_record(tmp_path / "hour-09.json", kind)


def spoil(data: Any, draw: random.Random) -> None:
    """Put something odd at some place of JSON data."""
    while True:
        keys = list(data) if isinstance(data, dict) else list(range(len(data)))
        key = draw.choice(keys)
        inner = data[key]
        if isinstance(inner, dict | list) and inner and draw.random() < 0.8:
            data = inner
            continue
        data[key] = copy.deepcopy(draw.choice(ODD))
        return


def test_a_spoilt_trace_is_shown_or_refused_and_nothing_else(run: RunDir) -> None:
    draw, quiet = random.Random(3), Console(quiet=True)
    refused: list[str] = []
    for file in (run.root / HOUR, run.root / "trace/day-00/evening.json"):
        before = file.read_text()
        for number in range(80):
            data = json.loads(before)
            spoil(data, draw)
            file.write_text(json.dumps(data))
            try:
                print_trees(run, None, None, quiet)
                run.summary()
                if number % 10 == 0:
                    fill(texts(run), Album({}, 0, 0, small=False))
            except CooperaError as err:
                refused.append(str(err))
        file.write_text(before)
    assert len(refused) > 50
    assert all(str(run.root) in sentence for sentence in refused)


@pytest.mark.parametrize(
    "data",
    [
        {"files": {"../../other": "ab"}},
        {"files": {"/etc/passwd": "ab"}},
        {"files": [], "removed": []},
        {"files": {}, "removed": ["adapters/../run.json"]},
        3,
    ],
)
def test_a_seal_of_the_wrong_shape_is_refused(tmp_path: Path, data: Any) -> None:
    (tmp_path / "seal.json").write_text(json.dumps(data))
    with pytest.raises(RunError, match=r"seal.json: the seal is damaged"):
        read_seal(tmp_path / "seal.json")


def test_a_seal_that_is_none_is_no_error(tmp_path: Path) -> None:
    assert read_seal(tmp_path / "seal.json") is None
    assert Seal(files={}).removed == []


@pytest.fixture
def grid() -> Grid:
    return Grid(methods=["random"], settings=["1"], episodes=1, days=1, hours=1, seeds=1)


@pytest.mark.parametrize("text", ["3", "run: [a]", "shared: 7", "run: {hours: [", "- 1"])
def test_a_grid_file_of_the_wrong_shape_is_refused(tmp_path: Path, grid: Grid, text: str) -> None:
    (tmp_path / "grid.yaml").write_text(text)
    with pytest.raises(ConfigError, match=r"grid.yaml"), claimed_folder(plan(grid, tmp_path, Config())):
        pass


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("3", "the file is damaged"),
        ("{}", "the field rows is damaged"),
        ('{"rows": [3], "seconds": []}', r"the field rows\.0 is damaged"),
        ('{"rows": [], "seconds": [NaN]}', "the file is damaged"),
        ('{"rows": [], "seconds": []}', "it has 0 rows, where the run has 1 hours"),
    ],
)
def test_rows_of_the_wrong_shape_are_refused_and_not_left_out(tmp_path: Path, grid: Grid, text: str, said: str) -> None:
    bench = plan(grid, tmp_path, Config())
    give: Callable[[RunJob], Path] = lambda job: job.folder / "rows.json"  # noqa: E731
    for job in bench.jobs:
        give(job).parent.mkdir(parents=True)
        give(job).write_text(text)
    with pytest.raises(RunError, match=rf"rows.json: {said}"):
        gather(bench)
