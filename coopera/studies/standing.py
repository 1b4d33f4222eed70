"""How far a run has come: the trace is the truth, and checkpoints that know another are put right by it.

Checkpoints hold what the trace does not, such as a question to a real person that waits for an answer. Everything else
in them follows from the trace. So checkpoints that are damaged, or that are ahead of the trace, are given up, and the
study takes over from the trace what it finds there (`coopera.graphs.recorded`). Those that are behind need no help.
"""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

from langchain_core.runnables import RunnableConfig
from langgraph.checkpoint.serde.jsonplus import JsonPlusSerializer
from langgraph.checkpoint.sqlite import SqliteSaver
from langgraph.types import StateSnapshot

from coopera.core.errors import RunError
from coopera.core.hour import DayPlan
from coopera.graphs import STATE_TYPES, build_study_graph
from coopera.rundir.directory import RunDir

CHECKPOINTS = "checkpoints.sqlite"
"""File of a run."""
THREAD: RunnableConfig = {"configurable": {"thread_id": "study"}}
"""Under which a run's checkpoints stand."""
_LOG = logging.getLogger(__name__)


def steps_done(run: RunDir, plans: Sequence[DayPlan]) -> int:
    """How many hours and evenings stand in the trace, in the order in which they are lived.

    Raises:
        RunError: If one is missing before another: nobody can say what that other followed from.
    """
    done, missing = 0, None
    for file in _files(run, plans):
        if not file.is_file():
            missing = missing or file
        elif missing:
            raise RunError(
                f"{missing}: this file is missing, though {file.relative_to(run.root)} came after it; restore it to go "
                f"on, or delete what came after it, too."
            )
        else:
            done += 1
    return done


def give_up_if_wrong(file: Path, plans: Sequence[DayPlan], done: int) -> None:
    """Remove checkpoints that are damaged or ahead of the trace, and say so; none are needed.

    Args:
        file: Their database; it need not be there.
        plans: The days of the run.
        done: How many hours and evenings stand in the trace.
    """
    if problem := wrong_checkpoints(file, plans, done):
        _LOG.warning("%s: the checkpoints are %s; the run goes on from its trace", file, problem)
        give_up(file)


def give_up(file: Path) -> None:
    """Remove checkpoints; the run goes on from its trace."""
    for part in (file, *(file.with_name(f"{file.name}{end}") for end in ("-wal", "-shm"))):
        part.unlink(missing_ok=True)


def wrong_checkpoints(file: Path, plans: Sequence[DayPlan], done: int) -> str:
    """What `give_up_if_wrong` would give checkpoints up for, in words; empty where they are right or not there."""
    if not file.is_file():
        return ""
    try:
        with open_checkpoints(file) as saver:
            return "ahead of the trace" if _steps(saver, plans) > done else ""
    except (sqlite3.DatabaseError, ValueError, TypeError, LookupError) as err:
        return f"damaged ({err})"


@contextmanager
def open_checkpoints(file: Path) -> Iterator[SqliteSaver]:
    """Open the database of checkpoints, made if need be.

    Raises:
        sqlite3.DatabaseError: If it is none, or damaged.
    """
    with closing(sqlite3.connect(file, check_same_thread=False)) as connection:
        connection.execute("PRAGMA synchronous=NORMAL")  # the trace has what a power cut loses of it
        if connection.execute("PRAGMA quick_check").fetchone() != ("ok",):
            raise sqlite3.DatabaseError("its pages do not fit together")
        yield SqliteSaver(connection, serde=serializer())


def serializer() -> JsonPlusSerializer:
    """What writes and reads the states of a study."""
    return JsonPlusSerializer(allowed_msgpack_modules=list(STATE_TYPES))


def _steps(saver: SqliteSaver, plans: Sequence[DayPlan]) -> int:
    """How many hours and evenings are behind a checkpoint; an evening under way does not count."""
    state = build_study_graph(saver).get_state(THREAD, subgraphs=True)
    days, position = int(state.values.get("ahead", 0)), 0
    if state.tasks and isinstance(within := state.tasks[0].state, StateSnapshot):
        days, position = days - 1, int(within.values.get("position", 0))
    return sum(len(plan.hours) + 1 for plan in plans[:days]) + position


def _files(run: RunDir, plans: Sequence[DayPlan]) -> Iterator[Path]:
    for plan in plans:
        yield from (run.hour_file(plan.day, hour) for hour in plan.hours)
        yield run.evening_file(plan.day)
