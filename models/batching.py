"""Prompts that arrive together are answered together, by whichever of the waiting threads comes first."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import Future
from typing import Generic, TypeVar

from coopera.core.errors import ModelCallError

Job = TypeVar("Job")
Result = TypeVar("Result")


class Batcher(Generic[Job, Result]):
    """Lets one thread work at a time, on all jobs of one kind that have piled up meanwhile."""

    def __init__(
        self,
        work: Callable[[Sequence[Job]], Sequence[Result | Exception]],
        *,
        size: int,
        kind: Callable[[Job], Hashable] = lambda job: None,
    ) -> None:
        """Take jobs for `work`.

        Args:
            work: Does up to `size` jobs of one kind, and returns a result or an error for each, in order.
            size: The most jobs of one go.
            kind: Only jobs of the same kind are done together.
        """
        self._work, self._size, self._kind = work, size, kind
        self._waiting: deque[tuple[Job, Future[Result]]] = deque()
        self._working = threading.Lock()
        self._queue = threading.Lock()

    def __call__(self, job: Job) -> Result:
        """Wait until the job is done and return its result, or raise its error."""
        mine: Future[Result] = Future()
        with self._queue:
            self._waiting.append((job, mine))
        while not mine.done():
            with self._working:
                if not mine.done():
                    self._serve()
        return mine.result()

    def _serve(self) -> None:
        """Do the oldest job, and those of its kind that wait with it."""
        with self._queue:
            kind = self._kind(self._waiting[0][0])
            taken = [entry for entry in self._waiting if self._kind(entry[0]) == kind][: self._size]
            served = {id(future) for _, future in taken}
            self._waiting = deque(entry for entry in self._waiting if id(entry[1]) not in served)
        results: Sequence[Result | Exception] = ()
        try:
            results = self._work([job for job, _ in taken])
        finally:  # whatever happens, nobody is left waiting
            for n, (_, future) in enumerate(taken):
                result = results[n] if n < len(results) else ModelCallError("the model was interrupted")
                if isinstance(result, Exception):
                    future.set_exception(result)
                else:
                    future.set_result(result)
