from __future__ import annotations

import errno
import threading
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from coopera.rundir import behind
from coopera.rundir.behind import Behind
from coopera.rundir.directory import RunDir
from tests.coopera.fake_run import fake_run


@pytest.fixture
def writer() -> Iterator[Behind[int]]:
    with closing(Behind[int]()) as made:
        yield made


@pytest.fixture
def run(tmp_path: Path) -> Iterator[RunDir]:
    with RunDir.resume(fake_run(tmp_path / "run", lived=False, finished=False).root) as made:
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


def test_an_hour_that_waits_for_its_pictures_is_read_with_its_day_and_written_before_the_evening(
    run: RunDir, small_run: RunDir
) -> None:
    there = threading.Event()
    first, *_ = hours = small_run.read_day(0)
    run.write_hour(first)
    for hour in hours[1:3]:
        run.write_hour(hour, there.wait)
    assert run.hours_done() == [(0, first.hour)]
    found = run.read_day(0)
    assert [one.model_dump_json() for one in found] == [one.model_dump_json() for one in hours[:3]]
    threading.Timer(0.1, there.set).start()
    run.write_evening(small_run.evenings()[0])
    assert RunDir.open(run.root).read_day(0) == hours[:3]


def test_pictures_that_fail_leave_the_day_without_an_evening(run: RunDir, small_run: RunDir) -> None:
    def fails() -> None:
        raise OSError(errno.ENOSPC, "no space")

    run.write_hour(small_run.read_day(0)[0], fails)
    with pytest.raises(OSError, match="no space"):
        run.write_evening(small_run.evenings()[0])
    assert (run.hours_done(), run.evenings()) == ([], [])
