"""Eight studies at once against one after the other, at a server that answers every request after 200 ms.

    python -m benchmarks.concurrency [--studies 8] [--days 2] [--hours 13] [--latency 0.2] [--under-way 64]
        [--processes 1 2]

Everything but the model's words is real: homes, memories, classifiers, run directories, HTTP. The ratio is bounded by
the processors: what homes compute takes turns in each process. The time that the processes take to start counts.
The time one after the other is told beside that of its longest chains of calls, each of which waits for the one before,
and beside that and its seconds of processor, which is what it takes where nothing else runs.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import resource
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from coopera import Config, run_studies
from coopera.config.schema import Models
from coopera.core.errors import CooperaError
from coopera.models.settings import CallSettings
from coopera.people.shipped import shipped_ids
from coopera.report.costs import costs_of
from coopera.rundir.directory import RunDir
from coopera.studies.several import Ended
from tests.serving import done, serving


def main() -> None:
    """Print both times and their ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=8)
    parser.add_argument("--days", type=int, default=2)
    parser.add_argument("--hours", type=int, default=13)
    parser.add_argument("--latency", type=float, default=0.2)
    parser.add_argument("--under-way", type=int, default=64, help="requests that the server may have at a time")
    parser.add_argument("--processes", type=int, nargs="+", default=sorted({1, os.cpu_count() or 1}))
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, serving("--latency", str(given.latency)) as url:
        root = Path(folder)

        def studies(name: str) -> list[Config]:
            people = [shipped_ids()[n % len(shipped_ids())] for n in range(given.studies)]
            return [
                Config(
                    humans=[person],
                    days=given.days,
                    hours=given.hours,
                    pictures="none",
                    seed=n,
                    models=Models(human="openai:tiny", robot="openai:tiny", judge="openai:tiny"),
                    base_url=url,
                    calls=CallSettings(at_once=given.under_way),
                    out=root / name / str(n),
                    cache=root / f"{name}.sqlite",
                    data_dir=root / "data",
                )
                for n, person in enumerate(people)
            ]

        def at_once(name: str, processes: int) -> list[Ended]:
            return run_studies(studies(name), at_once=given.studies, processes=processes)

        at_once("warm", max(given.processes))  # every text is encoded once, as in any second run
        before = len(done(url))
        size = f"{given.studies} studies of {given.days} x {given.hours} hours"
        print(f"{size}, {given.latency:g} s a request; {os.cpu_count()} cores", flush=True)
        single, cpu = _timed("one after the other", lambda: run_studies(studies("single"), at_once=1))
        print(f"requests: {len(done(url)) - before}")
        chain = sum(longest_chain(root / "single" / str(n)) for n in range(given.studies)) * given.latency
        print(f"longest chains of calls that wait for each other: {chain:.1f} s; {single / chain:.2f} times that")
        print(f"chains and processor: {chain + cpu:.1f} s; {(chain + cpu) / chain:.2f} times the chains", flush=True)
        for processes in given.processes:
            name = f"at once in {processes} process{'es' if processes > 1 else ''}"
            together, _ = _timed(name, partial(at_once, name, processes))
            print(f"{name}: {single / together:.1f} times as fast")
            for n in range(given.studies):
                same = [(root / run / str(n) / "metrics.csv").read_bytes() for run in ("single", name)]
                assert same[0] == same[1], f"study {n} depends on its neighbours"


def longest_chain(run: Path) -> int:
    """How many calls of a study wait for one another: what is asked at once shares one."""
    costs = costs_of(RunDir.open(run))
    return sum(place["round_trips"] for place in (*costs["hours"], *costs["evenings"]))


def _timed(name: str, work: Callable[[], list[Ended]]) -> tuple[float, float]:
    """Do the work, print what it took, and return its seconds by the clock and of the processor.

    An error of a study ends the benchmark.
    """
    cpu, started = _cpu_seconds(), time.perf_counter()
    ended = work()
    seconds, used = time.perf_counter() - started, _cpu_seconds() - cpu
    print(f"{name}: {seconds:.1f} s, of processor time {used:.1f} s", flush=True)
    for one in ended:
        if isinstance(one, CooperaError):
            raise one
    return seconds, used


def _cpu_seconds() -> float:
    """Of this process and those that it has ended, but not of the server."""
    for process in multiprocessing.active_children():
        process.join()
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


if __name__ == "__main__":
    main()
