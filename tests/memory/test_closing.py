"""Chroma's pool of connections may come to run without end; a store then lets go of it all the same."""

from __future__ import annotations

import hashlib
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from coopera.memory import MemoryStream
from tests.memory.fakes import Letters

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells which threads run")


@contextmanager
def running(name: str) -> Iterator[None]:
    """A thread of this name that computes until the end of the block."""
    begun, ended = threading.Event(), threading.Event()

    def compute() -> None:
        Path(f"/proc/self/task/{threading.get_native_id()}/comm").write_text(name)
        begun.set()
        while not ended.is_set():
            hashlib.sha256(bytes(2**27))

    thread = threading.Thread(target=compute)
    thread.start()
    begun.wait()
    yield
    ended.set()
    thread.join()


def closed(folder: Path) -> tuple[Any, int]:
    """What a store was that is closed now, and how many refer to it."""
    stream = MemoryStream.open(folder, "a", Letters())
    stream.add(["bread"], hour=len(stream))
    bindings = stream._store._client._server.bindings
    stream.close()
    return bindings, sys.getrefcount(bindings)


def test_a_pool_that_never_rests_is_left_until_the_process_ends_and_one_that_rests_is_not(tmp_path: Path) -> None:
    _, usual = closed(tmp_path)
    with running("tokio-rt-worker"):
        _, left = closed(tmp_path)
    assert left == usual + 1
    with running("another"):
        assert closed(tmp_path)[1] == usual
    with MemoryStream.open(tmp_path, "a", Letters()) as stream:
        assert [record.text for record in stream.records()] == ["bread"] * 3
