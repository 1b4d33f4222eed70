"""The error budget of runs: read from their traces, as rows for tables and files, and for the report."""

from __future__ import annotations

import csv
import functools
import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError
from coopera.core.hour import Evening, HourRecord
from coopera.core.household import SceneId
from coopera.evaluation.methods import find_method
from coopera.evaluation.predicate import Predicate
from coopera.evaluation.robot.error_budget import FALSE, LOST, Budget, DayBudget, Helps, budgets, by_day, pool
from coopera.memory.embeddings import bundled
from coopera.rundir.directory import RunDir
from coopera.simulation.homes.scene import Scene, load_scene

SHORT = {
    "not_imagined": "not imagined",
    "intention_rejected": "rejected",
    "not_among_tasks": "no task",
    "task_rejected": "declined",
    "not_done": "failed",
    "unknown": "unknown",
}
"""Headings of `LOST` where there is little room."""


class RunBudget(NamedTuple):
    """The error budget of one run, day by day."""

    run: str
    method: str
    days: list[DayBudget]

    @property
    def total(self) -> Budget:
        """Of all its days."""
        return pool(day.budget for day in self.days)


@dataclass(frozen=True, slots=True)
class _Home:
    """A home as an hour left it, of which the predicate asks classes alone."""

    layout: Callable[[], Scene]
    box: Mapping[str, Any]

    def class_of(self, name: str) -> str:
        """The object's class; what came out of the magic box is what it was called by."""
        if name in self.box:
            return str(self.box[name]["text"])
        thing = self.layout().object(name)
        return thing.cls if thing is not None else name


def read_budget(run: RunDir) -> RunBudget:
    """The error budget of a run, from its trace.

    Raises:
        RunError: If the trace is damaged.
        ConfigError: If one of its homes cannot be found any more.
    """
    return budget_of(run, run.hours(), run.evenings())


def budget_of(run: RunDir, hours: Sequence[HourRecord], evenings: Iterable[Evening]) -> RunBudget:
    """The error budget of a run whose trace is read already; by the predicate, as the run was measured.

    Raises:
        ConfigError: If one of its homes cannot be found any more.
    """
    with predicate_of(run) as helps:
        found = budgets(hours, evenings, helps, imagines=imagines(run.config.method))
    return RunBudget(str(run.root), run.config.method, found)


@contextmanager
def predicate_of(run: RunDir) -> Iterator[Callable[[HourRecord], Helps]]:
    """The predicate as the run was measured by it, in the home of each of its hours.

    Raises:
        ConfigError: When it is asked, if one of its homes cannot be found any more.
    """
    folders = home_folders(run)
    layout = functools.cache(lambda scene: load_scene(SceneId(scene), folders))
    data = run.config.data_dir.resolve()
    with bundled(data / "embeddings.sqlite" if data.is_dir() else None) as embeddings:  # it may be of another machine
        predicate = Predicate(embeddings)

        def helps(hour: HourRecord) -> Helps:
            box = hour.world.get("poses", {}).get("box", {})
            return functools.partial(predicate.helps, _Home(functools.partial(layout, hour.scene), box))

        yield helps


def home_folders(run: RunDir) -> list[Path]:
    """Where homes of a run lie besides the shipped ones."""
    return [run.config.data_dir / "scenes", run.root / "scenes"]


def shares(budget: Budget) -> dict[str, float | None]:
    """Share of the missed tasks that was lost at each place, in [0, 1]; None where none was missed."""
    return {name: count / budget.missed if budget.missed else None for name, count in budget.lost.items()}


def in_words(budget: Budget) -> tuple[list[str], list[list[str]]]:
    """Where the tasks of some hours were lost and why help was of no use, as a table."""
    rows = [["the person's remaining tasks", str(budget.remaining), ""], ["  helped", str(budget.helped), ""]]
    rows += [["  missed", str(budget.missed), "100 %" if budget.missed else ""]]
    rows += [[f"    {LOST[name]}", str(count), _percent(count, budget.missed)] for name, count in budget.lost.items()]
    rows += [["the robot's accepted acts", str(budget.accepted), ""], ["  failed", str(budget.failed), ""]]
    rows += [["  of no use", str(budget.useless), "100 %" if budget.useless else ""]]
    rows += [[f"    {FALSE[why]}", str(count), _percent(count, budget.useless)] for why, count in budget.false.items()]
    return ["where help is lost", "number", "share"], rows


def day_rows(days: Sequence[DayBudget]) -> tuple[list[str], list[list[str]]]:
    """By day of the episode: where tasks were lost, in percent of those missed, and how many acts were of no use."""
    rows = []
    for day, budget in by_day(days).items():
        lost = [f"{100 * count / budget.missed:.1f}" if budget.missed else "–" for count in budget.lost.values()]
        rows.append([str(day), str(budget.missed), *lost, str(budget.useless)])
    return ["day", "missed", *SHORT.values(), "false"], rows


def as_data(found: Sequence[RunBudget]) -> dict[str, Any]:
    """All runs as plain data, and by method all of them together."""
    methods = list(dict.fromkeys(one.method for one in found))
    return {
        "runs": [
            {
                "run": one.run,
                "method": one.method,
                "days": [{**day._asdict(), "budget": day.budget.figures()} for day in one.days],
                "total": one.total.figures(),
            }
            for one in found
        ],
        "total": {method: _with_shares(pool(one.total for one in found if one.method == method)) for method in methods},
        "by_day": {
            method: {str(day): _with_shares(budget) for day, budget in by_day(of_method(found, method)).items()}
            for method in methods
        },
        "causes": {"lost": LOST, "false": FALSE},
    }


def of_method(found: Sequence[RunBudget], method: str) -> list[DayBudget]:
    """All days under a method."""
    return [day for one in found if one.method == method for day in one.days]


def write_budget(found: Sequence[RunBudget], folder: Path) -> None:
    """Write error-budget.json, and error-budget.csv with a row for each run and day.

    Raises:
        ConfigError: If the folder cannot be written.
    """
    text = io.StringIO()
    counts = ("hours", "remaining", "helped", "missed", "accepted", "failed", "useless")
    names = ["run", "method", "episode", "day", "person", "scene", *counts]
    names += [*(f"lost_{name}" for name in LOST), *(f"false_{name}" for name in FALSE)]
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    for one in found:
        for day in one.days:
            figures = day.budget.figures()
            about = {"run": one.run, "method": one.method, "episode": day.episode, "day": day.day}
            causes = {f"{kind}_{name}": n for kind in ("lost", "false") for name, n in figures[kind].items()}
            about |= {"person": day.person, "scene": day.scene} | {name: figures[name] for name in counts}
            writer.writerow(about | causes)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_atomic(folder / "error-budget.csv", text.getvalue())
        write_atomic(folder / "error-budget.json", canonical_json(as_data(found)))
    except OSError as err:
        raise ConfigError(f"--out: {folder} cannot be written ({reason(err)}).") from err


def _with_shares(budget: Budget) -> dict[str, Any]:
    return {**budget.figures(), "shares": shares(budget)}


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else ""


def imagines(name: str) -> bool:
    """Whether a method imagines intentions; one that is not known here is taken to."""
    try:
        return find_method(name).intentions != "skipped"
    except ConfigError:
        return True
