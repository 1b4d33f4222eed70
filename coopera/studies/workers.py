"""Processes for jobs side by side: if a process dies, another one does its job again."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Protocol

from coopera.rundir.crash import told
from coopera.rundir.stopping import PATIENCE
from coopera.studies.heap import rare_collections

Work = Callable[[Any], Any]
TRIES = 3


class Job(Protocol):
    """Something to be done, after another thing or at once."""

    @property
    def name(self) -> str:
        """Unique among the jobs."""
        ...

    @property
    def after(self) -> str | None:
        """Name of the job that must have been done before, if any."""
        ...


@dataclass(frozen=True, slots=True)
class Done:
    """How a job ended: `error` is None where it was done."""

    job: Any
    error: str | None = None


@dataclass(slots=True)
class _Worker:
    place: int
    process: BaseProcess
    pipe: Connection
    job: Any = None


@dataclass(slots=True)
class Queue:
    """Jobs in order, handed out once what they wait for is done; a job whose forerunner failed fails too."""

    jobs: list[Any]
    tries: dict[str, int] = field(default_factory=dict)
    _done: set[str] = field(default_factory=set)
    _failed: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        """What is not among the jobs is taken as done."""
        names = {job.name for job in self.jobs}
        self._done = {job.after for job in self.jobs if job.after and job.after not in names}

    def take(self) -> Any | None:
        """The first job that can start now, or None."""
        for place, job in enumerate(self.jobs):
            if job.after is None or job.after in self._done:
                return self.jobs.pop(place)
        return None

    def end_at(self, deadline: float | None) -> None:
        """Drop what has not begun, once the deadline has passed."""
        if deadline is not None and time.monotonic() > deadline:
            self.jobs = []

    def close(self, job: Any, error: str | None) -> list[Done]:
        """Note how a job ended; returns it with those that can never start now."""
        (self._failed if error else self._done).add(job.name)
        lost = [other for other in self.jobs if other.after in self._failed]
        self.jobs = [other for other in self.jobs if other not in lost]
        return [Done(job, error), *(Done(other, f"{job.name} failed: {error}") for other in lost)]

    def again(self, job: Any) -> bool:
        """Whether a job whose worker died may be tried again, in which case it is queued first."""
        self.tries[job.name] = self.tries.get(job.name, 0) + 1
        if self.tries[job.name] >= TRIES:
            return False
        self.jobs.insert(0, job)
        return True


def work_through(
    jobs: Sequence[Any], work: Work, *, workers: int = 1, deadline: float | None = None
) -> Generator[Done]:
    """Do all jobs in `workers` processes, yielding each as it ends.

    A process serves many jobs, since starting one takes seconds, and keeps to its share of the cores. If it dies, at
    work or before it takes a job, the job is tried again in a new one, at most three times in all. The processes die
    with this one, however it dies.

    Args:
        jobs: In the order in which they are to be started.
        work: A function at the top of a module; where it raises, the job has failed for good.
        workers: At least 1.
        deadline: By `time.monotonic`; no job is started after it.
    """
    context = multiprocessing.get_context("spawn")
    queue, of = Queue(list(jobs)), min(workers, len(jobs))
    staff = [_hire(context, work, place, of) for place in range(of)]
    try:
        while queue.jobs or any(one.job for one in staff):
            queue.end_at(deadline)
            for one in staff:
                if one.job is None and (job := queue.take()) is not None:
                    one.job = job
                    with suppress(OSError):  # it died while it had nothing to do, which shows below
                        one.pipe.send(job)
            busy = [one for one in staff if one.job is not None]
            if not busy:
                break
            ready = wait([one.pipe for one in busy])
            for one in [one for one in busy if one.pipe in ready]:
                job, one.job = one.job, None
                try:
                    error = one.pipe.recv()
                except (EOFError, OSError):
                    one.pipe.close()
                    one.process.join()
                    staff[one.place] = _hire(context, work, one.place, of)
                    if queue.again(job):
                        continue
                    error = f"its process died {TRIES} times (exit code {one.process.exitcode})"
                yield from queue.close(job, error)
    finally:
        _dismiss(staff)


def _dismiss(staff: Sequence[_Worker]) -> None:
    """End all workers: the closing of its pipe ends one that waits, a signal one that is at work."""
    for one in staff:
        one.pipe.close()
    stop_all([one.process for one in staff if one.job is not None])
    for one in staff:
        one.process.join()


def stop_all(processes: Sequence[BaseProcess]) -> None:
    """Have processes end: they may first say how far they got, for less than a second."""
    for process in processes:
        process.terminate()
    for process in processes:
        late = threading.Timer(PATIENCE, process.kill)
        late.daemon = True
        late.start()


def _hire(context: Any, work: Work, place: int, of: int) -> _Worker:
    return _Worker(place, *start(context, partial(_serve, work), place, of))


def start(context: Any, life: Callable[[Connection], None], which: int, of: int) -> tuple[BaseProcess, Connection]:
    """Start a process that keeps to its share of the cores and dies with this one.

    What it is to do comes through the pipe, so that the libraries which that brings load while it rarely looks for
    garbage: a sixth of the time that they take.

    Args:
        context: Of `multiprocessing`.
        life: What it does with its end of the pipe. It hears no Ctrl-C, not even while it loads: this process does,
            and ends it.
        which: The how-manieth of the processes it is, from 0.
        of: How many there are.

    Returns:
        The process, and this end of the pipe.
    """
    here, there = context.Pipe()
    process = context.Process(target=_begin, args=(there, which, of), daemon=True)
    with _without_interrupts():
        process.start()
    there.close()
    with suppress(OSError):  # it has died, which shows when it is to answer
        here.send(life)
    return process, here


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Hold Ctrl-C back, where the system can; what begins meanwhile never hears it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # its start lets Ctrl-C through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(pipe: Connection, which: int, of: int) -> None:
    die_with_parent()
    share_cores(which, of)
    rare_collections()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where a system cannot hold it back
    try:
        life = pipe.recv()
    except EOFError:
        return
    life(pipe)


def share_cores(which: int, of: int) -> None:
    """Keep a process to its share of the cores, where the system can: threads that take turns lose time in between."""
    if hasattr(os, "sched_setaffinity") and (cores := sorted(os.sched_getaffinity(0))[which::of]):
        os.sched_setaffinity(0, cores)


def die_with_parent() -> None:
    """Let this process of `multiprocessing` be killed as soon as its parent dies, however that dies."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_die_after, args=(parent.sentinel,), daemon=True).start()


def _die_after(sentinel: int) -> None:
    wait([sentinel])
    os.kill(os.getpid(), signal.SIGKILL)


def _serve(work: Work, pipe: Connection) -> None:
    """The life of a worker: take a job, do it, say how it went."""
    while True:
        try:
            job = pipe.recv()
        except EOFError:
            gc.freeze()  # to look for garbage once more would hold the end up
            return
        pipe.send(attempt(work, job))


def attempt(work: Work, job: Any) -> str | None:
    """Do a job; returns in one sentence why it failed, or None where it was done."""
    try:
        work(job)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as err:  # noqa: BLE001 - it has no process of its own that could fail with it
        return told(err, ["worker", str(getattr(job, "name", job))])[0]
    return None
