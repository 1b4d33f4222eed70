"""A benchmark: a grid of runs, each in a folder of its own, side by side, and picked up where it was left."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import yaml
from pydantic import ValidationError

from coopera.benchmark.stated import FILE as STATED
from coopera.benchmark.stated import Statement, endpoint_of, read_statements, standing, state, statement
from coopera.config.at_most import at_most, smaller
from coopera.config.declared import in_words_of_today
from coopera.config.files import canonical_json, read_yaml, reason, write_atomic
from coopera.config.schema import AS_BEFORE, Config, load_config
from coopera.core.errors import ConfigError, RunError
from coopera.core.naming import sha256
from coopera.core.people import Frozen
from coopera.core.strict_yaml import load_yaml
from coopera.core.version import __version__
from coopera.evaluation.grid import OF, Grid, Life, Variant, check_names, lives, read_grid
from coopera.evaluation.grid import SHARED as WITH_SHARED
from coopera.evaluation.latency import robot_seconds
from coopera.evaluation.results import FORMAT, Card, Row, rows_of, to_csv
from coopera.models.settings import SHARED
from coopera.rundir import claim
from coopera.rundir.directory import RunDir
from coopera.rundir.fingerprints import fingerprints
from coopera.rundir.trace_files import damaged, read_json
from coopera.studies.catalogues import load_catalogues, resolve
from coopera.studies.own_files import names_file
from coopera.studies.workers import Done, work_through

NOBODY = "none"
"""The method by which each life is lived first."""

ROWS = "rows.json"
_DECIDES = {"models", "household", "classifier", "prompts", "person_model", "intentions"}
_OF_THE_GRID = {"setting", "schedule", "collab", "humans", "scenes", "days", "hours"}
_OF_THE_GRID |= {"method", "seed", "out", "earlier_life"}
_OF_A_RUN = _OF_THE_GRID | {"data_dir", "cache", "files", "base_url", "prompts"}


@dataclass(frozen=True, slots=True)
class RunJob:
    """One run of the grid; a life's own run comes before those of the methods that meet it."""

    name: str
    after: str | None
    folder: Path
    config: Config
    labels: dict[str, Any]
    """method, setting, collab, seed and episode of its rows."""

    @property
    def life(self) -> str:
        """The life that it is, or that its method meets."""
        return self.name.partition("/")[0]


@dataclass(frozen=True, slots=True)
class Benchmark:
    """A grid with the runs that it comes to, in a folder."""

    root: Path
    grid: Grid
    jobs: list[RunJob]

    @property
    def left(self) -> list[RunJob]:
        """Those that are not done."""
        return [job for job in self.jobs if not _is_done(job)]


def plan(grid: Grid, out: Path, config: Config) -> Benchmark:
    """Lay out the runs of a grid and check every one of them before the first begins.

    Args:
        grid: What is covered.
        out: The benchmark's folder.
        config: What all runs share.

    Raises:
        ConfigError: If a name is unknown, people or homes do not suffice, or the folder holds another grid.
    """
    known = load_catalogues(config)
    people, scenes = _chosen("humans", grid.humans, known.people), _chosen("scenes", grid.scenes, known.scenes)
    methods = [name for name in grid.methods if name != NOBODY]
    if len(set(methods)) < len(methods):
        raise ConfigError("methods: each may stand once.")
    check_names(grid)
    jobs: list[RunJob] = []
    beside = _variants(grid, config)
    for life in lives(grid, people, scenes):
        base = _life_config(life, grid, config)
        home = out / "lives" / life.name
        jobs.append(_job(life, NOBODY, home, None, base))
        for method in methods:
            jobs.append(_job(life, method, out / "runs" / life.name / method, home, base))
        for one, changed in beside:
            varied = base.model_copy(update=changed)
            jobs.append(_job(life, one.method, out / "runs" / life.name / one.name, home, varied, one.name))
    for job in {(job.config.method, job.labels["setting"], job.labels["episode"]): job for job in jobs}.values():
        resolve(job.config.model_copy(update={"out": None, "earlier_life": None}), known)
    return Benchmark(out, grid, jobs)


