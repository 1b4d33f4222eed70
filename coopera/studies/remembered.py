"""What a run's memories hold by its trace, and the store put right where it holds something else."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from langchain_core.embeddings import Embeddings

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.core.hour import DayPlan
from coopera.core.people import PersonId
from coopera.evaluation import find_method
from coopera.graphs.recorded import remember_day, remember_guess, remember_lived, told
from coopera.graphs.robots.robot_view import Memories
from coopera.memory import MemoryStream, Record
from coopera.memory.damage import damage
from coopera.memory.folder import begun, locked
from coopera.memory.ram import RamClient
from coopera.memory.rebuild import rewrite, texts
from coopera.rundir.directory import RunDir
from coopera.rundir.earlier_life import open_earlier_life

Texts: TypeAlias = Mapping[str, Sequence[Record]]
"""Records by the name of their stream."""
_LOG = logging.getLogger(__name__)


def memory_folder(run: RunDir) -> Path:
    """Where a run has its memories."""
    return run.root / "memory"


def by_the_trace(run: RunDir, plans: Sequence[DayPlan]) -> Texts:
    """What everybody remembers after the hours and evenings that stand in the trace; streams without a record are out.

    Raises:
        RunError: If an hour or an evening cannot be read.
    """
    ram, method, days = _Ram(), find_method(run.config.method), open_earlier_life(run.config)
    for plan in plans:
        hours = []
        for position, hour in enumerate(plan.hours):
            if (record := run.read_hour(plan.day, hour)) is None:
                break
            hours.append(record)
            if days is None:
                remember_lived(ram, plan, plan.clock(position), record.human)
            if record.robot is not None:
                remember_guess(ram, plan, plan.clock(position), record.robot)
        if method.robot and run.read_evening(plan.day):
            remember_day(ram, plan, told(plan, hours, days.stranger if days and method.swapped else None))
    found = {name: list(stream.records()) for name, stream in sorted(ram.streams.items())}
    return {name: records for name, records in found.items() if records}


def difference(folder: Path, wanted: Texts, *, at_least: Texts | None = None) -> str:
    """What a store's texts lack, or have too much, compared with the trace; empty where they are the same.

    Args:
        folder: The store.
        wanted: What it should have.
        at_least: What that of a run which is not finished must have. It may lack the rest, and may be ahead, by what a
            step remembered that did not come to its end.
    """
    if not begun(folder):
        return "it is missing" if wanted else ""
    try:
        found = texts(folder)
    except MemoryStoreError as err:
        return f"it cannot be read ({err})"
    for name in sorted({*wanted, *found}):
        here, there = list(found.get(name, [])), list(wanted.get(name, []))
        fits = here == there
        if at_least is not None:
            fits = here[: len(there)] == there[: len(here)] and len(here) >= len(at_least.get(name, []))
        if not fits:
            return f"{name} has {len(here)} records, and not the {len(there)} of the trace"
    return ""


def index_damage(folder: Path) -> str:
    """What is wrong with a store besides its texts; empty where nothing is."""
    if not begun(folder):
        return ""
    try:
        with locked(folder):
            return damage(folder, everything=True) or ""
    except ConfigError as err:
        return str(err)


def bring_to_the_trace(run: RunDir, plans: Sequence[DayPlan], embeddings: Embeddings) -> bool:
    """Have a run remember all that its trace says; its memories are not open yet.

    What a step remembered that has not come into the trace stays: the step is done again, and then forgets it first. A
    store that lacks the newest records, as one does whose day was broken off, is given them. One that has others than
    the trace is written anew, and checkpoints do not fit it.

    Returns:
        Whether the store was written anew.
    """
    folder, wanted = memory_folder(run), by_the_trace(run, plans)
    if not (what := difference(folder, wanted, at_least={})):
        _add_what_is_missing(folder, wanted, embeddings)
        return False
    kept = rewrite(folder, wanted, embeddings)
    aside = f"; what was there is kept in {kept}" if kept else ""
    _LOG.warning("%s: %s; the memory was rebuilt from the trace%s", folder, what, aside)
    return True


def _add_what_is_missing(folder: Path, wanted: Texts, embeddings: Embeddings) -> None:
    """Give a store the newest records, where all that it has are those of the trace."""
    found = texts(folder) if begun(folder) else {}
    for name, records in wanted.items():
        if missing := records[len(found.get(name, [])) :]:
            with MemoryStream.open(folder, name, embeddings) as stream:
                stream.extend(missing)


@dataclass(frozen=True, slots=True)
class _Ram:
    """Memories without a store; implements `coopera.graphs.recorded.Remembering`."""

    client: RamClient = field(default_factory=RamClient)
    streams: dict[str, MemoryStream] = field(default_factory=dict)

    def memories(self, owner: str, episode: int, person: PersonId) -> Memories:
        stem = f"{owner}/{episode}/{person}"
        return Memories(self._stream(f"{stem}/intentions"), self._stream(f"{stem}/tasks"))

    def _stream(self, name: str) -> MemoryStream:
        if name not in self.streams:
            self.streams[name] = MemoryStream.open(self.client, name, _Unread())
        return self.streams[name]


class _Unread(Embeddings):
    """Vectors for texts that nobody searches."""

    dimension = 1

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [[1.0]] * len(texts)

    def embed_query(self, text: str) -> list[float]:
        return [1.0]
