"""Several studies at once, so that a server which answers many requests together is kept busy.

Each study has a thread of its own. Its graphs' nodes are plain functions, not coroutines, since the libraries of home
and memory block. While one study waits for a server, the others go on. The homes of a process compute one after the
other, so the threads can be spread over several processes.
"""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import wait as wait_for_all
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.connection import wait as wait_for_any
from multiprocessing.process import BaseProcess
from typing import Any, TypeAlias

from coopera.config.schema import Config
from coopera.core.errors import ConfigError, CooperaError, RunError
from coopera.models.given import GivenModel
from coopera.models.transport import share_pace
from coopera.rundir.stopping import Stop
from coopera.studies.catalogues import resolve
from coopera.studies.events import Event
from coopera.studies.study import run_study
from coopera.studies.workers import start, stop_all

Ended: TypeAlias = dict[str, Any] | CooperaError
Tell: TypeAlias = Callable[[int, Event], None]


def run_studies(
    configs: Sequence[Config], *, at_once: int = 8, processes: int = 1, on_event: Tell | None = None
) -> list[Ended]:
    """Run studies side by side; none depends on which ends first, and one that fails does not stop the others.

    The threads of a process share weights, the text encoder and the pace towards servers.

    Args:
        configs: Each with an `out` of its own.
        at_once: How many run at the same time.
        processes: Over how many processes they are spread. With 1 they are threads of this one. More pay where servers
            are quick or homes busy, and cost seconds to start; each then loads weights of its own and keeps its part
            of the pace. As always with processes, a script must then do its work under `if __name__ == "__main__":`.
        on_event: DayAccount the number of the study and each node that ends, one at a time.

    Returns:
        In the order of `configs`, what `run_study` returns, or the error that ended it.

    Raises:
        ConfigError: If a configuration is wrong, or two have the same folder; nothing has then been begun.
        KeyboardInterrupt: If Ctrl-C was pressed; each run stops within its hour, or with its process a second later,
            and can be resumed.
    """
    jobs = list(enumerate(resolve(config) for config in configs))
    folders = [config.out for config in configs]
    if None in folders or len(set(folders)) < len(folders):
        raise ConfigError("out: each of several studies needs a folder of its own.")
    ended: dict[int, Ended] = {}
    spread = min(processes, at_once, len(jobs))
    if spread > 1 and any(isinstance(spec, GivenModel) for one in configs for _, spec in one.models):
        raise ConfigError("models: a chat model given as an object cannot be shared by processes; leave processes=1.")
    if spread > 1:
        with Stop():  # `kill` is heard like Ctrl-C
            _in_processes(jobs, at_once, spread, ended.__setitem__, on_event)
    else:
        _in_threads(jobs, at_once, ended.__setitem__, on_event)
    return [ended[number] for number, _ in jobs]


def _in_threads(
    jobs: Sequence[tuple[int, Config]], at_once: int, end: Callable[[int, Ended], None], on_event: Tell | None
) -> None:
    """Run studies in threads of this process; `end` and `on_event` are called from them, one at a time."""
    telling = threading.Lock()

    def one(number: int, config: Config) -> None:
        def tell(event: Event) -> None:
            if on_event is not None:
                with telling:
                    on_event(number, event)

        found: Ended
        try:
            found = run_study(config, on_event=tell, stop=stop)
        except CooperaError as err:
            found = err
        with telling:
            end(number, found)

    with Stop() as stop, ThreadPoolExecutor(max(1, at_once), thread_name_prefix="study") as pool:
        futures: list[Future[None]] = [pool.submit(one, *job) for job in jobs]
        try:
            wait_for_all(futures)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        for future in futures:
            future.result()


def _in_processes(
    jobs: Sequence[tuple[int, Config]],
    at_once: int,
    processes: int,
    end: Callable[[int, Ended], None],
    on_event: Tell | None,
) -> None:
    """Deal studies out to processes, and hear from them until all have ended."""
    context = multiprocessing.get_context("spawn")
    staff: dict[Connection, tuple[BaseProcess, set[int]]] = {}
    try:
        for n in range(processes):
            share = jobs[n::processes]
            threads = at_once // processes + (n < at_once % processes)
            life = partial(_serve, share, at_once=threads, of=processes, events=on_event is not None)
            process, pipe = start(context, life, n, processes)
            staff[pipe] = process, {number for number, _ in share}
        _hear(staff, end, on_event)
    except KeyboardInterrupt:
        stop_all([process for process, _ in staff.values()])
        _hear(staff, end, None)
        raise


def _hear(
    staff: dict[Connection, tuple[BaseProcess, set[int]]], end: Callable[[int, Ended], None], on_event: Tell | None
) -> None:
    while staff:
        for pipe in wait_for_any(list(staff)):
            assert isinstance(pipe, Connection)
            process, left = staff[pipe]
            try:
                number, event, found = pipe.recv()
            except (EOFError, ConnectionResetError):
                process.join()
                for number in left:
                    end(number, RunError(f"The process of this run died (exit code {process.exitcode})."))
                del staff[pipe]
                continue
            if event is None:
                left.remove(number)
                end(number, found)
                if not left:  # what is left of it is to end, which need not be waited for
                    del staff[pipe]
            elif on_event is not None:
                on_event(number, event)


def _serve(jobs: Sequence[tuple[int, Config]], pipe: Connection, *, at_once: int, of: int, events: bool) -> None:
    """The life of a process: its share of the studies, in threads; every event and end is told."""
    share_pace(of)

    def tell(number: int, event: Event) -> None:
        pipe.send((number, event, None))

    try:
        _in_threads(jobs, at_once, lambda number, found: pipe.send((number, None, found)), tell if events else None)
    except KeyboardInterrupt:
        return
