from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.rundir.directory import RunDir
from coopera.rundir.export import export
from tests.coopera.fake_run import fake_run

parquet = pytest.importorskip("pyarrow.parquet")


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("export")
    run = fake_run(folder / "run", days=2, hours=8)
    assert export(run, folder / "out")["hours"] == 16
    return folder


def test_an_hour_is_a_row_and_a_failed_one_has_no_figures(written: Path) -> None:
    rows = parquet.read_table(written / "out/hours/data/train-00000-of-00001.parquet").to_pylist()
    assert [(row["day"], row["hour"]) for row in rows] == [(day, hour) for day in (0, 1) for hour in range(9, 17)]
    failed = rows[-1]
    assert (failed["status"], failed["intention"], failed["tasks"], failed["predicate_f1"]) == (
        "failed",
        None,
        [],
        None,
    )
    assert all(len(row["robot_tasks"]) == len(row["robot_accepted"]) == len(row["robot_correct"]) for row in rows)
    assert "offline routine model" in (written / "out/hours/README.md").read_text()


def test_episodes_have_what_lerobots_reader_looks_for(written: Path) -> None:
    root = written / "out/episodes"
    info = json.loads((root / "meta/info.json").read_text())
    frames = parquet.read_table(root / info["data_path"].format(chunk_index=0, file_index=0))
    assert set(frames.column_names) == set(info["features"])
    assert {name: str(frames.schema.field(name).type) for name in info["features"]} == {
        name: {"float32": "float", "bool": "bool"}.get(feature["dtype"], feature["dtype"])
        for name, feature in info["features"].items()
    }
    episodes = parquet.read_table(root / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert [one["dataset_to_index"] - one["dataset_from_index"] for one in episodes] == [e["length"] for e in episodes]
    assert (
        (info["total_episodes"], info["total_frames"])
        == (2, frames.num_rows)
        == (len(episodes), episodes[1]["dataset_to_index"])
    )
    tasks = parquet.read_table(root / "meta/tasks.parquet")
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    last = frames.to_pylist()[-1]
    assert last["timestamp"] == last["frame_index"] == episodes[1]["length"] - 1
    assert tasks.to_pylist()[last["task_index"]]["task"] in episodes[1]["tasks"]


def test_the_library_loads_the_hours_as_they_are(written: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    datasets = pytest.importorskip("datasets")
    loaded = datasets.load_dataset(str(written / "out/hours"), cache_dir=str(written / "cache"))["train"]
    assert len(loaded) == 16
    assert loaded.features["tasks"] == datasets.List(datasets.Value("string"))


def test_a_folder_with_something_in_it_is_refused(written: Path) -> None:
    with pytest.raises(ConfigError, match="must be an empty folder or a new one"):
        export(fake_run(written / "other", days=1, hours=1), written / "out")


def test_every_column_and_every_file_stands_in_the_croissant_metadata_with_the_fingerprints(written: Path) -> None:
    out = written / "out"
    said = json.loads((out / "croissant.json").read_text())
    files = {one["@id"]: one for one in said["distribution"]}
    assert sorted(files) == sorted(path.relative_to(out).as_posix() for path in out.rglob("*.parquet"))
    for name, one in files.items():
        assert one["sha256"] == hashlib.sha256((out / name).read_bytes()).hexdigest()
    for records in said["recordSet"]:
        source = records["field"][0]["source"]["fileObject"]["@id"]
        columns = [field["source"]["extract"]["column"] for field in records["field"]]
        assert columns == parquet.read_schema(out / source).names
        assert all(field["description"].endswith(".") for field in records["field"])
    facts = {one["name"]: one["value"] for one in said["additionalProperty"]}
    marks = ("person", "judge", "household", "robot", "prompts", "code")
    assert {f"fingerprint of {name}" for name in marks} <= set(facts)
    assert said["license"].startswith("https://")


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_croissant_library_finds_nothing_to_complain_of_and_reads_the_records(written: Path) -> None:
    croissant = pytest.importorskip("mlcroissant")
    data = croissant.Dataset(str(written / "out/croissant.json"))
    assert (data.metadata.issues.errors, data.metadata.issues.warnings) == (set(), set())
    rows = list(data.records("hours"))
    assert [(row["hours/day"], row["hours/hour"]) for row in rows] == [(day, h) for day in (0, 1) for h in range(9, 17)]
    assert len(list(data.records("tasks"))) == parquet.read_table(written / "out/episodes/meta/tasks.parquet").num_rows
    assert len(list(data.records("episodes"))) == 2


def test_days_that_a_real_person_decided_are_not_called_simulated(tmp_path: Path) -> None:
    run = fake_run(tmp_path / "run", days=1, hours=2)
    config = (run.root / "config.yaml").read_text().replace("played_by: simulated", "played_by: web")
    (run.root / "config.yaml").write_text(config)
    export(RunDir.open(run.root), tmp_path / "out")
    said = json.loads((tmp_path / "out/croissant.json").read_text())
    assert "REAL DAYS ARE IN IT" in said["description"]
    assert "consented to" in said["license"]
    assert "REAL DAYS ARE IN IT" in (tmp_path / "out/hours/README.md").read_text()
