"""A run's acts done again from its trace alone: no model, no memory, and in the end the very same world.

Each hour's trace holds what everybody did, in order, and the hash of the home afterwards. Replayed hours may be filmed,
so that a run without pictures can be looked at later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple, TypeAlias

from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import HourRecord
from coopera.core.household import HUMAN, Outcome, SceneId
from coopera.rundir.directory import RunDir
from coopera.rundir.trace_files import human_outcomes
from coopera.simulation import World
from coopera.simulation.state.home_state import HomeState
from coopera.simulation.state.snapshots import digest
from coopera.studies.assemble import open_embeddings, open_home


class Replayed(NamedTuple):
    """How one hour came out: the first difference as a sentence, empty where there is none, and the home after it.

    Where there is a difference, the home is as the trace has it.
    """

    day: int
    hour: int
    acts: int
    difference: str
    home: HomeState


Look: TypeAlias = Callable[[HourRecord, World], None]
Each: TypeAlias = Callable[[HourRecord, Outcome, World], None]


def replay(run: RunDir, look: Look | None = None, each: Each | None = None) -> Iterator[Replayed]:
    """Do all acts of a run again, hour by hour; every episode begins with its homes as they were built.

    The homes are not set from the trace, so each hour builds on all hours before it. There is one exception: after an
    hour with a difference the home is set to the state in the trace, so later hours are judged by themselves.

    Args:
        run: The run, open for reading.
        look: Called after each hour's first act, while its recording is there.
        each: Called after each act with what came of it now.

    Raises:
        RunError: If the run has no hours yet, or its people lived their hours in another run.
    """
    if run.config.earlier_life is not None:
        raise RunError(
            f"{run.root}: this run met days lived before; replay that life instead: {run.config.earlier_life}."
        )
    records = run.hours()
    if not records:
        raise RunError(f"{run.root}: there are no hours to replay yet.")
    homes: dict[SceneId, World] = {}
    episode, people = None, run.people()
    with open_embeddings(run.config) as embeddings, ExitStack() as stack:
        for record in records:
            if record.episode != episode:
                episode = record.episode
                for home in homes.values():
                    home.restore({})
            if record.scene not in homes:
                home = open_home(run.config, record.scene, embeddings, run.root)
                homes[record.scene] = stack.enter_context(home)
            if record.person in people:
                homes[record.scene].inhabit(HUMAN, people[record.person])
            yield _hour(homes[record.scene], record, look, each)


def _hour(home: World, record: HourRecord, look: Look | None, each: Each | None) -> Replayed:
    expected = _in_order(record)
    watched = record.world.get("watched", record.robot is not None)
    difference = ""
    for number, then in enumerate(expected):
        now = home.perform(then.agent, then.act, record=watched and number == 0)
        if look is not None and watched and number == 0:
            look(record, home)
        if each is not None:
            each(record, now, home)
        if _done(now) != _done(then) and not difference:
            what = f"act {number + 1} ({then.agent}: {then.act.describe()})"
            difference = f"{what} came out as {_said(now)}, not {_said(then)}"
    left = record.world.get("poses", {})
    done = home.snapshot()
    home.restore(left)
    wanted = record.world.get("sha256") if left.get("version") == done["version"] else None
    if digest(done) != (wanted or digest(home.snapshot())):
        difference = difference or "the home is not as it was left"
    return Replayed(record.day, record.hour, len(expected), difference, home.state)


def _in_order(record: HourRecord) -> list[Outcome]:
    """The hour's acts in the order in which they were done: the person's first, the robot's, the person's others."""
    own, helped = human_outcomes(record), record.robot.outcomes if record.robot else []
    shown = 1 if record.world.get("watched", record.robot is not None) else 0
    return [*own[:shown], *helped, *own[shown:]]


def _done(outcome: Outcome) -> Outcome:
    """An outcome without the cosine, which another processor may work out a little differently."""
    return outcome.model_copy(update={"cosine": None})


def _said(outcome: Outcome) -> str:
    if not outcome.ok:
        return f"failed: {outcome.reason}"
    motion = f" as {outcome.motion!r}" if outcome.motion is not None else ""
    took = [*outcome.fetched, *outcome.opened]
    return f"done{motion} in {outcome.metres} m{' with ' + ', '.join(took) if took else ''}"


def film_into(folder: Path, frames: int) -> Look:
    """Return a `look` that renders each recording into folder/day-DD/hour-HH.

    Raises:
        ConfigError: If the folder is a file.
    """
    if folder.exists() and not folder.is_dir():
        raise ConfigError(f"--frames: {folder} must be a folder, and it is a file.")

    def look(record: HourRecord, world: World) -> None:
        world.frames(frames, folder / f"day-{record.day:02d}" / f"hour-{record.hour:02d}")

    return look
