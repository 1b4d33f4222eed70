"""The vectors of a store: each text's once, whoever says it."""

from __future__ import annotations

from pathlib import Path

import chromadb
import numpy as np
import pytest

from coopera.memory import MemoryStream
from coopera.memory.vectors import repeated
from tests.memory.fakes import Letters

TEXTS = ["tea", "read", "tea"]


def lived(folder: Path) -> list[tuple[str, float]]:
    with MemoryStream.open(folder, "x", Letters()) as one, MemoryStream.open(folder, "y", Letters()) as other:
        for hour in range(3):
            one.add(TEXTS, hour)
            other.add(["tea"], hour)
        return [(found.text, found.score) for found in one.recall("eat", 4, 9)]


def rows(folder: Path) -> dict[str, tuple[int, int]]:
    """By kind of collection, how many rows there are and how many numbers a vector has."""
    client = chromadb.PersistentClient(str(folder))
    found: dict[str, tuple[int, int]] = {}
    for collection in client.list_collections():
        kept = collection.get(include=["embeddings"])["embeddings"]
        assert kept is not None
        kind = collection.name.partition("-")[0]
        found[kind] = (found.get(kind, (0, 0))[0] + len(kept), len(kept[0]))
    return found


def test_what_is_said_again_and_again_has_its_vector_stored_once(tmp_path: Path) -> None:
    lived(tmp_path / "m")
    dimension = len(Letters().embed_query("a"))
    assert rows(tmp_path / "m") == {"stream": (12, 1), "vectors": (2, dimension)}


def test_a_stream_of_before_is_gone_on_with_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Then each record had its vector in the stream's own collection."""
    expected = lived(tmp_path / "new")
    monkeypatch.setattr("coopera.memory.store._FORMAT", 1)
    assert lived(tmp_path / "old") == expected
    monkeypatch.undo()
    for folder in ("new", "old"):
        with MemoryStream.open(tmp_path / folder, "x", Letters()) as stream:
            stream.add(["eat"], 5)
    with (
        MemoryStream.open(tmp_path / "new", "x", Letters()) as new,
        MemoryStream.open(tmp_path / "old", "x", Letters()) as old,
    ):
        assert new.recall("eat", 6, 9) == old.recall("eat", 6, 9)
    assert rows(tmp_path / "old") == {"stream": (13, len(Letters().embed_query("a")))}


def test_vectors_held_once_come_out_bit_for_bit() -> None:
    some = np.array([[0.0, 1.0], [-0.0, 1.0], [0.5, 0.25], [0.0, 1.0]], np.float32)
    held = repeated(some)
    assert len(held.rows) == 3
    assert held[slice(0, 4)].tobytes() == some.tobytes()
    assert held[slice(1, 3)].tobytes() == some[1:3].tobytes()
