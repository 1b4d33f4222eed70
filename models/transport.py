"""The way to a server: a gate that keeps the pace, and patience with requests that fail on their way.

A failed request is sent again after a pause. A request has failed if the server could not take it, took too long or
sent back no chat completion. The pause doubles each time, or is as long as the server's Retry-After asks. The call's
faults list every failure.
"""

from __future__ import annotations

import itertools
import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from typing import TypeVar

from coopera.core.errors import CooperaError, ModelCallError
from coopera.core.lazy import made_once
from coopera.models.servers.saying import bare_addresses
from coopera.models.servers.waiting import GLANCE, Check, go_on, in_time
from coopera.models.settings import CallSettings

Answer = TypeVar("Answer")
Sleep = Callable[[float], None]

_AGAIN = frozenset({408, 409, 425, 429})
_MINUTE = 60.0


def wait(seconds: float) -> None:
    """Do nothing for a while."""
    threading.Event().wait(seconds)


class Gate:
    """Lets through so many requests at once, and begins so many in a minute; threads may share it."""

    def __init__(
        self, at_once: int, per_minute: int | None, *, sleep: Sleep = wait, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Open a gate; `sleep` and `clock` are in seconds."""
        self._free = threading.BoundedSemaphore(at_once)
        self._per_minute = per_minute
        self._sleep, self._clock = sleep, clock
        self._begun: deque[float] = deque()
        self._lock = threading.Lock()
        self.answered = threading.Event()
        """Whether what lies behind it has ever answered."""

    @contextmanager
    def passed(self, check: Check = go_on) -> Iterator[None]:
        """Be one of those under way; `check` is called while one waits for that."""
        while not self._free.acquire(timeout=GLANCE):
            check()
        try:
            while (pause := self._pause()) > 0:
                check()
                self._sleep(min(pause, GLANCE))
            yield
        finally:
            self._free.release()

    def _pause(self) -> float:
        """Seconds until another request may begin; at 0 it has begun."""
        if self._per_minute is None:
            return 0.0
        with self._lock:
            now = self._clock()
            while self._begun and self._begun[0] <= now - _MINUTE:
                self._begun.popleft()
            if len(self._begun) < self._per_minute:
                self._begun.append(now)
                return 0.0
            return self._begun[0] + _MINUTE - now


_sharing = 1


def share_pace(processes: int) -> None:
    """Share the pace between several processes: each keeps its part of every limit, at least 1."""
    global _sharing
    _sharing = processes


@made_once(64)
def gate_to(server: str, at_once: int, per_minute: int | None) -> Gate:
    """The one gate that all studies of this process pass on their way to a server."""
    return Gate(max(1, at_once // _sharing), None if per_minute is None else max(1, per_minute // _sharing))


@dataclass(frozen=True, slots=True)
class Line:
    """A way to one server.

    Attributes:
        settings: Retries and pauses.
        gate: The pace.
        unreachable: What the client raises when it got no answer, or one that says no.
        garbled: What it raises when the answer is no chat completion.
        sleep: Waits for so many seconds.
        check: Called while a request is under way, or waits for its turn; raises where it is to wait no longer.
        now: The time of day, for a Retry-After that names a date.
    """

    settings: CallSettings
    gate: Gate
    unreachable: tuple[type[Exception], ...]
    garbled: tuple[type[Exception], ...] = ()
    sleep: Sleep = wait
    check: Check = go_on
    now: Callable[[], datetime] = lambda: datetime.now(UTC)

    def send(
        self, request: Callable[[], Answer], note: Callable[[str], None], say: Callable[[Exception], str]
    ) -> Answer:
        """Send a request until it is answered.

        Args:
            request: Does it once.
            note: Is told each failure.
            say: Puts an error into words without giving keys away.

        Raises:
            RefusedError: If the server finds the request itself wrong (400 or 422).
            NobodyThereError: If the connection is refused where nobody has ever answered.
            ModelCallError: If it cannot be answered, or was not for all the retries.
        """
        for attempt in itertools.count():
            try:
                with self.gate.passed(self.check):
                    answer = in_time(request, self.settings.timeout, self.check)
                self.gate.answered.set()
                return answer
            except CooperaError:
                raise
            except self.unreachable as err:
                problem, failure = say(err), err
                self._end_if_final(err, problem)
            except self.garbled as err:
                problem, failure = f"what the server sent is no reply: {say(err)}", err
            if attempt == self.settings.retries:
                raise ModelCallError(problem) from failure
            pause = self._pause(failure, attempt)
            if pause > self.settings.max_pause:
                note(problem)
                raise ModelCallError(f"the server asks to be left alone for {pause:.6g} seconds") from failure
            note(f"{problem}; sent again after {pause:.3g} s")
            self.sleep(pause)
        raise AssertionError("counting does not end")

    def _end_if_final(self, err: Exception, problem: str) -> None:
        """Raise what a failure comes to, where it would be in vain to send the request again."""
        status = status_of(err)
        if status is not None:
            self.gate.answered.set()
        if not self.gate.answered.is_set() and _connection_refused(err):
            hint = "`coopera models check` says when one does"
            raise NobodyThereError(f"no server listens there ({problem.rstrip('.')}); {hint}") from err
        if status in {400, 422}:
            raise RefusedError(problem) from err
        if status is not None and 300 <= status < 400:
            raise ModelCallError(f"the server sends its callers elsewhere ({_elsewhere(err)}") from err
        if status is not None and status not in _AGAIN and status < 500:
            raise ModelCallError(problem) from err

    def _pause(self, err: Exception, attempt: int) -> float:
        """Seconds to wait before the next try."""
        grown = min(self.settings.backoff * 2.0**attempt, self.settings.max_pause)
        return max(grown, self._asked_for(err) or 0.0)

    def _asked_for(self, err: Exception) -> float | None:
        text = _headers(err).get("retry-after")
        if text is None:
            return None
        try:
            seconds = float(text)
        except ValueError:
            pass
        else:
            return None if math.isnan(seconds) else max(0.0, seconds)
        try:
            return max(0.0, (parsedate_to_datetime(text) - self.now()).total_seconds())
        except (ValueError, TypeError, OverflowError):  # a TypeError is a date without a time zone
            return None


class NobodyThereError(ModelCallError):
    """No server listens at an address where none has answered before: to wait for one would be in vain."""


class RefusedError(Exception):
    """The server finds the request wrong; asked for in another form it may do. Never leaves the backend."""


def status_of(err: BaseException) -> int | None:
    """The HTTP status that an error of a client tells of, if it does."""
    status = getattr(err, "status_code", None)
    return status if isinstance(status, int) else None


def _headers(err: BaseException) -> Mapping[str, str]:
    return getattr(getattr(err, "response", None), "headers", None) or {}


def _elsewhere(err: BaseException) -> str:
    """Where a redirect leads, without what stands behind the address, and what to do about it."""
    where = bare_addresses(_headers(err).get("location", "to no address"))[:200]
    return f"{status_of(err)}: {where}), which is not followed; if that address is right, name it as base URL"


def _connection_refused(err: BaseException | None) -> bool:
    """Whether an error comes of a connection that was refused."""
    while err is not None and not isinstance(err, ConnectionRefusedError):
        err = err.__cause__ or err.__context__
    return err is not None
