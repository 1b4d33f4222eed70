"""A life of a run that ends with SIGKILL right after a node has done its work, before anybody knows that it has."""

from __future__ import annotations

import functools
import os
import signal
from pathlib import Path
from typing import Any

from coopera import Config, resume_study, run_study
from coopera.graphs import day, hour, study
from coopera.studies import assemble
from tests.fakes import LetterEmbeddings

NODES = [
    (study, "next_day"),
    (day, "start_day"),
    (day, "hour"),
    *((hour, name) for name in ("live", "demonstrate", "help_person", "finish", "score", "record")),
    *((day, name) for name in ("feedback", "infer_traits", "learn", "end_day")),
]
"""The functions of the nodes, in the order of the kills: the first hour as a whole, the second node by node."""


def live(run: Path, place: int | None) -> None:
    """Begin or resume a short run, and die after the node at this place of `NODES`."""
    assemble.bundled = lambda path: LetterEmbeddings()
    if place is not None:
        module, name = NODES[place]
        setattr(module, name, dying(getattr(module, name)))
    if (run / "run.json").is_file():
        resume_study(run)
    else:
        run_study(Config(days=2, hours=2, pictures="none", out=run, data_dir=run.parent / "data"))


def dying(node: Any) -> Any:
    @functools.wraps(node)
    def once(*args: Any, **kwargs: Any) -> Any:
        node(*args, **kwargs)
        os.kill(os.getpid(), signal.SIGKILL)

    return once
