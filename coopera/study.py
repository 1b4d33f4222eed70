"""Running a study: a run directory, the services, and the study graph with its checkpoints."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, cast

from langchain_core.runnables import RunnableConfig
from langgraph.checkpoint.serde.jsonplus import JsonPlusSerializer
from langgraph.checkpoint.sqlite import SqliteSaver

from coopera import humans
from coopera.assemble import model_specs, open_services
from coopera.catalogues import resolve
from coopera.config import Config
from coopera.report import write_report
from coopera.rundir import RunDir
from core.errors import RunError
from core.hour import Counts, DayPlan
from core.household import SceneId
from core.people import PersonId
from evaluation import SETTINGS, episode, pool, schedule
from graphs import STATE_TYPES, Services, build_study_graph
from models.settings import Budget
from prompts import PromptLibrary

Event = Mapping[str, Any]
"""That a node has ended: `day`, `hour` (None in the evening), `node`, `success` (predicate F1 so far, or None)."""

_THREAD: RunnableConfig = {"configurable": {"thread_id": "study"}}


def run_study(config: Config, *, on_event: Callable[[Event], None] | None = None) -> dict[str, Any]:
    """Run a study from its first hour to its report.

    Args:
        config: What to run; what it leaves open is filled in.
        on_event: Told of each node that ends.

    Returns:
        The content of summary.json.

    Raises:
        ConfigError: If the configuration is wrong; nothing is then written.
        CooperaError: If the work fails; `resume_study` goes on from the last whole hour.
    """
    with new_run(config) as (run, services):
        return _carry_on(run, services, on_event)


def resume_study(
    path: Path, *, on_event: Callable[[Event], None] | None = None, budget: Budget | None = None
) -> dict[str, Any]:
    """Go on with a run that was stopped, failed or killed; the result is that of an uninterrupted one.

    Args:
        path: The run directory.
        on_event: Told of each node that ends.
        budget: What the run may spend in all, if not what it was begun with.

    Raises:
        RunError: If the run is finished or still being written, or its prompts have changed since.
    """
    with RunDir.resume(path, budget) as run:
        prompts = PromptLibrary(run.config.prompts)
        changed = sorted(name for name, sha in prompts.hashes().items() if run.info["prompts"].get(name) != sha)
        if changed:
            raise RunError(f"{path}: the prompt {changed[0]} has changed since this run began; restore it to go on.")
        with open_services(run.config, run, run.people(), prompts) as services:
            return _carry_on(run, services, on_event)


@contextmanager
def new_run(config: Config) -> Iterator[tuple[RunDir, Services]]:
    """Start a run directory and open its services, for scripts that drive a graph themselves.

    Raises:
        ConfigError: If the configuration is wrong; nothing is then written.
    """
    config = resolve(config)
    prompts = PromptLibrary(config.prompts)
    people = [humans.find(person, config.data_dir) for person in config.humans or []]
    specs = {str(role): spec for role, spec in model_specs(config).items()}
    with (
        RunDir.create(config, people=people, prompts=prompts.hashes(), models=specs) as run,
        open_services(config, run, run.people(), prompts) as services,
    ):
        yield run, services


def plan_days(config: Config) -> list[DayPlan]:
    """The days of a resolved configuration, in order."""
    if config.schedule:
        return episode([(PersonId(who), SceneId(where)) for who, where in config.schedule], config.hours, config.collab)
    return schedule(
        SETTINGS[config.setting],
        [PersonId(person) for person in config.humans or []],
        [SceneId(scene) for scene in config.scenes or []],
        days=config.days,
        hours=config.hours,
        collab=config.collab,
    )


def _carry_on(run: RunDir, services: Services, on_event: Callable[[Event], None] | None) -> dict[str, Any]:
    with closing(sqlite3.connect(run.root / "checkpoints.sqlite", check_same_thread=False)) as connection:
        saver = SqliteSaver(connection, serde=JsonPlusSerializer(allowed_msgpack_modules=list(STATE_TYPES)))
        scored = [hour.success.predicate for hour in run.hours() if hour.success]
        _stream(services, saver, plan_days(run.config), scored, on_event)
    summary = run.finish()
    write_report(run)
    return summary


def _stream(
    services: Services,
    saver: SqliteSaver,
    days: list[DayPlan],
    scored: list[Counts],
    on_event: Callable[[Event], None] | None,
) -> None:
    graph = build_study_graph(saver)
    begun = bool(graph.get_state(_THREAD).values)
    stream = graph.stream(
        None if begun else {"schedule": days},
        _THREAD,
        context=services,
        stream_mode=["updates", "custom"],
        subgraphs=True,
        durability="async",
    )
    now: dict[str, Any] = {"day": 0, "hour": None}
    for _, mode, data in cast(Iterator[tuple[Any, str, dict[str, Any]]], stream):
        if mode == "custom":
            now = {"day": data["day"], "hour": data["hour"]}
            if data["success"]:
                scored.append(Counts.model_validate(data["success"]["predicate"]))
        if on_event is not None:
            nodes = [data["node"]] if mode == "custom" else list(data)
            for node in nodes:
                on_event({**now, "node": node, "success": pool(scored).f1})
