"""Stopping in time: Ctrl-C and `kill` reach the threads that do the work, not only the one that waits for them."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any, Self

from coopera.core.errors import StoppedError

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


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
