from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from coopera import Config, resume_study, run_study
from coopera.config.schema import Models
from coopera.core.errors import ConfigError, CooperaError
from coopera.rundir.directory import RunDir
from coopera.studies.several import run_studies
from tests.serving import serving
from tests.test_household import truth

SHORT = {"days": 1, "hours": 1, "pictures": "none"}
STUDIES = """
import json, sys
from pathlib import Path
from coopera import Config, run_studies

if __name__ == "__main__":
    folder, data_dir, processes = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    configs = [Config(humans=[who], days=1, hours=13, pictures="none", out=folder / who, data_dir=data_dir)
               for who in ("joan", "bruno")]
    run_studies(configs, processes=processes, on_event=lambda n, event: print(n, event["hour"], flush=True))
"""


@pytest.mark.slow
@pytest.mark.parametrize("processes", [1, 2])
def test_studies_at_once_are_the_same_as_each_alone_whichever_ends_first(
    tmp_path: Path, data_dir: Path, processes: int
) -> None:
    def study(name: str, **more: Any) -> Config:
        options = {"data_dir": data_dir, "cache": tmp_path / f"{name}.sqlite", "out": tmp_path / name}
        return Config(**{**SHORT, **options, **more})

    with serving("--latency", "0.02") as url:
        slow: dict[str, Any] = {"models": Models(human="openai:tiny", robot="openai:tiny"), "base_url": url}
        gone: dict[str, Any] = {"models": Models(human="openai:tiny"), "base_url": "http://127.0.0.1:9/v1"}
        gone["calls"] = {"retries": 0}
        told: set[int] = set()
        configs = [study("slow", **slow), study("gone", **gone), study("quick", humans=["bruno"], seed=3)]
        first, broken, quick = run_studies(configs, processes=processes, on_event=lambda n, event: told.add(n))
        assert told == {0, 1, 2}
        assert isinstance(broken, CooperaError)
        assert "cannot be asked" in str(broken)
        assert isinstance(first, dict)
        assert isinstance(quick, dict)
        run_study(study("alone", **slow))
        (tmp_path / "alone" / "config.yaml").write_bytes((tmp_path / "slow" / "config.yaml").read_bytes())
        assert truth(tmp_path / "alone") == truth(tmp_path / "slow")


@pytest.mark.slow
@pytest.mark.parametrize("processes", [1, 2])
def test_ctrl_c_stops_all_studies_so_that_they_can_be_resumed(tmp_path: Path, data_dir: Path, processes: int) -> None:
    root = Path(__file__).parents[3]
    script = tmp_path / "studies.py"
    script.write_text(STUDIES)
    command = [sys.executable, str(script), str(tmp_path), str(data_dir), str(processes)]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as work:
        assert work.stdout is not None
        begun: set[str] = set()
        while not begun >= {"0 10", "1 10"}:  # each is in its second hour
            begun.add(work.stdout.readline().strip())
            assert work.poll() is None
        work.send_signal(signal.SIGINT)
        work.communicate()
    assert work.returncode != 0
    for who in ("joan", "bruno"):
        info = json.loads((tmp_path / who / "run.json").read_text())
        assert (info["state"], info["reason"]) == ("stopped", "The run was interrupted.")
        done = len(RunDir.open(tmp_path / who).hours_done())
        assert 0 < done < 13
    assert resume_study(tmp_path / "joan")["hours"] == 13


def test_studies_that_would_share_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="a folder of its own"):
        run_studies([Config(out=tmp_path / "a"), Config(out=tmp_path / "a", seed=1)])
    with pytest.raises(ConfigError, match="a folder of its own"):
        run_studies([Config(out=None)])
    assert not (tmp_path / "a").exists()
