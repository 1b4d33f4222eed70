"""Patience with servers: pauses that grow, Retry-After, the pace, and when to give up. No real time passes here."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from typing import Any

import pytest

from coopera.core.errors import ModelCallError
from coopera.models.settings import CallSettings
from coopera.models.transport import Gate, Line, NobodyThereError, RefusedError

NOON = datetime(2026, 1, 1, 12, tzinfo=UTC)


class StatusError(Exception):
    """As the clients of servers raise it."""

    def __init__(self, status: int, retry_after: str | None = None) -> None:
        super().__init__(f"HTTP {status}")
        self.status_code = status
        self.response = type("Response", (), {"headers": {"retry-after": retry_after} if retry_after else {}})


class Told:
    """A line whose waits and notes can be read."""

    def __init__(self, *script: Exception | str, **settings: Any) -> None:
        self.script, self.waits, self.notes = list(script), list[float](), list[str]()
        chosen = CallSettings(**{"retries": 4, **settings})
        errors = (StatusError, OSError)
        self.line = Line(chosen, Gate(1, None), errors, (ValueError,), sleep=self.waits.append, now=lambda: NOON)

    def __call__(self) -> str:
        def request() -> str:
            answer = self.script.pop(0)
            if isinstance(answer, Exception):
                raise answer
            return answer

        return self.line.send(request, self.notes.append, str)


def test_pauses_double_and_each_failure_is_noted() -> None:
    told = Told(StatusError(500), OSError("refused"), StatusError(429), ValueError("html"), "good", backoff=0.5)
    assert told() == "good"
    assert told.waits == [0.5, 1.0, 2.0, 4.0]
    assert [note.split(";")[0] for note in told.notes] == [
        "HTTP 500",
        "refused",
        "HTTP 429",
        "what the server sent is no reply: html",
    ]


@pytest.mark.parametrize(
    ("header", "pause"), [("7", 7.0), ("0", 1.0), ("Thu, 01 Jan 2026 12:00:30 GMT", 30.0), ("soon", 1.0), ("-3", 1.0)]
)
def test_retry_after_is_obeyed_where_it_asks_for_more(header: str, pause: float) -> None:
    told = Told(StatusError(429, header), "good")
    assert told() == "good"
    assert told.waits == [pause]


def test_a_server_that_asks_for_too_long_a_pause_is_given_up() -> None:
    told = Told(StatusError(429, "3600"), max_pause=60.0)
    with pytest.raises(ModelCallError, match="left alone for 3600 seconds"):
        told()
    assert told.waits == []


def test_retries_are_bounded_and_so_are_pauses() -> None:
    told = Told(*[StatusError(503)] * 5, backoff=1.0, max_pause=3.0)
    with pytest.raises(ModelCallError, match="HTTP 503"):
        told()
    assert told.waits == [1.0, 2.0, 3.0, 3.0]


@pytest.mark.parametrize("status", [401, 403, 404, 413])
def test_what_will_not_get_better_is_not_sent_again(status: int) -> None:
    told = Told(StatusError(status))
    with pytest.raises(ModelCallError):
        told()
    assert told.waits == []


def test_a_request_that_the_server_finds_wrong_is_told_apart() -> None:
    for status in (400, 422):
        with pytest.raises(RefusedError):
            Told(StatusError(status))()


def test_no_more_requests_are_under_way_than_allowed() -> None:
    gate, now, most = Gate(3, None), 0, 0
    lock, full = threading.Lock(), threading.Barrier(3)

    def work(_: int) -> None:
        nonlocal now, most
        with gate.passed():
            with lock:
                now += 1
                most = max(most, now)
            full.wait(timeout=10)
            with lock:
                now -= 1

    with ThreadPoolExecutor(9) as pool:
        list(pool.map(work, range(9)))
    assert most == 3


def test_no_more_requests_begin_in_a_minute_than_allowed() -> None:
    time = [0.0]

    def sleep(seconds: float) -> None:
        time[0] += seconds

    gate, begun = Gate(8, 3, sleep=sleep, clock=lambda: time[0]), []
    for _ in range(8):
        with gate.passed():
            begun.append(time[0])
            time[0] += 5.0
    assert all(later - first >= 60.0 for first, later in zip(begun, begun[3:], strict=False))
    assert begun[:4] == [0.0, 5.0, 10.0, 60.0]


def refused() -> Exception:
    """As a client says it: an error of its own, made of the system's."""
    said = OSError("Connection error.")
    said.__cause__ = ConnectionRefusedError(111, "Connection refused")
    return said


def test_nobody_waits_where_no_server_has_ever_answered() -> None:
    told = Told(refused(), "never asked")
    with pytest.raises(NobodyThereError, match=r"no server listens there \(Connection error\); `coopera models check`"):
        told()
    assert told.waits == []


@pytest.mark.parametrize("before", ["good", StatusError(503)])
def test_a_server_that_has_answered_is_waited_for_while_it_comes_back(before: Exception | str) -> None:
    told = Told(before, refused(), "good")
    if isinstance(before, str):
        assert told() == before
    assert told() == "good"
    assert told.waits
