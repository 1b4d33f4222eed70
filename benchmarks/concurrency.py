"""Eight studies at once against one after the other, at a server that answers every request after 200 ms.

    python -m benchmarks.concurrency [--studies 8] [--hours 3] [--latency 0.2]

Everything but the model's words is real: homes, memories, classifiers, run directories, HTTP. The ratio is bounded by
the processor: what the homes compute takes turns.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from coopera import Config
from coopera.config import Models
from coopera.humans import shipped_ids
from coopera.studies import run_studies
from core.errors import CooperaError
from tests.serving import done, serving


def main() -> None:
    """Print both times and their ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=8)
    parser.add_argument("--hours", type=int, default=3)
    parser.add_argument("--latency", type=float, default=0.2)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, serving("--latency", str(given.latency)) as url:
        root = Path(folder)

        def studies(name: str, cache: str) -> list[Config]:
            people = [shipped_ids()[n % len(shipped_ids())] for n in range(given.studies)]
            return [
                Config(
                    humans=[person],
                    days=1,
                    hours=given.hours,
                    pictures="none",
                    seed=n,
                    models=Models(human="openai:tiny", robot="openai:tiny", judge="openai:tiny"),
                    base_url=url,
                    out=root / name / str(n),
                    cache=root / cache,
                    data_dir=root / "data",
                )
                for n, person in enumerate(people)
            ]

        run_studies(studies("warm", "warm.sqlite"))  # every text is encoded once, as in any second run
        before = len(done(url))
        single = _seconds(lambda: [run_studies([config]) for config in studies("single", "single.sqlite")])
        asked = len(done(url)) - before
        together = _seconds(lambda: run_studies(studies("together", "together.sqlite"), at_once=given.studies))
        for n in range(given.studies):
            same = [_trace(root / name / str(n)) for name in ("single", "together")]
            assert same[0] == same[1], f"study {n} depends on its neighbours"
    requests = f"{asked} requests of {given.latency:g} s each"
    print(f"{given.studies} studies of {given.hours} hours, {requests}; {os.cpu_count()} cores")
    print(f"one after the other: {single:.1f} s; at once: {together:.1f} s; ratio {single / together:.1f}")


def _seconds(work: Callable[[], Any]) -> float:
    started = time.perf_counter()
    found = work()
    seconds = time.perf_counter() - started
    for error in (one for many in found for one in (many if isinstance(many, list) else [many])):
        if isinstance(error, CooperaError):
            raise error
    return seconds


def _trace(run: Path) -> bytes:
    return (run / "metrics.csv").read_bytes()


if __name__ == "__main__":
    main()
