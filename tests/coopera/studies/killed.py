"""Lives of a run that end with SIGKILL: after a node has done its work, or ahead of what is written of them."""

from __future__ import annotations

import functools
import os
import signal
import threading
from pathlib import Path
from typing import Any, Literal

from coopera import Config, resume_study, run_study
from coopera.core.hour import Evening, HourRecord
from coopera.graphs import day, hour, study
from coopera.rundir.behind import Behind
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
    if place is not None:
        module, name = NODES[place]
        setattr(module, name, dying(getattr(module, name)))
    _go_on(run, "none")


def live_ahead(run: Path, dies: bool) -> None:
    """Begin or resume a short run with pictures; those of the first day's last hour may never be there.

    It then dies when the next day's first hour is to be written, as the third thing that waits.
    """
    if dies:
        Behind.write = _waiting(Behind.write)  # type: ignore[method-assign]
    _go_on(run, "sampled")


def _go_on(run: Path, pictures: Literal["none", "sampled"]) -> None:
    assemble.bundled = lambda path: LetterEmbeddings()
    if (run / "run.json").is_file():
        resume_study(run)
    else:
        run_study(Config(days=2, hours=2, pictures=pictures, frames=1, out=run, data_dir=run.parent / "data"))


def _waiting(write: Any) -> Any:
    def waits(behind: Any, what: HourRecord | Evening, job: Any, after: Any = None) -> None:
        if isinstance(what, HourRecord) and what.day == 0 and after is not None and what.hour > 9:
            after = threading.Event().wait
        write(behind, what, job, after)
        if what.day == 1:
            os.kill(os.getpid(), signal.SIGKILL)

    return waits


def dying(node: Any) -> Any:
    @functools.wraps(node)
    def once(*args: Any, **kwargs: Any) -> Any:
        node(*args, **kwargs)
        os.kill(os.getpid(), signal.SIGKILL)

    return once
