from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.studies.replay import film_into


def test_frames_are_not_filmed_into_a_file(tmp_path: Path) -> None:
    (tmp_path / "notes").write_text("mine")
    with pytest.raises(ConfigError, match="--frames: .*notes must be a folder, and it is a file"):
        film_into(tmp_path / "notes", 8)
    film_into(tmp_path / "new", 8)
    assert not (tmp_path / "new").exists()
