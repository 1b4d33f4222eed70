from __future__ import annotations

from pathlib import Path

import pytest

from coopera.config.schema import load_config
from coopera.simulation.drawing import context
from coopera.studies.catalogues import resolve


def test_a_run_of_an_earlier_version_goes_on_with_the_renderer_it_had(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text("seed: 3\n")
    assert load_config(tmp_path / "config.yaml").renderer == "auto"  # a study file
    (tmp_path / "run.json").write_text("{}")
    assert load_config(tmp_path / "config.yaml").renderer == "tiny"


@pytest.mark.parametrize("name", ["auto", "gl", "tiny", "egl"])
def test_every_name_of_a_renderer_is_taken(name: str) -> None:
    assert load_config(None, {"renderer": name}).renderer == name


def test_a_run_writes_down_who_draws_it_and_one_without_pictures_asks_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(context, "_drawers", [])
    monkeypatch.setattr(context, "_context", lambda: (None, "there is none"))
    assert resolve(load_config(None, {"renderer": "auto"})).renderer == "tiny"
    monkeypatch.setattr(context, "problem", lambda: pytest.fail("asked"))
    assert resolve(load_config(None, {"renderer": "auto", "pictures": "none"})).renderer == "auto"
