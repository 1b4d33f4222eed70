"""A classifier and a measure of one's own, a file or a registered value each, in whole runs with nothing faked."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from coopera import Config, RunDir, run_study
from coopera.core.errors import ConfigError
from coopera.evaluation import find_measure, measures, measuring, register_measure
from coopera.evaluation.counts import count
from coopera.evaluation.measuring import all_measures, by_counts
from coopera.evaluation.results import rows_of, to_csv
from coopera.models.classifiers import ClassifierSpec, register_classifier, registry
from coopera.report.progress import days_table
from coopera.report.tree import print_trees
from coopera.studies.catalogues import resolve
from tests.dropped import drop
from tests.fakes import TableClassifier

DOCS = Path(__file__).parents[1] / "docs" / "measures.md"
CLASSIFIER = """
from coopera.evaluation import measuring, register_measure
from coopera.evaluation.counts import count
from coopera.evaluation.measuring import by_counts
from coopera.models.classifiers import ClassifierSpec

class Settled:
    def __init__(self, wanted): self._kind = wanted.kind
    def probabilities(self, examples): return [0.875 if self._kind == "intention" else 0.125] * len(examples)
    def train(self, examples, *, seed): return {"heard": len(examples)}
    def save(self, folder): (folder / "mind.txt").write_text("made up")
    def load(self, folder): pass

CLASSIFIER = ClassifierSpec("made-up", "has made up its mind", Settled)
"""


def short(out: Path, data_dir: Path, **changes: object) -> Config:
    """One day of one hour without pictures."""
    return Config.model_validate(
        {"days": 1, "hours": 1, "pictures": "none", "out": out, "data_dir": data_dir, **changes}
    )


def every_other(candidates: Sequence[object]) -> list[bool]:
    return [number % 2 == 0 for number in range(len(candidates))]


def test_a_classifier_in_one_file_judges_learns_and_is_saved(
    tmp_path: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drop(monkeypatch, tmp_path, "coopera.models.classifiers.shipped", "made_up", CLASSIFIER)
    run_study(short(tmp_path / "run", data_dir, classifier="made-up"))
    run = RunDir.open(tmp_path / "run")
    (hour,), (evening,) = run.hours(), run.evenings()
    assert hour.robot is not None
    assert {guess.probability for guess in hour.robot.intentions} == {0.875}
    assert {(task.probability, task.accepted) for task in hour.robot.tasks} == {(0.125, False)}
    assert evening.learned["intention"]["heard"] == evening.learned["intention"]["examples"]
    assert (run.root / "adapters/day-00/task/mind.txt").read_text() == "made up"


def test_a_recipe_is_checked_by_the_classifier_that_takes_it(
    tmp_path: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def check(path: Path) -> None:
        raise ConfigError(f"{path}: too much salt.")

    monkeypatch.setattr(registry._CLASSIFIERS, "_registered", {})
    register_classifier(ClassifierSpec("cook", "tastes", lambda _: TableClassifier(), check_recipe=check))
    with pytest.raises(ConfigError, match=r"soup.yaml: too much salt"):
        resolve(short(tmp_path / "run", data_dir, classifier="cook", classifier_config="soup.yaml"))
    with pytest.raises(ConfigError, match="classifier_config: the classifier kernel takes no recipe file"):
        resolve(short(tmp_path / "run", data_dir, classifier_config="soup.yaml"))


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory, data_dir: Path) -> dict[str, Any]:
    """The summary of the run by the shipped measures alone."""
    return run_study(short(tmp_path_factory.mktemp("plain") / "run", data_dir))


@pytest.fixture
def as_shipped() -> Iterator[None]:
    """Without the measures that `measured` adds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measuring._MEASURES, "_registered", {})
        patch.setattr(measures, "__path__", measures.__path__[:1])
        yield


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory, plain: dict[str, Any], data_dir: Path) -> Iterator[RunDir]:
    """The run again, measured by a file in the folder, which is the documentation's, and by a registered value, too."""
    folder = tmp_path_factory.mktemp("measured")
    with pytest.MonkeyPatch.context() as patch:
        shown = DOCS.read_text().split("```python\n")[1].split("```")[0]
        drop(patch, folder, "coopera.evaluation.measures", "boldness", shown)
        patch.setattr(measuring._MEASURES, "_registered", {})
        register_measure(by_counts("parity", "every other is right", lambda hour: every_other(hour.candidates)))
        run_study(short(folder / "run", data_dir))
        yield RunDir.open(folder / "run")


