"""People and homes given as files: wherever an id may stand, and kept in the run."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from coopera.config.schema import Config, load_config
from coopera.core.errors import ConfigError
from coopera.people.shipped import SHIPPED as PERSONAS
from coopera.simulation.homes.scene import SHIPPED as HOMES
from coopera.studies.catalogues import resolve
from coopera.studies.study import new_run, plan_days
from tests.coopera.conftest import Said

Cli = Callable[..., Said]


@pytest.fixture
def me(tmp_path: Path) -> Path:
    path = tmp_path / "own" / "me.yaml"
    path.parent.mkdir()
    path.write_text((PERSONAS / "joan.yaml").read_text().replace("id: joan", "id: me"))
    return path


@pytest.fixture
def flat(tmp_path: Path) -> Path:
    path = tmp_path / "my flat.json"
    path.write_text((HOMES / "pine.json").read_text().replace('"id": "pine"', '"id": "flat"'))
    return path


def test_files_become_the_ids_in_them(me: Path, flat: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    config = resolve(Config(humans=["own/me.yaml"], scenes=["./my flat.json"], data_dir=tmp_path / "data"))
    assert (config.humans, config.scenes) == (["me"], ["flat"])
    assert (config.files.humans, config.files.scenes) == ({"me": me}, {"flat": flat})
    assert {(plan.person, plan.scene) for plan in plan_days(config)} == {("me", "flat")}
    assert resolve(config) == config.model_copy(update={"out": resolve(config).out})


def test_a_schedule_may_name_files(me: Path, flat: Path, tmp_path: Path) -> None:
    config = resolve(Config(schedule=[(str(me), "maple"), ("amara", str(flat)), (str(me), str(flat))]))
    assert config.schedule == [("me", "maple"), ("amara", "flat"), ("me", "flat")]
    assert (config.humans, config.scenes, config.days) == (["me", "amara"], ["maple", "flat"], 3)


def test_the_run_keeps_them_and_needs_the_files_no_more(me: Path, flat: Path, tmp_path: Path) -> None:
    config = Config(
        humans=[str(me)], scenes=[str(flat)], pictures="none", out=tmp_path / "run", data_dir=tmp_path / "data"
    )
    with new_run(config) as (run, services):
        me.unlink()
        flat.unlink()
        assert services.people["me"].name == "Joan Whitaker"
        assert run.people()["me"].id == "me"
        assert json.loads((run.root / "scenes" / "flat.json").read_text())["id"] == "flat"
        rooms = {room for _, room in services.home("flat").objects("fixed").values()}
        assert "kitchen" in " ".join(rooms)
    assert load_config(run.root / "config.yaml").files.humans == {"me": me}


def test_two_who_are_called_the_same_are_refused(me: Path, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    again = shutil.copy(me, tmp_path / "other" / "me.yaml")
    with pytest.raises(ConfigError, match=r"humans: .*other/me.yaml and .*own/me.yaml are both called 'me'"):
        resolve(Config(humans=[str(me), str(again)], setting=1))
    amara = shutil.copy(PERSONAS / "amara.yaml", tmp_path / "amara.yaml")
    with pytest.raises(ConfigError, match=r"humans: .*amara.yaml and amara are both called 'amara'"):
        resolve(Config(humans=["amara", str(amara)]))


@pytest.mark.parametrize(
    ("text", "good"),
    [
        ((PERSONAS / "joan.yaml").read_text(), True),
        ((PERSONAS / "joan.yaml").read_text().replace("id: joan", "id: jo"), False),
        ((PERSONAS / "joan.yaml").read_text().replace("name:", "title:"), False),
        ("profile: [", False),
        ("id: joan", False),
        ("", False),
        (None, False),
    ],
)
def test_check_and_run_refuse_the_same_people(coopera: Cli, tmp_path: Path, text: str | None, good: bool) -> None:
    if text is not None:
        (tmp_path / "joan.yaml").write_text(text)
    checked = coopera("humans", "check", tmp_path / "joan.yaml")
    said = coopera("run", "--humans", tmp_path / "joan.yaml", "--prompts", "missing")
    if good:
        assert checked.code == 0
        assert "prompts: missing must be a folder" in said.err
    else:
        assert (checked.code, said.code) == (2, 2)
        assert said.err == checked.err


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (["--humans", "rows.csv"], "rows.csv is a table; `coopera humans import"),
        (["--scenes", "missing.json"], "missing.json: there is no such scene file"),
        (["--scenes", "broken.json"], "broken.json, line 1, is not valid JSON"),
        (["--scenes", "empty.json"], "empty.json, field id: Field required"),
    ],
)
def test_a_file_that_cannot_be_used_is_one_sentence_and_exit_code_2(
    coopera: Cli, tmp_path: Path, args: list[str], sentence: str
) -> None:
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "empty.json").write_text("{}")
    said = coopera("run", *args)
    assert (said.code, said.err.count("\n")) == (2, 1)
    assert sentence in said.err