@contextmanager
def claimed_folder(bench: Benchmark, *, restate: bool = False) -> Iterator[Statement]:
    """Make the folder, or go on in it if it holds the same grid; while entered, nobody else works in it.

    Args:
        bench: What is to be run.
        restate: Whether its endpoint may differ from the folder's although runs have begun.

    Yields:
        What the endpoint is, stamped before anything is run.

    Raises:
        ConfigError: If it cannot be written or holds something else, another endpoint among it.
        RunError: If another process works in it.
    """
    if _holds_something_else(bench.root):
        raise ConfigError(f"out: {bench.root} is not empty and holds no benchmark; choose another folder.")
    try:
        bench.root.mkdir(parents=True, exist_ok=True)
        lock = claim.lock(bench.root, "benchmark")
    except OSError as err:
        raise ConfigError(f"out: {bench.root} cannot be written ({reason(err)}).") from err
    with lock:
        former = _check_grid(bench)
        today = state(bench.root, _statement(bench), former, restate=restate)
        _note_grid(bench)
        yield today


def _holds_something_else(root: Path) -> bool:
    """Whether a folder is not empty and no benchmark's; one killed before its grid stood left the files before it."""
    if not root.is_dir() or (root / "grid.yaml").is_file():
        return False
    there = set(os.listdir(root)) - {"lock", STATED}
    return any(not (name.startswith((".grid.yaml.", f".{STATED}.")) and name.endswith(".tmp")) for name in there)


def _statement(bench: Benchmark) -> Statement:
    lived = [(job.config.seed, job.config.schedule or []) for job in bench.jobs if job.after is None]
    begun = len(list((bench.root / "runs").glob("*/*/run.json")))
    return statement(bench.grid, lived, begun)


def _grid_text(bench: Benchmark) -> str:
    shared = bench.jobs[0].config.model_dump(mode="json", include=_DECIDES)
    return yaml.safe_dump({**bench.grid.model_dump(mode="json"), "shared": shared}, sort_keys=False)


def _check_grid(bench: Benchmark) -> dict[str, Any] | None:
    """Return the endpoint of the folder's grid.yaml, if there is one; refuse a grid that differs in what may not."""
    path = bench.root / "grid.yaml"
    if not path.is_file():
        return None
    before, now = read_yaml(path, "grid of this benchmark"), load_yaml(_grid_text(bench))
    for key in ("run", "shared"):
        if not isinstance(before.get(key) or {}, dict):
            raise ConfigError(f"{path}: {key} must be a mapping of settings to values.")
        before[key] = in_words_of_today(Config, before.get(key) or {}, f"{path}: {key}")
    was = {name: value for name, value in AS_BEFORE.items() if name in _DECIDES}
    before["shared"] = {**was, **before["shared"]}
    for one in (before, now):  # what `shared` says of these counts, however it was asked for
        one["run"] = {name: value for name, value in one["run"].items() if name not in _DECIDES}
    # methods, seeds and settings may be added to what was run
    fixed = ("hours", "days", "run", "shared", "humans", "scenes", "schedules", "pairing")
    before.setdefault("pairing", "every")
    if odd := [name for name in fixed if before.get(name) != now.get(name)]:
        raise ConfigError(f"out: {bench.root} holds a grid with other {odd[0]}; choose another folder.")
    of_the_endpoint: dict[str, Any] = {
        name: before[name] for name in ("endpoint", "late_days", "early_days") if name in before
    }
    return endpoint_of(read_grid(of_the_endpoint, str(path))) if before.get("methods") else None


def _note_grid(bench: Benchmark) -> None:
    try:
        write_atomic(bench.root / "grid.yaml", _grid_text(bench))
    except OSError as err:
        raise ConfigError(f"out: {bench.root} cannot be written ({reason(err)}).") from err


