from __future__ import annotations

import errno
import threading
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from coopera.rundir import behind, seals
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
    writer.write(3, lambda: written.append(3))
    writer.settle()
    assert written == [1, 2, 3]


def test_what_has_nothing_to_wait_for_is_written_at_once(writer: Behind[int]) -> None:
    written, there = list[int](), threading.Event()
    writer.write(1, lambda: written.append(1))
    assert written == [1]
    writer.write(2, lambda: written.append(2), there.wait)
    writer.write(3, lambda: written.append(3))
    assert written == [1], "it has the one before it to wait for"
    there.set()
    writer.settle()
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


def test_an_hour_that_waits_for_its_pictures_is_read_with_its_day(run: RunDir, small_run: RunDir) -> None:
    there = threading.Event()
    first, *_ = hours = small_run.read_day(0)
    run.write_hour(first)
    for hour in hours[1:3]:
        run.write_hour(hour, there.wait)
    assert run.hours_done() == [(0, first.hour)]
    found = run.read_day(0)
    assert [one.model_dump_json() for one in found] == [one.model_dump_json() for one in hours[:3]]
    there.set()


def test_the_work_goes_on_while_an_evening_waits_for_the_pictures_of_its_hours(run: RunDir, small_run: RunDir) -> None:
    there = threading.Event()
    first, *others = small_run.read_day(0)
    evening, tomorrow = small_run.evenings()[0], small_run.read_day(1)[0]
    for hour in (first, *others[:-1]):
        run.write_hour(hour)
    run.write_hour(others[-1], there.wait)
    run.write_evening(evening)
    run.write_hour(tomorrow)
    assert not run.evenings()
    assert (1, tomorrow.hour) not in run.hours_done(), "nothing stands before what it came after"
    there.set()
    with run.settling():
        pass
    again = RunDir.open(run.root)
    assert again.read_day(0) == [first, *others]
    assert again.evenings() == [evening]
    assert again.read_day(1) == [tomorrow]
    assert seals.day_seal(run.root, 0).is_file()


def test_a_run_is_finished_once_all_that_waits_is_written(run: RunDir, small_run: RunDir) -> None:
    there = threading.Event()
    *hours, last = small_run.read_day(0)
    for hour in hours:
        run.write_hour(hour)
    run.write_hour(last, there.wait)
    run.write_evening(small_run.evenings()[0])
    threading.Timer(0.1, there.set).start()
    assert len(run.finish()["days"]) == 1
    assert len(RunDir.open(run.root).evenings()) == 1


def test_pictures_that_fail_leave_the_day_without_an_evening_and_the_run_unfinished(
    run: RunDir, small_run: RunDir
) -> None:
    there = threading.Event()

    def fails() -> None:
        there.wait()
        raise OSError(errno.ENOSPC, "no space")

    run.write_hour(small_run.read_day(0)[0], fails)
    run.write_evening(small_run.evenings()[0])
    there.set()
    with pytest.raises(OSError, match="no space"):
        run.finish()
    assert (run.hours_done(), run.evenings(), run.state) == ([], [], "running")
