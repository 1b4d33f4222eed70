"""A classifier and a measure of one's own, a file or a registered value each, in whole runs with nothing faked."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path

import pytest
from rich.console import Console

from coopera import Config, RunDir, run_study
from coopera.core.errors import ConfigError
from coopera.evaluation import measuring, register_measure
from coopera.evaluation.counts import count
from coopera.evaluation.measuring import by_counts
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


def test_a_measure_in_one_file_and_one_that_is_registered_stand_wherever_the_shipped_ones_do(
    tmp_path: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = run_study(short(tmp_path / "plain", data_dir))
    with monkeypatch.context() as patch:
        shown = DOCS.read_text().split("```python\n")[1].split("```")[0]
        drop(patch, tmp_path, "coopera.evaluation.measures", "boldness", shown)
        patch.setattr(measuring._MEASURES, "_registered", {})
        register_measure(by_counts("parity", "every other is right", lambda hour: every_other(hour.candidates)))
        summary = run_study(short(tmp_path / "run", data_dir))
        run = RunDir.open(tmp_path / "run")
        (hour,), (day,) = run.hours(), summary["days"]
        assert hour.robot is not None
        offered, done = len(hour.robot.tasks), len(hour.robot.outcomes)
        assert offered >= done > 0
        right = count([task.accepted is True for task in hour.robot.tasks], every_other(hour.robot.tasks))

        success = json.loads((run.root / "trace/day-00/hour-09.json").read_text())["success"]
        assert success["boldness"] == {"offered": offered, "carried_out": done}
        assert success["parity"] == right.model_dump()

        rows = {row["measure"]: row for row in csv.DictReader(io.StringIO((run.root / "metrics.csv").read_text()))}
        assert list(rows) == ["predicate", "judge", "boldness", "parity"]
        assert (rows["boldness"]["carried_out"], rows["boldness"]["f1"]) == (str(done), "")
        assert rows["judge"]["offered"] == ""
        assert rows["parity"]["tp"] == str(right.tp)

        assert day["boldness"] == {"offered": offered, "carried_out": done, "share": done / offered}
        assert day["parity"] == right.model_dump()
        assert set(summary["agreement"]) == {"predicate", "judge", "parity"}
        assert all(day[name] == plain["days"][0][name] for name in ("predicate", "judge", "help", "people"))

        page, said = (run.root / "report.html").read_text(), Console(record=True, width=200)
        days_table(summary, run.root, said)
        print_trees(run, 0, 9, said)
        text = said.export_text()
        for title, figure in (("boldness", done / offered), ("parity F1", right.f1)):
            assert title in page
            assert title in text
            assert f"<b>{figure:.3f}</b>" in page
            assert f"{figure:.3f}" in text
        assert f"offered {offered}, carried_out {done}" in text
        assert 'title="share of its ideas that the robot carried out"' in page

    assert RunDir.open(tmp_path / "run").hours() == [hour]  # read where nobody knows the measures any longer
    assert set(RunDir.open(tmp_path / "run").summary()["days"][0]) == set(plain["days"][0])