def figures(run: RunDir) -> tuple[dict[str, int], dict[str, Any]]:
    """What the two should have measured."""
    (hour,) = run.hours()
    assert hour.robot is not None
    offered, done = len(hour.robot.tasks), len(hour.robot.outcomes)
    assert offered >= done > 0
    truth = every_other(hour.robot.tasks)
    right = count([task.accepted is True for task in hour.robot.tasks], truth)
    return {"offered": offered, "carried_out": done}, {**right.model_dump(), "verdicts": truth}


def test_ones_own_measures_stand_in_the_trace_under_their_names(measured: RunDir) -> None:
    success = json.loads((measured.root / "trace/day-00/hour-09.json").read_text())["success"]
    assert (success["boldness"], success["parity"]) == figures(measured)
    assert set(success) == {one.name for one in all_measures() if one.measure}
    assert set(success) >= {"predicate", "judge", "similar", "help", "boldness", "parity"}


def test_ones_own_measures_are_rows_of_metrics_csv(measured: RunDir) -> None:
    bold, right = figures(measured)
    rows = {row["measure"]: row for row in csv.DictReader(io.StringIO((measured.root / "metrics.csv").read_text()))}
    assert list(rows) == [one.name for one in all_measures() if one.row is None]
    assert {"boldness", "parity"} <= set(rows)
    assert (rows["boldness"]["carried_out"], rows["boldness"]["f1"]) == (str(bold["carried_out"]), "")
    assert (rows["parity"]["tp"], rows["parity"]["offered"]) == (str(right["tp"]), "")


def test_ones_own_measures_are_figures_of_each_day_of_the_summary(measured: RunDir, plain: dict[str, Any]) -> None:
    bold, right = figures(measured)
    summary = json.loads((measured.root / "summary.json").read_text())
    (day,) = summary["days"]
    assert day["boldness"] == {**bold, "share": bold["carried_out"] / bold["offered"]}
    del right["verdicts"]  # of one hour
    assert day["parity"] == right
    assert set(summary["agreement"]) == {"predicate", "judge", "similar", "parity"}
    assert all(day[name] == plain["days"][0][name] for name in ("predicate", "judge", "help", "people"))


def test_ones_own_measures_are_in_the_tables_of_run_trace_and_report(measured: RunDir) -> None:
    bold, right = figures(measured)
    page, said = (measured.root / "report.html").read_text(), Console(record=True, width=200)
    days_table(measured.summary(), measured.root, said)
    print_trees(measured, 0, 9, said)
    text = said.export_text()
    for title, figure in (("boldness", bold["carried_out"] / bold["offered"]), ("parity F1", right["f1"])):
        assert title in page
        assert title in text
        assert f"<b>{figure:.3f}</b>" in page
        assert f"{figure:.3f}" in text
    assert f"offered {bold['offered']}, carried_out {bold['carried_out']}" in text
    assert 'title="share of its ideas that the robot carried out"' in page


def test_ones_own_measures_are_columns_of_a_benchmarks_table(measured: RunDir) -> None:
    labels = {"method": "ours", "setting": "1", "collab": 2, "seed": 0, "episode": 0}
    (row,) = rows_of(measured.hours(), measured.evenings(), lambda _: "rest", labels)
    assert row.of(find_measure("boldness")).model_dump() == figures(measured)[0]
    assert to_csv([row]).splitlines()[0].count("parity_") == 5


def test_a_run_is_read_where_nobody_knows_its_measures_any_longer(
    measured: RunDir, plain: dict[str, Any], as_shipped: None
) -> None:
    again = RunDir.open(measured.root)
    assert again.hours() == measured.hours()
    assert set(again.summary()["days"][0]) == set(plain["days"][0])