def carry_out(
    bench: Benchmark, *, workers: int = 1, ray: str | None = None, deadline: float | None = None
) -> Generator[Done]:
    """Do what is left, yielding each run as it ends.

    Args:
        bench: Planned, its folder claimed.
        workers: Processes on this machine.
        ray: Address of a Ray cluster to work on instead ("local" starts one here with `workers` processes).
        deadline: By `time.monotonic`; no run is started after it.
    """
    if ray is None:
        return work_through(bench.left, do_run, workers=workers, deadline=deadline)
    from coopera.benchmark.cluster import work_on_ray  # noqa: PLC0415 - an optional extra

    return work_on_ray(bench.left, do_run, address=ray, workers=workers, deadline=deadline)


def do_run(job: RunJob) -> None:
    """Do a run, anew where it was stopped, and leave its rows beside it; what is done already stays.

    Raises:
        CooperaError: If the run fails.
    """
    from coopera.studies.study import run_study  # noqa: PLC0415 - heavy

    if _is_done(job):
        return
    if not (job.folder / "run.json").is_file() or RunDir.open(job.folder).state != "finished":
        _clear(job.folder)
        run_study(job.config, resumable=False)
    run = RunDir.open(job.folder)
    hours = run.hours()
    with _activity(job.config) as activity:
        rows = rows_of(hours, run.evenings(), activity, job.labels)
    data = {"rows": [row.model_dump() for row in rows], "seconds": robot_seconds(hours)}
    write_atomic(job.folder / ROWS, canonical_json(data, indent=None))


def _clear(folder: Path) -> None:
    """Remove what was left by a start that was stopped, unless a worker elsewhere, as of Ray, still writes there."""
    if folder.is_dir():
        with claim.lock(folder):
            shutil.rmtree(folder, ignore_errors=True)


def gather(bench: Benchmark) -> tuple[list[Row], Card, dict[str, list[float]]]:
    """The rows of what is done, their card, and the robot's seconds per hour by method.

    Only complete lives count, so all methods are compared on the same days. A life is complete when all methods have
    met it. Before any life is complete, all rows count.
    """
    rows: list[Row] = []
    seconds: dict[str, list[float]] = {}
    begun = {job.life for job in bench.left}
    whole = [job for job in bench.jobs if job.life not in begun] or bench.jobs
    for job in whole:
        if job.after is not None and _is_done(job):
            done = _read_rows(job)
            rows += done.rows
            seconds.setdefault(job.labels["method"], []).extend(done.seconds)
    if not rows:
        raise RunError(f"{bench.root}: no run of this benchmark is finished, so there is nothing to show.")
    models = bench.jobs[0].config.models.model_dump()
    card = Card(
        format=FORMAT,
        coopera=__version__,
        name=bench.root.name,
        offline=any(spec.startswith("offline") for spec in models.values()),
        models=models,
        methods=[name for name in bench.grid.methods if any(row.method == name for row in rows)],
        settings=sorted({row.setting for row in rows}),
        seeds=sorted({row.seed for row in rows}),
        rows=len(rows),
        failed_hours=sum(row.status == "failed" for row in rows),
        sha256=sha256(to_csv(rows)),
        grid=bench.grid.model_dump(mode="json"),
        endpoint=standing(read_statements(bench.root)),
        fingerprints=fingerprints(
            RunDir.open(job.folder) for job in whole if job.after and _is_done(job) and OF not in job.labels["method"]
        ),
        config=bench.jobs[0].config.model_dump(mode="json", exclude=_OF_A_RUN, exclude_defaults=True),
    )
    return rows, card, seconds


class _Done(Frozen):
    """The file rows.json: a row for each hour, and how long the robot took in those that it helped in."""

    rows: list[Row]
    seconds: list[float]


def _read_rows(job: RunJob) -> _Done:
    """Read what a run left for the tables.

    Raises:
        RunError: If it is damaged, or does not hold all of the run's hours.
    """
    path = job.folder / ROWS
    try:
        done = _Done.model_validate(read_json(path))
    except ValidationError as err:
        raise damaged(path, err) from err
    if len(done.rows) != (hours := len(job.config.day_hours) * len(job.config.schedule or [])):
        raise RunError(
            f"{path}: it has {len(done.rows)} rows, where the run has {hours} hours; delete it to redo the run."
        )
    return done


