"""Household files that a run was begun with: named in run.json, and the same when it goes on."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from coopera.benchmark.grid_runs import claim_folder, plan, shared_config
from coopera.config.schema import Config, Models, load_config
from coopera.core.errors import ConfigError, RunError
from coopera.evaluation.grid import read_grid
from coopera.people.shipped import find
from coopera.prompts import PromptLibrary
from coopera.rundir.directory import RunDir
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


def test_a_run_from_before_there_was_a_choice_goes_on_with_the_persons_household_file(tmp_path: Path) -> None:
    config = resolve(
        Config(out=tmp_path / "run", data_dir=tmp_path, humans=["amara"], days=1, hours=1, pictures="none")
    )
    models = dict.fromkeys(("human", "robot", "judge"), "offline")
    people = [find("amara", config.data_dir)]
    with RunDir.create(config, people=people, prompts=PromptLibrary().hashes(), models=models):
        pass
    path = tmp_path / "run" / "config.yaml"
    told = path.read_text()
    path.write_text(told.replace("household: own\n", ""))
    assert path.read_text() != told
    assert load_config(path).household == "shared"
    assert RunDir.open(tmp_path / "run").config.household == "shared"
    resume_study(tmp_path / "run")
    assert RunDir.open(tmp_path / "run").state == "finished"
    study = tmp_path / "study.yaml"
    study.write_text(path.read_text())
    assert load_config(study).household == "own"


def test_a_benchmark_from_before_there_was_a_choice_goes_on_with_the_persons_household_file(tmp_path: Path) -> None:
    sizes = {"days": 1, "hours": 1, "episodes": 1, "seeds": 1}
    grid = read_grid({"settings": ["1"], "methods": ["random"], **sizes}, "the grid")

    def claim(household: str) -> None:
        config = shared_config(grid, None, {"data_dir": tmp_path, "household": household})
        claim_folder(plan(grid, tmp_path / "benchmark", config))

    claim("shared")
    path = tmp_path / "benchmark" / "grid.yaml"
    told = path.read_text()
    path.write_text(told.replace("  household: shared\n", ""))
    assert path.read_text() != told
    with pytest.raises(ConfigError, match="holds a grid with other shared"):
        claim("own")
    claim("shared")
