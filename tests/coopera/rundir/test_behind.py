from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import closing

import pytest

from coopera.rundir import behind
from coopera.rundir.behind import Behind


@pytest.fixture
def writer() -> Iterator[Behind[int]]:
    with closing(Behind[int]()) as made:
        yield made


def test_things_are_written_in_their_order_whatever_is_there_first(writer: Behind[int]) -> None:
    written, first, second = [], threading.Event(), threading.Event()
    writer.write(1, lambda: written.append(1), first.wait)
    writer.write(2, lambda: written.append(2), second.wait)
    second.set()
    assert not written
    first.set()
    writer.write(3, lambda: written.append(3), None)
    assert written == [1, 2, 3]


def test_the_work_goes_on_while_a_few_things_wait_and_no_more(writer: Behind[int]) -> None:
    there, written = threading.Event(), list[int]()
    for number in range(behind._AHEAD):
        writer.write(number, lambda number=number: written.append(number), there.wait)  # type: ignore[misc]
    one_more = threading.Thread(target=writer.write, args=(-1, lambda: written.append(-1), there.wait))
    one_more.start()
    one_more.join(0.2)
    assert one_more.is_alive()
    assert writer.waiting() == [*range(behind._AHEAD)]
    there.set()
    one_more.join(20)
    writer.settle()
    assert not writer.waiting()
    assert written == [*range(behind._AHEAD), -1]


def test_nothing_is_written_after_what_could_not_be_and_that_is_told_once(writer: Behind[int]) -> None:
    written, there = list[int](), threading.Event()

    def fails() -> None:
        there.wait()
        raise OSError("no space")

    writer.write(1, lambda: written.append(1), fails)
    writer.write(2, lambda: written.append(2), there.wait)
    there.set()
    with pytest.raises(OSError, match="no space"):
        writer.settle()
    writer.settle()
    assert not written
    writer.write(3, lambda: written.append(3), there.wait)
    writer.settle()
    assert written == [3]
