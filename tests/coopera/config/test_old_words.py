"""What settings were called before still works for a version, and says what they are called now."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.benchmark.grid_runs import load_grid, shared_config
from coopera.config.schema import Config, load_config
from coopera.core.errors import ConfigError, OldWordWarning
from coopera.rundir.directory import RunDir
from tests.coopera.conftest import Said
from tests.coopera.fake_run import fake_run

OLD = [
    ("human", "played_by", "me"),
    ("person", "person_model", "single_shot"),
    ("who", "identity", "unknown"),
    ("lived", "earlier_life", "a/run"),
]


def sentence(old: str, new: str) -> str:
    return re.escape(f"{old} is deprecated and goes in version 0.3: use {new}.")


@pytest.mark.parametrize(("old", "new", "value"), OLD)
def test_a_study_file_may_use_the_old_name(tmp_path: Path, old: str, new: str, value: str) -> None:
    path = tmp_path / "study.yaml"
    path.write_text(f"{old}: {value}\n")
    with pytest.warns(OldWordWarning, match=sentence(f"the setting {old}", new)):
        found = load_config(path)
    assert str(getattr(found, new)) == value


@pytest.mark.parametrize(("old", "new", "value"), OLD)
def test_a_file_with_both_names_is_refused(tmp_path: Path, old: str, new: str, value: str) -> None:
    path = tmp_path / "study.yaml"
    path.write_text(f"{old}: {value}\n{new}: {value}\n")
    with pytest.raises(ConfigError, match=rf"study\.yaml: {old} and {new} are one setting, and only {new} may be"):
        load_config(path)


def test_python_may_use_the_old_name() -> None:
    with pytest.warns(OldWordWarning, match=sentence("the setting human", "played_by")):
        assert Config.model_validate({"human": "me"}).played_by == "me"


def test_a_run_of_the_version_before_can_be_opened(tmp_path: Path) -> None:
    fake_run(tmp_path / "run", days=1, hours=1, frames=1)
    path = tmp_path / "run" / "config.yaml"
    text = path.read_text()
    for old, new, _ in OLD:
        text = text.replace(f"{new}: ", f"{old}: ")
    assert "person_model" not in text
    path.write_text(text)
    with pytest.warns(OldWordWarning) as said:
        config = RunDir.open(tmp_path / "run").config
    assert (config.played_by, config.person_model) == ("simulated", "full")
    assert len(said) == len(OLD)


def test_a_grid_file_may_use_the_old_name(tmp_path: Path) -> None:
    path = tmp_path / "grid.yaml"
    path.write_text("run: {person: single_shot}\n")
    with pytest.warns(OldWordWarning, match=sentence("the setting person", "person_model")):
        grid = load_grid(path, {})
    assert shared_config(grid, path, {}).person_model == "single_shot"


@pytest.mark.filterwarnings("default::coopera.core.errors.OldWordWarning")
@pytest.mark.parametrize(("old", "new", "value"), [("--who", "--identity", "x"), ("--human", "--played-by", "x")])
def test_an_old_flag_sets_the_setting_and_says_once_that_it_goes(
    coopera: Callable[..., Said], old: str, new: str, value: str
) -> None:
    said = coopera("run", old, value)
    assert said.code == 2
    first, second = said.err.splitlines()
    assert first == f"coopera: {old} is deprecated and goes in version 0.3: use {new}."
    assert second.startswith(f"coopera: {new} must be ")


def test_an_old_flag_beside_the_new_one_is_refused(coopera: Callable[..., Said]) -> None:
    said = coopera("run", "--person", "full", "--person-model", "full")
    assert (said.code, said.err) == (
        2, "coopera: --person and --person-model are one setting, and only --person-model may be given.\n",
    )  # fmt: skip


def test_help_does_not_show_old_flags(coopera: Callable[..., Said]) -> None:
    shown = coopera("run", "--help").out.split()
    assert not {"--human", "--person", "--who", "--lived"} & set(shown)
    assert {"--played-by", "--person-model", "--identity", "--earlier-life", "--humans"} <= set(shown)
