"""Writing that waits for something else, such as an hour's pictures, while the work goes on."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

_AHEAD = 3
"""So many hours may wait to be written. What takes pictures then has something to do when an hour asks for few; a run
that is killed lives so many hours again, which were short ones if their pictures took longer."""


class Behind:
    """Has one thing after another written on a thread of its own; `close` it after use."""

    def __init__(self) -> None:
        """Begin with nothing to write; the thread starts with the first."""
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="trace")
        self._writing: deque[Future[None]] = deque()

    def write(self, job: Callable[[], None], after: Callable[[], None] | None) -> None:
        """Do a job now, or have it done once `after` has returned; what was given before is done first.

        It waits where too much is to be written. What went wrong with something given before is raised, and this job
        left.
        """
        self._settle(0 if after is None else _AHEAD - 1)
        if after is None:
            job()
            return

        before = self._writing[-1] if self._writing else None

        def both() -> None:
            if before is None or before.exception() is None:  # nothing stands after what is missing
                after()
                job()

        self._writing.append(self._pool.submit(both))

    def settle(self) -> None:
        """Wait for what is being written; what went wrong there, or in what it waited for, is raised here, once."""
        self._settle(0)

    def close(self) -> None:
        """Wait for what is being written, whatever comes of it, and end the thread; a second time does nothing."""
        self._pool.shutdown()

    def _settle(self, left: int) -> None:
        """Wait until no more than so much is being written."""
        while len(self._writing) > left or (self._writing and self._writing[0].done()):
            wait([self._writing[0]])
            if err := self._writing.popleft().exception():
                self._writing.clear()
                raise err
