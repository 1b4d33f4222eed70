"""A classifier of one's own, one file or one registered value, in a whole run with nothing faked."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera import Config, RunDir, run_study
from coopera.core.errors import ConfigError
from coopera.models.classifiers import ClassifierSpec, register_classifier, registry
from coopera.studies.catalogues import resolve
from tests.dropped import drop
from tests.fakes import TableClassifier

CLASSIFIER = """
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
