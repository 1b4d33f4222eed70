"""What is wrong with a run, part by part: looked for without changing anything.

Config, people, homes, hours and evenings are the truth: nothing else holds them. Memories, adapters, figures, report
and pictures follow from them. Checkpoints are not needed: a resume takes over what stands in the trace.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from coopera.core.errors import CooperaError, RunError
from coopera.core.hour import DayPlan
from coopera.core.version import __version__
from coopera.graphs.recorded import world_after
from coopera.rundir import seals
from coopera.rundir.directory import RunDir
from coopera.studies.remembered import by_the_trace, difference, index_damage, memory_folder
from coopera.studies.standing import CHECKPOINTS, steps_done, wrong_checkpoints
from coopera.studies.study import plan_days

_PARTS = {
    "config.yaml": "config",
    "run.json": "config",
    "scenes": "homes",
    "frames": "pictures",
    "video": "pictures",
    **dict.fromkeys(seals.FIGURES, "figures"),
    seals.REPORT: "report",
}
TRUTH = ("config", "people", "homes", "trace")
"""What nothing else holds."""


class Finding(NamedTuple):
    """One thing that is wrong with a run.

    Attributes:
        part: config, people, homes, trace, seal, checkpoints, memory, adapters, pictures, figures or report.
        file: Its path in the run.
        what: What is wrong, in words.
        mended: Whether it has been put right.
        note: Why it has not, or with what result.
    """

    part: str
    file: str
    what: str
    mended: bool = False
    note: str = ""


def findings(run: RunDir, *, index: bool = True) -> list[Finding]:
    """All that is wrong with a run.

    Where the truth is not whole, what follows from it cannot be judged, and is left out.

    Args:
        run: The run; nobody writes it meanwhile.
        index: Whether to look into the memory's index too, which takes a process of its own.
    """
    found = [_as_finding(one) for one in seals.broken(run.root)]
    if any(one.part == "config" for one in found):
        return found
    plans = plan_days(run.config)
    known = {one.file for one in found}
    found += [one for one in (*_trace(run, plans), *_people(run, plans)) if one.file not in known]
    if any(one.part in TRUTH for one in found):
        return found
    known = {one.file for one in found}
    parts = [*_unsealed(run), *_figures(run)]
    if run.resumable:
        parts += [*_memory(run, plans, index), *_checkpoints(run, plans)]
    return found + [one for one in parts if one.file not in known]


def _as_finding(one: seals.Broken) -> Finding:
    what = f"missing, though {one.by} names it" if one.what == "missing" else f"not as {one.by} has it"
    if one.file == one.by:
        what = "damaged"
    return Finding(_PARTS.get(one.kind, one.kind), one.file, what)


def _trace(run: RunDir, plans: Sequence[DayPlan]) -> Iterator[Finding]:
    odd = []
    for plan in plans:
        for position, hour in enumerate(plan.hours):
            odd += _record(run, run.hour_file(plan.day, hour), partial(_hour, run, plan, position))
        odd += _record(run, run.evening_file(plan.day), partial(_evening, run, plan))
    odd += [
        Finding("trace", f"trace/day-{day:02d}", "no such day is planned in config.yaml")
        for day in sorted(set(run.days()) - {plan.day for plan in plans})
    ]
    yield from odd
    if not odd:
        yield from _whole_line(run, plans)


def _record(run: RunDir, file: Path, read: Callable[[], None]) -> list[Finding]:
    try:
        read()
    except RunError as err:
        return [Finding("trace", _name(run, file), str(err).removeprefix(f"{file}: ").rstrip("."))]
    return []


def _hour(run: RunDir, plan: DayPlan, position: int) -> None:
    record = run.read_hour(plan.day, plan.hours[position])
    if record is None:
        return
    at = (record.day, record.hour, record.person, record.scene, record.episode, record.episode_day)
    if at != (plan.day, plan.hours[position], plan.person, plan.scene, plan.episode, plan.episode_day):
        raise RunError("this is another hour than its name and config.yaml say.")
    world_after(record)


def _evening(run: RunDir, plan: DayPlan) -> None:
    evening = run.read_evening(plan.day)
    if evening and (evening.day, evening.person, evening.episode) != (plan.day, plan.person, plan.episode):
        raise RunError("this is another evening than its name and config.yaml say.")


def _whole_line(run: RunDir, plans: Sequence[DayPlan]) -> Iterator[Finding]:
    """Whether the hours and evenings follow each other without a hole, to the end if the run is finished."""
    try:
        done = steps_done(run, plans)
    except RunError as err:
        file, _, what = str(err).partition(": ")
        yield Finding("trace", _name(run, Path(file)), what.rstrip("."))
        return
    if run.state == "finished" and done < sum(len(plan.hours) + 1 for plan in plans):
        yield Finding("trace", "trace", "the run is finished, and not all of its hours and evenings are there")


def _people(run: RunDir, plans: Sequence[DayPlan]) -> Iterator[Finding]:
    for person in sorted({plan.person for plan in plans}):
        if not (run.root / "people" / f"{person}.yaml").is_file():
            yield Finding("people", f"people/{person}.yaml", "missing")
    try:
        run.people()
    except CooperaError as err:
        place, _, what = str(err).partition(": ")
        file, _, line = place.partition(", line ")
        what = f"line {line}: {what}" if line else what
        yield Finding("people", _name(run, Path(file)) if file.startswith(str(run.root)) else "people", what)


def _unsealed(run: RunDir) -> Iterator[Finding]:
    """Finished days of a run with seals that have none."""
    for day in run.days() if seals.is_sealed(run.root) else []:
        if run.evening_file(day).is_file() and not (seal := seals.day_seal(run.root, day)).is_file():
            yield Finding("seal", _name(run, seal), "missing")


def _figures(run: RunDir) -> Iterator[Finding]:
    if run.state == "finished":
        files = [*seals.FIGURES, *([seals.REPORT] if run.resumable else [])]
        for name in files:
            if not (run.root / name).is_file():
                yield Finding(_PARTS[name], name, "missing")
        return
    same = run.info.get("versions", {}).get("coopera") == __version__  # another one may have other columns
    if same and run.evenings() and run.metrics_so_far() != _text(run.root / "metrics.csv"):
        yield Finding("figures", "metrics.csv", "not what follows from the trace")


def _memory(run: RunDir, plans: Sequence[DayPlan], index: bool) -> Iterator[Finding]:
    folder = memory_folder(run)
    try:
        least = None
        if run.state != "finished":  # a resume gives it the hours of the day that was broken off
            least = by_the_trace(run, [plan for plan in plans if run.read_evening(plan.day)])
        what = difference(folder, by_the_trace(run, plans), at_least=least)
    except CooperaError as err:  # of an earlier life that is gone
        what = str(err)
    if what := what or (index_damage(folder) if index else ""):
        yield Finding("memory", "memory", what)


def _checkpoints(run: RunDir, plans: Sequence[DayPlan]) -> Iterator[Finding]:
    if what := wrong_checkpoints(run.root / CHECKPOINTS, plans, steps_done(run, plans)):
        yield Finding("checkpoints", CHECKPOINTS, what)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""


def _name(run: RunDir, path: Path) -> str:
    return path.relative_to(run.root).as_posix()
