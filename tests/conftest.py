"""What all tests share. Property tests try the same cases in every run, however busy the machine is."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("coopera", deadline=None, derandomize=True)
settings.load_profile("coopera")


@pytest.fixture(scope="session")
def data_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One data folder for real runs, so that a text is encoded once for all of them."""
    return tmp_path_factory.getbasetemp() / "data"
