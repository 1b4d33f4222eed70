"""Household files that a run was begun with: named in run.json, and the same when it goes on."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest
import yaml

from coopera.benchmark.grid_runs import claimed_folder, plan, shared_config
from coopera.config.schema import Config, Models, load_config
from coopera.core.errors import ConfigError, RunError
from coopera.evaluation.grid import read_grid
from coopera.people.shipped import find
from coopera.prompts import PromptLibrary
from coopera.rundir.directory import RunDir
from coopera.rundir.earlier_life import open_earlier_life
from coopera.studies.catalogues import resolve
from coopera.studies.study import knowledge_of, resume_study


def test_a_run_whose_household_file_has_changed_is_not_resumed(tmp_path: Path) -> None:
    own = tmp_path / "own.yaml"
    own.write_text("extends: shipped\n")
    spec = f"offline:{own}"
    config = resolve(Config(out=tmp_path / "run", models=Models(human=spec), data_dir=tmp_path))
    known = knowledge_of({"human": spec}, "own")
    with RunDir.create(config, people=[], prompts=PromptLibrary().hashes(), models={"human": spec}, knowledge=known):
        pass
    own.write_text("extends: shipped\nlooks_like: {}\n")
    with pytest.raises(RunError, match="the household file has changed since this run began"):
        resume_study(tmp_path / "run")


def test_a_run_says_which_household_file_its_robot_read_and_goes_on_with_that_one_only(tmp_path: Path) -> None:
    own = tmp_path / "own.yaml"
    own.write_text("extends: shipped\n")
    models = {"human": "offline", "robot": "offline", "judge": "openai:x"}
    assert knowledge_of(models, "shared") == {}
    assert list(knowledge_of(models, "own")) == ["household: own"]
    assert knowledge_of(dict.fromkeys(("robot", "judge"), "openai:x"), "own") == {}
    assert list(knowledge_of({"robot": f"offline:{own}", "judge": "offline:words"}, "own")) == [
        f"offline:{own}",
        "household: own",
    ]
    config = resolve(Config(out=tmp_path / "run", household=str(own), data_dir=tmp_path))
    known = knowledge_of(models, config.household)
    with RunDir.create(config, people=[], prompts=PromptLibrary().hashes(), models=models, knowledge=known) as run:
        said = json.loads((run.root / "run.json").read_text())["knowledge"]
        assert said == {f"household: {own}": hashlib.sha256(own.read_bytes()).hexdigest()}
    own.write_text("extends: shipped\nlooks_like: {}\n")
    with pytest.raises(RunError, match="the household file has changed since this run began"):
        resume_study(tmp_path / "run")


def test_a_run_from_before_there_was_a_choice_goes_on_as_it_was_made(tmp_path: Path) -> None:
    config = resolve(
        Config(out=tmp_path / "run", data_dir=tmp_path, humans=["amara"], days=1, hours=1, pictures="none")
    )
    models = dict.fromkeys(("human", "robot", "judge"), "offline")
    people = [find("amara", config.data_dir)]
    with RunDir.create(config, people=people, prompts=PromptLibrary().hashes(), models=models):
        pass
    path = tmp_path / "run" / "config.yaml"
    told = path.read_text()
    later = ("household:", "intentions:", "absence:", "changes:", "feedback_rate:", "feedback_noise:")
    path.write_text("".join(line for line in told.splitlines(keepends=True) if not line.startswith(later)))
    (tmp_path / "run" / "seal.json").unlink()  # such a run has none
    assert len(path.read_text().splitlines()) == len(told.splitlines()) - len(later)
    assert load_config(path).household == "shared"
    config = RunDir.open(tmp_path / "run").config
    assert (config.household, config.intentions, config.absence, config.changes) == ("shared", "hourly", "none", "none")
    assert (config.feedback_rate, config.feedback_noise) == (1.0, 0.0)
    resume_study(tmp_path / "run")
    assert RunDir.open(tmp_path / "run").state == "finished"
    study = tmp_path / "study.yaml"
    study.write_text(path.read_text())
    assert (load_config(study).household, load_config(study).intentions) == ("own", "lasting")


def test_a_run_whose_file_of_changes_has_changed_is_not_resumed(tmp_path: Path) -> None:
    own = tmp_path / "changes.yaml"
    own.write_text("changes: [{text: I have the flu, day: 0}]\n")
    config = resolve(Config(out=tmp_path / "run", changes=str(own), data_dir=tmp_path))
    known = knowledge_of({}, config.household, config.changes)
    assert known == {f"changes: {own}": hashlib.sha256(own.read_bytes()).hexdigest()}
    with RunDir.create(config, people=[], prompts=PromptLibrary().hashes(), models={}, knowledge=known):
        pass
    own.write_text("changes: []\n")
    with pytest.raises(RunError, match="the file of changes has changed since this run began; restore it to go on"):
        resume_study(tmp_path / "run")
    own.unlink()
    with pytest.raises(ConfigError, match=r"changes\.yaml: the file of changes cannot be read"):
        resume_study(tmp_path / "run")


@pytest.mark.parametrize("changes", ["none", "seeded"])
def test_without_a_file_of_changes_there_is_none_to_be_the_same(changes: str) -> None:
    assert knowledge_of({}, "own", changes) == {}


def test_a_benchmark_from_before_there_was_a_choice_goes_on_only_as_it_was_made(tmp_path: Path) -> None:
    sizes = {"days": 1, "hours": 1, "episodes": 1, "seeds": 1}

    def claim(**run: str) -> None:
        grid = read_grid({"settings": ["1"], "methods": ["random"], **sizes, "run": run}, "the grid")
        with claimed_folder(plan(grid, tmp_path / "benchmark", shared_config(grid, None, {"data_dir": tmp_path}))):
            pass

    claim(household="shared", intentions="hourly")
    path = tmp_path / "benchmark" / "grid.yaml"
    told = yaml.safe_load(path.read_text())
    told["run"] = {}
    for later in ("household", "intentions"):
        del told["shared"][later]
    path.write_text(yaml.safe_dump(told))
    for other in ({}, {"household": "shared"}, {"intentions": "hourly"}):
        with pytest.raises(ConfigError, match="holds a grid with other shared"):
            claim(**other)
    claim(household="shared", intentions="hourly")


def test_a_life_is_met_again_only_by_people_who_live_as_they_did(tmp_path: Path) -> None:
    base = Config(humans=["amara"], scenes=["maple"], days=1, hours=1, data_dir=tmp_path)
    life = base.model_copy(update={"out": tmp_path / "life", "method": "none", "absence": "named"})
    with RunDir.create(life, people=[], prompts={}, models={}) as run:
        run.finish()
    met = base.model_copy(update={"earlier_life": tmp_path / "life"})
    with pytest.raises(ConfigError, match="has absence named, where this run has none"):
        open_earlier_life(met)
    assert open_earlier_life(met.model_copy(update={"absence": "named"})) is not None
    with pytest.raises(ConfigError, match="has person_memory today, where this run has days"):
        open_earlier_life(met.model_copy(update={"absence": "named", "person_memory": "days"}))
