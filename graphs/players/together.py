"""Questions that do not wait for each other, asked at once: each in a thread of its own, which waits for its reply."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from typing import Any

_MOST = 32  # threads; how many requests a server gets at once is its gate's to say (`calls.at_once`)


def together(jobs: Sequence[Callable[[], Any]], *, waits: bool = True) -> list[Any]:
    """Do some jobs at once and return what came of them, in the order of the jobs; each knows who listens to it.

    Args:
        jobs: What to do; none may depend on another, nor on when it is done.
        waits: Whether they wait for somebody. If not, threads would gain nothing, and they are done one by one.

    Raises:
        CooperaError: Of the first job that failed, once those that have begun are over; the others are not begun.
    """
    if not waits or len(jobs) < 2:
        return [job() for job in jobs]
    with ThreadPoolExecutor(min(len(jobs), _MOST)) as pool:
        begun = [pool.submit(copy_context().run, job) for job in jobs]
        try:
            return [one.result() for one in begun]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
