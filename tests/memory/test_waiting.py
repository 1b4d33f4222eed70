"""A stream that need not be durable: what it was given is recalled at once, and reaches the disk later, in order."""

from __future__ import annotations

import os
import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from coopera.core.errors import MemoryStoreError
from coopera.memory import MemoryStream, Record
from coopera.memory.rebuild import texts
from coopera.memory.store import Store
from tests.memory.fakes import Letters

DAY = [Record(f"abcd {hour} {n}", hour, {"n": n}) for hour in range(13) for n in range(3)]


def opened(folder: Path, name: str = "x", *, durable: bool = False) -> MemoryStream:
    return MemoryStream.open(folder, name, Letters(), durable=durable)


def on_disk(folder: Path) -> dict[str, list[Record]]:
    """What a crash would leave; of a copy, since two libraries of SQLite may not have one database open."""
    copy = folder.with_name(f"{folder.name}-copy")
    shutil.copytree(folder, copy)
    try:
        return texts(copy)
    finally:
        shutil.rmtree(copy)


def test_what_waits_is_recalled_and_read_as_if_it_were_on_disk(tmp_path: Path) -> None:
    with opened(tmp_path / "waiting") as one, opened(tmp_path / "durable", durable=True) as other:
        for record in DAY:
            for stream in (one, other):
                stream.extend([record])
            assert one.recall("abc 3", record.hour, 5) == other.recall("abc 3", record.hour, 5)
        assert list(one.records(since=4)) == list(other.records(since=4))
        assert one.latest(7) == other.latest(7)
        assert len(one) == len(other)
        assert on_disk(tmp_path / "waiting") == {"x": []}
    assert on_disk(tmp_path / "waiting") == on_disk(tmp_path / "durable") == {"x": DAY}


def test_one_flush_puts_all_streams_of_a_store_on_disk(tmp_path: Path) -> None:
    with opened(tmp_path / "m") as one, opened(tmp_path / "m", "y") as other:
        one.extend(DAY)
        other.extend(DAY[:5])
        one.flush()
        assert on_disk(tmp_path / "m") == {"x": DAY, "y": DAY[:5]}
        one.flush()
    assert on_disk(tmp_path / "m") == {"x": DAY, "y": DAY[:5]}


def test_what_a_stream_that_is_durable_is_given_puts_the_older_records_on_disk_before_it(tmp_path: Path) -> None:
    with opened(tmp_path / "m") as one, opened(tmp_path / "m", durable=True) as other:
        one.extend(DAY[:-1])
        other.extend(DAY[-1:])
        assert on_disk(tmp_path / "m") == {"x": DAY}


def test_many_records_do_not_wait_for_a_flush(tmp_path: Path) -> None:
    many = [Record(f"abcd {hour}", hour, {}) for hour in range(1300)]
    with opened(tmp_path / "m") as stream:
        for start in range(0, len(many), 100):
            stream.extend(many[start : start + 100])
        found = on_disk(tmp_path / "m")["x"]
        assert len(found) > 700
        assert found == many[: len(found)]
        assert stream.recall("abcd 5", 1300, 1, since=0)[0].text.startswith("abcd")
        assert list(stream.records()) == many
    assert on_disk(tmp_path / "m") == {"x": many}


@pytest.mark.parametrize("flushed", [0, 20, 39])
def test_records_that_wait_are_forgotten_like_others(tmp_path: Path, flushed: int) -> None:
    with opened(tmp_path / "m") as stream:
        stream.extend(DAY[:flushed])
        stream.flush()
        stream.extend(DAY[flushed:])
        assert stream.forget_from(5) == len(DAY) - 15
        stream.extend([Record("again", 5, {})])
        assert list(stream.records()) == [*DAY[:15], Record("again", 5, {})]
    assert on_disk(tmp_path / "m") == {"x": [*DAY[:15], Record("again", 5, {})]}


def test_a_program_that_never_closes_its_streams_leaves_all_on_disk(tmp_path: Path) -> None:
    opened(tmp_path / "m").extend(DAY)
    Store.close_all()
    assert on_disk(tmp_path / "m") == {"x": DAY}


def test_a_store_that_fails_says_so_and_the_stream_has_what_the_store_has(tmp_path: Path) -> None:
    with ExitStack() as stack:
        stream = stack.enter_context(opened(tmp_path / "m"))
        stream.extend(DAY[:6])
        stream.flush()
        stream.extend(DAY[6:])
        whole = failing(stream)
        with pytest.raises(MemoryStoreError, match="No space left"):
            stream.flush()
        whole()
        assert list(stream.records()) == DAY[:6]
        stream.extend(DAY[6:])
    assert on_disk(tmp_path / "m") == {"x": DAY}


def test_a_store_that_fails_as_it_is_closed_says_so_and_is_closed(tmp_path: Path) -> None:
    stream = opened(tmp_path / "m")
    stream.extend(DAY)
    failing(stream)
    with pytest.raises(MemoryStoreError, match="No space left"):
        stream.close()
    with opened(tmp_path / "m") as again:
        assert len(again) == 0


def test_after_an_error_a_store_is_asked_for_nothing_more(tmp_path: Path) -> None:
    """Chroma that was refused a write on a full disk may keep whoever asks for the next waiting for ever."""

    def work(stream: MemoryStream) -> None:
        with stream:
            stream.extend(DAY[:6])
            stream.flush()
            stream.extend(DAY[6:])
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        work(opened(tmp_path / "m"))
    assert on_disk(tmp_path / "m") == {"x": DAY[:6]}


def test_a_forked_child_writes_nothing_of_what_waits(tmp_path: Path) -> None:
    with opened(tmp_path / "m") as stream:
        stream.extend(DAY)
        child = os.fork()
        if child == 0:
            stream.close()
            os._exit(0)
        os.waitpid(child, 0)
        assert on_disk(tmp_path / "m") == {"x": []}
    assert on_disk(tmp_path / "m") == {"x": DAY}


def failing(stream: MemoryStream) -> Any:
    """Have the disk be full for a stream's collection; call the result to make room."""
    log = stream._open_log
    true = log._write

    def full(rows: Any) -> None:
        raise MemoryStoreError("No space left on device")

    log._write = full  # type: ignore[method-assign]

    def whole() -> None:
        log._write = true  # type: ignore[method-assign]

    return whole
