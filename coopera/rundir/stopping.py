"""Stopping in time: Ctrl-C and `kill` reach the threads that do the work, not only the one that waits for them."""

from __future__ import annotations

import os
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, Self

from coopera.core.errors import StoppedError

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
PATIENCE = 0.7
"""Seconds that work has to end by itself, once Ctrl-C was pressed."""
_WORDS = 0.2
"""Seconds for what is said at the end to be read."""


class Stop:
    """While entered, SIGINT and SIGTERM raise KeyboardInterrupt in the main thread and make `check` raise elsewhere.

    A graph runs its nodes in threads of their own, and on an interrupt waits until the running one ends; a day is such
    a node. Whatever the work calls often therefore calls `check`, so that it ends within the hour.
    """

    def __init__(self, outer: Stop | None = None) -> None:
        """Nothing is asked for yet; what stops `outer` stops this one too."""
        self._outer = outer
        self._asked = threading.Event()
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Self:
        """Listen to the signals, where this thread may."""
        if threading.current_thread() is threading.main_thread():
            self._before = {one: signal.signal(one, self._ask) for one in _SIGNALS}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the signals as they were."""
        for one, handler in self._before.items():
            signal.signal(one, handler)
        self._before = {}

    def check(self) -> None:
        """Go on, or not.

        Raises:
            StoppedError: If a stop was asked for.
        """
        if self._asked.is_set():
            raise StoppedError("The run was interrupted.")
        if self._outer is not None:
            self._outer.check()

    def ask(self) -> None:
        """Ask for a stop."""
        self._asked.set()

    def _ask(self, number: int, frame: FrameType | None) -> None:
        self.ask()
        raise KeyboardInterrupt


@contextmanager
def ends_soon(code: int, farewell: Callable[[], None]) -> Iterator[None]:
    """While it lasts, SIGINT and SIGTERM end the program within a second, whatever holds its work up.

    Libraries that load, weights that answer and texts that are encoded cannot be interrupted: they hold up the thread
    that does the work for seconds. What is broken off is then as it would be after `kill -9`, and is made good alike.

    Args:
        code: What the program exits with where its work did not end by itself.
        farewell: Says so, in another thread than the main one, and is not waited for where nobody reads it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    over = threading.Event()
    hears, told = socket.socketpair()
    told.setblocking(False)

    def watch() -> None:
        while heard := hears.recv(1):  # a byte for each signal, or none once nobody tells any more
            if heard[0] in _SIGNALS and not over.wait(PATIENCE):
                words = threading.Thread(target=farewell, daemon=True)
                words.start()
                words.join(_WORDS)
                os._exit(code)

    watcher = threading.Thread(target=watch, name="ends soon", daemon=True)
    before = signal.set_wakeup_fd(told.fileno(), warn_on_full_buffer=False)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        signal.set_wakeup_fd(before)
        told.close()
        watcher.join()
        hears.close()
