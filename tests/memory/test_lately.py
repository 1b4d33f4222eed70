from __future__ import annotations

import pytest

from coopera.memory.lately import PIECE, Lately
from coopera.memory.rows import Record


def records(start: int, stop: int) -> dict[int, Record]:
    return {at: Record(f"record {at}", at // 5, {"n": at} if at % 7 == 0 else {}) for at in range(start, stop)}


def test_records_come_back_as_they_were_with_the_metadata_that_they_had() -> None:
    lately = Lately(PIECE)
    lately.keep(records(PIECE - 9, PIECE + 9).items())
    assert lately.of(range(PIECE - 9, PIECE + 9)) == records(PIECE - 9, PIECE + 9)
    assert lately.of([PIECE + 8, 3, PIECE - 9]) == {**records(PIECE + 8, PIECE + 9), **records(PIECE - 9, PIECE - 8)}
    assert lately.of([PIECE])[PIECE].metadata is not lately.of([PIECE])[PIECE].metadata
    lately.clear()
    assert lately.of(range(PIECE)) == {}


@pytest.mark.parametrize("start", [0, 1, PIECE // 2, PIECE - 1])
def test_as_many_consecutive_records_as_there_is_room_for_stay_wherever_they_begin(start: int) -> None:
    lately = Lately(3 * PIECE)
    stop = start + 3 * PIECE
    lately.keep(records(0, stop).items())
    for _ in range(2):
        told = range(start, stop)
        assert lately.texts(start, stop) == ([f"record {at}" for at in told], [at // 5 for at in told])
        assert lately.of(range(start, stop)) == records(start, stop)


def test_where_it_is_full_those_go_that_nobody_asked_for_the_longest() -> None:
    lately = Lately(PIECE)
    lately.keep(records(0, 2 * PIECE).items())
    lately.of([5])
    lately.keep(records(2 * PIECE, 2 * PIECE + 1).items())
    assert list(lately.of([5, PIECE + 5, 2 * PIECE])) == [5, 2 * PIECE]


def test_texts_are_told_only_if_all_are_here() -> None:
    lately = Lately(PIECE)
    lately.keep(records(3, 9).items())
    assert lately.texts(4, 6) == (["record 4", "record 5"], [0, 1])
    assert lately.texts(2, 6) is None
    assert lately.texts(4, PIECE + 1) is None
    assert lately.texts(7, 7) == ([], [])
