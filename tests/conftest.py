"""What all tests share. Property tests try the same cases in every run, however busy the machine is."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from tests.fakes import LetterEmbeddings

settings.register_profile("coopera", deadline=None, derandomize=True)
settings.load_profile("coopera")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with pages, whose tests take minutes: at the end one process would wait for the other's."""
    items.sort(key=lambda item: item.path.name != "test_pages.py")


@pytest.fixture(scope="session")
def vectors(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One cache of texts' vectors for all processes of these tests, so that a real run's text is encoded once."""
    own = tmp_path_factory.getbasetemp()
    return (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "vectors.sqlite"


@pytest.fixture(scope="session")
def data_dir(tmp_path_factory: pytest.TempPathFactory, vectors: Path) -> Path:
    """One data folder for real runs."""
    return with_vectors(tmp_path_factory.getbasetemp() / "data", vectors)


def with_vectors(data: Path, vectors: Path) -> Path:
    """Make a data folder whose cache of vectors is that of all tests."""
    data.mkdir()
    (data / "embeddings.sqlite").symlink_to(vectors)
    return data


@pytest.fixture(scope="module")
def letters(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A data folder whose runs compare texts by letters, for what does not depend on meaning.

    It is the module's own: an encoder stays open for all who name the same folder.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("coopera.studies.assemble.bundled", lambda path: LetterEmbeddings())
        yield tmp_path_factory.mktemp("letters")
