"""The vectors of a store: each text's once, whoever says it."""

from __future__ import annotations

import sqlite3
from contextlib import ExitStack, closing
from pathlib import Path

import chromadb
import numpy as np
import pytest

from coopera.memory import MemoryStream
from coopera.memory.rebuild import texts
from coopera.memory.vectors import Held, Table
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


def documents(folder: Path) -> int:
    """Of how many texts Chroma has an index of all their pieces."""
    with closing(sqlite3.connect(folder / "chroma.sqlite3")) as database:
        found: int = database.execute("SELECT count(*) FROM embedding_fulltext_search").fetchone()[0]
    return found


def entries(folder: Path) -> int:
    """How many entries Chroma keeps of all records, each of which is in an index of its own."""
    with closing(sqlite3.connect(folder / "chroma.sqlite3")) as database:
        found: int = database.execute("SELECT count(*) FROM embedding_metadata").fetchone()[0]
    return found


def test_what_is_said_again_and_again_has_its_vector_stored_once(tmp_path: Path) -> None:
    lived(tmp_path / "m")
    dimension = len(Letters().embed_query("a"))
    assert rows(tmp_path / "m") == {"stream": (12, 1), "vectors": (2, dimension)}


@pytest.mark.parametrize("format_", [1, 2, 3])
def test_a_stream_of_before_is_gone_on_with_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, format_: int
) -> None:
    """At first each record had its vector in the stream's own collection, then a document, then three entries."""
    expected = lived(tmp_path / "new")
    monkeypatch.setattr("coopera.memory.store.FORMAT", format_)
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
    dimension = len(Letters().embed_query("a"))
    assert rows(tmp_path / "old") == (
        {"stream": (13, dimension)} if format_ == 1 else {"stream": (13, 1), "vectors": (3, dimension)}
    )
    assert (documents(tmp_path / "old"), documents(tmp_path / "new")) == (13 if format_ < 3 else 0, 0)
    assert (entries(tmp_path / "old"), entries(tmp_path / "new")) == (13 * (4 if format_ < 3 else 3), 13)
    assert texts(tmp_path / "old") == texts(tmp_path / "new")


def test_vectors_held_once_come_out_bit_for_bit() -> None:
    some = np.array([[0.0, 1.0], [-0.0, 1.0], [0.5, 0.25], [0.0, 1.0]], np.float32)
    table = Table()
    held = Held(table, table.hold(some))
    assert len(table) == 3
    assert held.array().tobytes() == some.tobytes()
    assert held[1:3].array().tobytes() == some[1:3].tobytes()
    different, of = held.different()
    assert different[of].tobytes() == some.tobytes()


def test_a_table_lets_go_of_what_nobody_holds_and_uses_its_place_again() -> None:
    table = Table()
    kept = table.hold(np.eye(3, dtype=np.float32))
    for number in range(2000):
        gone = table.hold(np.array([[number, 2.0, 1.0], [0.0, 1.0, 0.0]], np.float32))
        assert len(table) == 4
        table.let_go(gone)
    assert Held(table, kept).array().tobytes() == np.eye(3, dtype=np.float32).tobytes()
    assert len(table.rows) < 1000


def test_what_a_long_life_says_again_is_in_ram_once_for_all_streams(tmp_path: Path) -> None:
    texts = ["a" * one + "b" * other + "c" for one in range(5) for other in range(6)]
    names = ("told", "lived", "guessed")
    with ExitStack() as stack:
        streams = [stack.enter_context(MemoryStream.open(tmp_path, name, Letters(), durable=False)) for name in names]
        for hour in range(150):
            for stream in streams:
                stream.add(texts, hour)
        table = streams[0]._open_log._table
        assert all(stream._open_log._table is table for stream in streams)
        assert len(table) == len(texts), "of 13,500 records"
        streams[1].close()
        assert [len(stream.recall("ab", 150, 5)) for stream in (streams[0], streams[2])] == [5, 5]
    assert not len(table)


def test_connections_to_a_store_are_told_to_keep_little_of_it_in_ram(tmp_path: Path) -> None:
    """SQLite's own measure is 2 MB for each of Chroma's connections, which a long life fills."""

    def pages() -> int:
        with closing(sqlite3.connect(tmp_path / "chroma.sqlite3")) as database:
            return int(database.execute("PRAGMA default_cache_size").fetchone()[0])

    with MemoryStream.open(tmp_path, "x", Letters()) as stream:
        stream.add(["a"], 0)
    assert pages() == 100
    with closing(sqlite3.connect(tmp_path / "chroma.sqlite3")) as database:
        database.execute("PRAGMA default_cache_size = 2000")  # as in a store of before
    with MemoryStream.open(tmp_path, "x", Letters()) as stream:
        assert [one.text for one in stream.recall("a", 0, 1)] == ["a"]
    assert pages() == 100


def test_an_opening_that_was_killed_as_it_began_is_done_again(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "chroma.sqlite3")) as database:
        database.execute("PRAGMA default_cache_size = 100")
    with MemoryStream.open(tmp_path, "x", Letters()) as stream:
        stream.add(["a"], 0)
        assert len(stream) == 1
