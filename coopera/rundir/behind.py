"""Writing that waits for something else, such as an hour's pictures, while the work goes on."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Generic, TypeVar

T = TypeVar("T")
_AHEAD = 3
"""So many hours and evenings may wait to be written. What takes pictures then has something to do when an hour asks for
few; a run that is killed lives so many hours again, which were short ones if their pictures took longer."""


class Behind(Generic[T]):
    """Has one thing after another written on a thread of its own; `close` it after use."""

    def __init__(self) -> None:
        """Begin with nothing to write; the thread starts with the first."""
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="trace")
        self._writing: deque[tuple[Future[None], T]] = deque()
        self._popping = threading.Lock()

    def write(self, what: T, job: Callable[[], None], after: Callable[[], None] | None = None) -> None:
        """Do a job, which writes `what`, once what was given before is written, and `after` has returned.

        Where there is nothing to wait for it is done at once; where too much waits, this waits. What went wrong with
        something given before is raised, and this job left.
        """
        self._settle(_AHEAD - 1)
        before = self._last()
        if before is None and after is None:
            job()
            return

        def both() -> None:
            if before is None or before.exception() is None:  # nothing stands after what is missing
                if after is not None:
                    after()
                job()

        self._writing.append((self._pool.submit(both), what))

    def waiting(self) -> list[T]:
        """What may not be written yet, in order; what went wrong with something before it is raised, once."""
        self._settle(len(self._writing))
        return [what for _, what in self._writing]

    def settle(self) -> None:
        """Wait for what is being written; what went wrong there, or in what it waited for, is raised here, once."""
        self._settle(0)

    def close(self) -> None:
        """Wait for what is being written, whatever comes of it, and end the thread; a second time does nothing."""
        self._pool.shutdown()

    def _settle(self, left: int) -> None:
        """Wait until no more than so much is being written; several threads may."""
        while first := self._to_settle(left):
            wait([first[0]])
            with self._popping:
                if self._writing and self._writing[0] is first:
                    self._writing.popleft()
                    if err := first[0].exception():
                        self._writing.clear()
                        raise err

    def _last(self) -> Future[None] | None:
        with self._popping:
            return self._writing[-1][0] if self._writing else None

    def _to_settle(self, left: int) -> tuple[Future[None], T] | None:
        """The first thing, where it is done or where more than so much is being written."""
        with self._popping:
            first = self._writing[0] if self._writing else None
            return first if first and (len(self._writing) > left or first[0].done()) else None
