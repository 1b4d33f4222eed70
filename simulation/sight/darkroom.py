"""What pictures need is done beside what goes on in the home, on a thread of its own."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait


class Darkroom:
    """Does jobs one after another, in their order; `close` it after use."""

    def __init__(self) -> None:
        """Begin without jobs; the thread starts with the first."""
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="pictures")
        self._jobs: list[Future[None]] = []

    def add(self, job: Callable[[], None]) -> None:
        """Have something done, which may use nothing that changes meanwhile."""
        self._jobs.append(self._pool.submit(job))

    def finish(self) -> None:
        """Wait until all is done; what went wrong first is raised here, and what was to follow it is left undone."""
        try:
            for job in self._jobs:
                job.result()
        finally:
            self.drop()

    def close(self) -> None:
        """Leave undone what has not begun, and wait for what has; a second time does nothing."""
        self.drop()
        self._pool.shutdown()

    def drop(self) -> None:
        """Leave undone what has not begun, and wait for what has."""
        jobs, self._jobs = self._jobs, []
        wait([job for job in jobs if not job.cancel()])
