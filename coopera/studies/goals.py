"""Which goals the days of a run met: its acts are done again from the trace, and the home is asked after each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import NamedTuple

from coopera.core.errors import ConfigError, RunError
from coopera.core.hour import HourRecord
from coopera.core.household import HUMAN, ROBOT, AgentId, Outcome, SceneId
from coopera.core.people import PersonId
from coopera.rundir.directory import RunDir
from coopera.simulation import Scene, World
from coopera.simulation.goals.atoms import Moment
from coopera.simulation.goals.checking import check
from coopera.simulation.goals.judging import outcome
from coopera.simulation.goals.tree import Goal
from coopera.simulation.motions.user_folder import load_motions
from coopera.simulation.state.home_state import HomeState, Kind
from coopera.studies.assemble import open_layout
from coopera.studies.replay import replay

_THEY: dict[AgentId, Kind] = {HUMAN: "person", ROBOT: "robot"}


class After(NamedTuple):
    """A moment of a day: after an act, which is counted from 1 within the hour, or without one at the hour's end."""

    hour: int
    act: int | None = None
    agent: str | None = None
    did: str | None = None


class GoalOfDay(NamedTuple):
    """How a goal came out on a day: whether the day met it, and after what the day so far met it first."""

    goal: str
    met: bool
    first: After | None


class JudgedDay(NamedTuple):
    """A day, its goals, and what did not come out as the trace says, as sentences."""

    day: int
    person: PersonId
    scene: SceneId
    goals: list[GoalOfDay]
    differences: list[str]


def judge_days(run: RunDir, goals: Mapping[str, Goal], source: str) -> Iterator[JudgedDay]:
    """Ask of each day of a run which goals it met.

    A day's moments are those after each act, failed ones included. Of an hour whose acts do not come out as the trace
    says, there is one moment: its end, as it is in the trace.

    Args:
        run: The run, open for reading.
        goals: The goals by name.
        source: Names the goals' file in errors.

    Raises:
        ConfigError: If a goal has a word that means nothing in any home of the run.
        RunError: If the run cannot be replayed; see `coopera.studies.replay.replay`.
    """
    records = run.hours()
    if not records:
        raise RunError(f"{run.root}: there are no hours yet.")
    layouts = {scene: open_layout(run.config, scene, run.root) for scene in sorted({one.scene for one in records})}
    _check(run, goals, list(layouts.values()), source)
    passed: list[tuple[After, HomeState]] = []

    def each(record: HourRecord, done: Outcome, home: World) -> None:
        passed.append((After(record.hour, len(passed) + 1, done.agent, done.act.describe()), home.state))

    redone = replay(run, each=each)
    for day, hours in groupby(records, lambda record: record.day):
        moments: list[tuple[After, HomeState]] = []
        differences = []
        lived = list(hours)
        for hour in lived:
            again = next(redone)
            if again.difference:
                differences.append(f"Day {day}, {hour.hour}:00: {again.difference}.")
                passed[:] = [(After(hour.hour), again.home)]
            moments += passed
            passed.clear()
        person, scene = lived[0].person, lived[0].scene
        found = [_judged(name, goal, layouts[scene], moments) for name, goal in goals.items()]
        yield JudgedDay(day, person, scene, found, differences)


def _check(run: RunDir, goals: Mapping[str, Goal], layouts: list[Scene], source: str) -> None:
    motions = load_motions(run.config.motions).captions
    for name, goal in goals.items():
        try:
            check(goal, layouts, _THEY, motions)
        except ConfigError as err:
            raise ConfigError(f"{source}, goals.{name}: {err}") from err


def _judged(name: str, goal: Goal, layout: Scene, moments: list[tuple[After, HomeState]]) -> GoalOfDay:
    found = outcome(goal, [Moment(layout, state) for _, state in moments])
    return GoalOfDay(name, found.met, None if found.first is None else moments[found.first][0])
