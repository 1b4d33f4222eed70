"""Waiting for a server that may never end, without being held by it: within a glance of being told, one is gone.

A request runs in a thread of its own. Whoever asked waits for it, looks up every quarter of a second, and leaves it
behind where time is up or the run is asked to stop. What is left behind reads no further (`given_up`).
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextvars import ContextVar, copy_context
from typing import TypeAlias, TypeVar

Answer = TypeVar("Answer")
Check: TypeAlias = Callable[[], None]
"""Raises where whoever waits is to wait no longer."""

GLANCE = 0.25
"""Seconds between looks at whether one is asked to stop."""
_GIVEN_UP: ContextVar[threading.Event | None] = ContextVar("given_up", default=None)


def go_on() -> None:
    """Never stop."""


def given_up() -> bool:
    """Whether nobody waits any longer for what this thread does."""
    event = _GIVEN_UP.get()
    return event is not None and event.is_set()


def pause(check: Check, seconds: float) -> None:
    """Do nothing for a while, but not longer than until `check` raises."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        check()
        threading.Event().wait(min(left, GLANCE))


def in_time(request: Callable[[], Answer], seconds: float, check: Check = go_on) -> Answer:
    """Do something that may hang, and return what it returns, or raise what it raises.

    Args:
        request: Is done in another thread, in a copy of this one's context.
        seconds: How long it may take.
        check: Called all the while.

    Raises:
        TimeoutError: If it takes longer.
    """
    done, left_behind = threading.Event(), threading.Event()
    answers: list[Answer] = []
    errors: list[BaseException] = []

    def work() -> None:
        _GIVEN_UP.set(left_behind)
        try:
            answers.append(request())
        except BaseException as err:  # noqa: BLE001 - raised again where it is waited for
            errors.append(err)
        finally:
            done.set()

    context, end = copy_context(), time.monotonic() + seconds
    threading.Thread(target=context.run, args=(work,), name="request", daemon=True).start()
    try:
        while not done.wait(max(0.0, min(GLANCE, end - time.monotonic()))):
            check()
            if time.monotonic() >= end:
                raise TimeoutError(f"it timed out: one request may take {seconds:g} s (calls.timeout)")
    except BaseException:
        left_behind.set()
        raise
    if errors:
        raise errors[0]
    return answers[0]