def load_grid(path: Path | None, flags: dict[str, Any]) -> Grid:
    """Read a grid file and lay flags over it; a flag of None was not given.

    Raises:
        ConfigError: Naming the file or the flags, the field and what was expected.
    """
    data = read_yaml(path, "grid file") if path else {}
    given = {name: value for name, value in flags.items() if value is not None}
    if path:
        read_grid(data, str(path))
        data = {**data, "run": in_words_of_today(Config, data.get("run") or {}, f"{path}: run")}
    return _cut(read_grid({**data, **given}, str(path) if path and not given else "the grid"))


def _cut(grid: Grid) -> Grid:
    """Cut a grid to the sizes of COOPERA_AT_MOST."""
    most = at_most()
    methods, stated = grid.methods[: most.methods], grid.endpoint
    left = [name for name in stated.against or [] if name in methods] or None
    return grid.model_copy(
        update={
            "settings": grid.settings[: most.settings],
            "methods": methods,
            "endpoint": stated.model_copy(update={"against": left}) if most.methods else stated,
            "with_shared": [] if most.methods else grid.with_shared,  # controls are methods too many
            "seeds": grid.seeds[: most.seeds] if isinstance(grid.seeds, list) else smaller(grid.seeds, most.seeds),
            **{name: smaller(getattr(grid, name), getattr(most, name)) for name in ("episodes", "days", "hours")},
        }
    )


def shared_config(grid: Grid, file: Path | None, flags: dict[str, Any]) -> Config:
    """What all runs of a grid share: its field `run`, and flags over it."""
    for name in grid.run:
        if name in _OF_THE_GRID:
            raise ConfigError(f"{file or 'run'}: run.{name}: the grid itself decides this.")
    return load_config(None, {**{"pictures": "none"}, **grid.run, **flags})


def _life_config(life: Life, grid: Grid, config: Config) -> Config:
    number: Literal[1, 2, 3, 4] = int(life.setting) if life.setting in ("1", "2", "3", "4") else 1  # type: ignore[assignment]
    return config.model_copy(
        update={"setting": number, "collab": life.collab, "seed": life.seed, "hours": grid.hours, "schedule": life.days}
    )


def _variants(grid: Grid, config: Config) -> list[tuple[Variant, dict[str, Any]]]:
    """Each variant with the settings that make it; none with shared common sense where the robot has no other."""
    apart = config.household != SHARED and config.models.robot.startswith("offline")
    found: list[tuple[Variant, dict[str, Any]]] = []
    for one in grid.variants:
        if one.word != WITH_SHARED:
            again = config.calls.model_copy(update={"sample": config.calls.sample + one.sample})
            found.append((one, {"calls": again}))
        elif apart:
            found.append((one, {"household": SHARED}))
    return found


def _job(life: Life, method: str, folder: Path, lived: Path | None, base: Config, name: str | None = None) -> RunJob:
    config = base.model_copy(update={"method": method, "out": folder, "earlier_life": lived})
    labels = {
        "method": name or method,
        "setting": life.setting,
        "collab": life.collab,
        "seed": life.seed,
        "episode": life.episode,
    }
    return RunJob(f"{life.name}/{name or method}", f"{life.name}/{NOBODY}" if lived else None, folder, config, labels)


def _chosen(field: str, wanted: Sequence[str] | int | None, known: Sequence[str]) -> list[str]:
    if wanted is None:
        return list(known)
    if isinstance(wanted, int):
        if wanted > len(known):
            raise ConfigError(f"{field}: {wanted} are asked for, and there are {len(known)}.")
        return list(known[:wanted])
    return [str(Path(name).expanduser().resolve()) if names_file(name) else name for name in wanted]


def _is_done(job: RunJob) -> bool:
    return (job.folder / ROWS).is_file()


@contextmanager
def _activity(config: Config) -> Iterator[Callable[[str], str]]:
    from coopera.evaluation.activities import nearest_group  # noqa: PLC0415
    from coopera.studies.assemble import open_embeddings  # noqa: PLC0415 - heavy

    with open_embeddings(config) as embeddings:
        yield nearest_group(embeddings)
