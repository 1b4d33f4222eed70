from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from coopera import Config, run_study
from coopera.config import Models
from coopera.studies import run_studies
from core.errors import ConfigError, CooperaError
from tests.serving import serving
from tests.test_household import truth


@pytest.mark.slow
def test_studies_at_once_are_the_same_as_each_alone_whichever_ends_first(tmp_path: Path, data_dir: Path) -> None:
    def study(name: str, **more: Any) -> Config:
        options = {"days": 1, "pictures": "none", "data_dir": data_dir, "cache": tmp_path / f"{name}.sqlite"}
        return Config(**{**options, "out": tmp_path / name, "hours": 1, **more})

    with serving("--latency", "0.02") as url:
        slow: dict[str, Any] = {"models": Models(human="openai:tiny", robot="openai:tiny"), "base_url": url}
        gone: dict[str, Any] = {"models": Models(human="openai:tiny"), "base_url": "http://127.0.0.1:9/v1"}
        gone["calls"] = {"retries": 0}
        told: set[int] = set()
        configs = [study("slow", **slow), study("gone", **gone), study("quick", humans=["bruno"], seed=3)]
        first, broken, quick = run_studies(configs, on_event=lambda n, event: told.add(n))
        assert told == {0, 1, 2}
        assert isinstance(broken, CooperaError)
        assert "cannot be asked" in str(broken)
        assert isinstance(first, dict)
        assert isinstance(quick, dict)
        run_study(study("alone", **slow))
        (tmp_path / "alone" / "config.yaml").write_bytes((tmp_path / "slow" / "config.yaml").read_bytes())
        assert truth(tmp_path / "alone") == truth(tmp_path / "slow")


def test_studies_that_would_share_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="a folder of its own"):
        run_studies([Config(out=tmp_path / "a"), Config(out=tmp_path / "a", seed=1)])
    with pytest.raises(ConfigError, match="a folder of its own"):
        run_studies([Config(out=None)])
    assert not (tmp_path / "a").exists()
