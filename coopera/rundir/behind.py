"""Writing that waits for something else, such as an hour's pictures, while the work goes on."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor


class Behind:
    """Has one thing at a time written on a thread of its own; `close` it after use."""

    def __init__(self) -> None:
        """Begin with nothing to write; the thread starts with the first."""
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="trace")
        self._writing: Future[None] | None = None

    def write(self, job: Callable[[], None], after: Callable[[], None] | None) -> None:
        """Do a job now, or have it done once `after` has returned; what was given before is settled first."""
        self.settle()
        if after is None:
            job()
            return

        def both() -> None:
            after()
            job()

        self._writing = self._pool.submit(both)

    def settle(self) -> None:
        """Wait for what is being written; what went wrong there, or in what it waited for, is raised here, once."""
        writing, self._writing = self._writing, None
        if writing is not None:
            writing.result()

    def close(self) -> None:
        """Wait for what is being written, whatever comes of it, and end the thread; a second time does nothing."""
        self._pool.shutdown()
