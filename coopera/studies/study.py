"""Running a study: a run directory, the services, and the study graph with its checkpoints."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from langchain_core.callbacks import BaseCallbackHandler
from langchain_core.embeddings import Embeddings
from langchain_core.runnables import RunnableConfig
from langgraph.checkpoint.base import BaseCheckpointSaver
from langgraph.checkpoint.memory import InMemorySaver
from langgraph.graph.state import CompiledStateGraph

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.config.prices import check_money, read_prices
from coopera.config.schema import Config, Models
from coopera.core.errors import ConfigError, RunError, WaitingError
from coopera.core.hour import DayPlan
from coopera.core.household import SceneId
from coopera.core.interview import Answer, Question
from coopera.core.people import PersonId
from coopera.core.protocols import Role
from coopera.core.success import Counts
from coopera.evaluation import SETTINGS, episode, pool, schedule
from coopera.graphs import Services, build_study_graph
from coopera.graphs.players.real_person import Interview
from coopera.graphs.players.stated import checked_step
from coopera.graphs.study import Waiting, waiting
from coopera.memory import Search
from coopera.models.given import Chosen, by_role
from coopera.models.households import household_file, household_of
from coopera.models.settings import Budget
from coopera.models.transport import NobodyThereError
from coopera.people.answers import Attended, Sitting
from coopera.people.changes import NONE, changes_file
from coopera.people.real import open_logs
from coopera.prompts import PromptLibrary
from coopera.report.page import write_report
from coopera.rundir import claim, seals
from coopera.rundir.crash import refusals_told
from coopera.rundir.directory import RunDir
from coopera.rundir.private import only_mine
from coopera.rundir.stopping import Stop
from coopera.simulation.homes.scene import load_scene
from coopera.studies.assemble import model_specs, open_services
from coopera.studies.catalogues import find_person, resolve
from coopera.studies.events import Event, Heard, Listener, listened_to
from coopera.studies.heap import clear_up, give_back, lasting, steady_heap
from coopera.studies.own_files import home_files
from coopera.studies.remembered import bring_to_the_trace
from coopera.studies.standing import (
    CHECKPOINTS,
    THREAD,
    give_up,
    give_up_if_wrong,
    open_checkpoints,
    serializer,
    steps_done,
)

QUESTION = "question.json"
"""File of a run that waits for a person: the question (`coopera.core.interview.Question`)."""

_CHANGES = "changes: "


def nobody(question: Question) -> Answer:
    """Answer nothing: the run waits.

    Raises:
        WaitingError: Always.
    """
    raise WaitingError(f"The run waits for {question.name}: day {question.day}, {question.time}.")


def run_study(
    config: Config,
    *,
    on_event: Callable[[Event], None] | None = None,
    ask_person: Interview = nobody,
    stop: Stop | None = None,
    resumable: bool = True,
    callbacks: Sequence[BaseCallbackHandler] = (),
) -> dict[str, Any]:
    """Run a study from its first hour to its report.

    Args:
        config: What to run; what it leaves open is filled in.
        on_event: Told of each node that ends.
        ask_person: Puts a question to a real person, with `played_by` me or web; it may raise `WaitingError`, and
            `resume_study` asks the same question again.
        stop: What else stops the run; a run in the main thread listens to Ctrl-C and `kill` itself.
        resumable: Whether the run keeps its memory and its checkpoints on file, and ends with a report. Without, it
            takes half the time, and is done anew where it does not reach its end.
        callbacks: LangChain's handlers, such as a tracer: told of each graph, node and call of a model; a call has tags
            and metadata with its person, day, hour and node.

    Returns:
        The content of summary.json.

    Raises:
        ConfigError: If the configuration is wrong; nothing is then written.
        CooperaError: If the work fails; `resume_study` goes on from the last whole hour.
    """
    try:
        with new_run(config, stop, resumable) as (run, services):
            return _carry_on(run, services, on_event, ask_person, callbacks)
    finally:
        clear_up()


def resume_study(
    path: Path,
    *,
    on_event: Callable[[Event], None] | None = None,
    ask_person: Interview = nobody,
    budget: Budget | None = None,
    models: Chosen | Mapping[Role, Chosen] | None = None,
    callbacks: Sequence[BaseCallbackHandler] = (),
) -> dict[str, Any]:
    """Go on with a run that was stopped, failed or killed; the result is that of an uninterrupted one.

    A finished run is given what it lacks of its figures and its report, from its trace.

    Args:
        path: The run directory.
        on_event: Told of each node that ends.
        ask_person: As for `run_study`.
        budget: What the run may spend in all, if not what it was begun with.
        models: The chat models that the run was begun with, where these were objects: no file can hold them.
        callbacks: As for `run_study`.

    Raises:
        ConfigError: If such an object is missing, or another one than the run was begun with.
        RunError: If the run is still being written, or its prompts, its household file or its file of
            changes have changed since.
    """
    if (found := RunDir.open(path)).state == "finished":
        with refusals_told(), only_mine(found.config.private):
            return _completed(found)
    with old_run(path, budget, models) as (run, services):
        return _carry_on(run, services, on_event, ask_person, callbacks)


def _with_models(config: Config, models: Chosen | Mapping[Role, Chosen] | None) -> Config:
    """A run's configuration with the objects in it whose specs it has."""
    if models is None:
        return config
    given = Models.model_validate({**config.models.model_dump(), **by_role(models, tuple(Models.model_fields))})
    for role, spec in config.models.model_dump().items():
        if getattr(given, role) != spec:
            raise ConfigError(
                f"models: the {role} of this run was played by {spec}, and can only go on with it, not with "
                f"{getattr(given, role)}."
            )
    return config.model_copy(update={"models": given})


@contextmanager
def new_run(config: Config, stop: Stop | None = None, resumable: bool = True) -> Iterator[tuple[RunDir, Services]]:
    """Start a run directory and open its services, for scripts that drive a graph themselves.

    Raises:
        ConfigError: If the configuration is wrong; nothing is then written.
        ModelCallError: If no server listens where a model should be; a run that has no hour yet is taken back.
    """
    steady_heap()
    config = resolve(config)
    prompts = PromptLibrary(config.prompts)
    people = [find_person(config, person) for person in config.humans or []]
    own = [path for id, path in config.files.scenes.items() if id in (config.scenes or [])]
    homes = {name: text for path in own for name, text in home_files(load_scene(path)).items()}
    logs = open_logs(config, plan_days(config))
    specs = model_specs(config)
    check_money(config.budget, read_prices(config.budget.prices) if config.budget.prices else None, specs.values())
    with ExitStack() as stack:
        stack.enter_context(refusals_told())
        stack.enter_context(only_mine(config.private))
        made = RunDir.create(
            config,
            people=people,
            prompts=prompts.hashes(),
            models={str(role): spec for role, spec in specs.items()},
            knowledge=knowledge_of(specs, config.household, config.changes),
            stop=stop,
            resumable=resumable,
        )
        if config.private:
            made.root.chmod(0o700)  # it may have been there
        run = stack.enter_context(made)
        try:
            run.keep_homes(homes)
            with open_services(config, run, run.people(), prompts, logs) as services:
                yield run, services
        except (ConfigError, NobodyThereError):
            if not run.hours_done():
                run.discard()
            raise


@contextmanager
def old_run(
    path: Path, budget: Budget | None = None, models: Chosen | Mapping[Role, Chosen] | None = None
) -> Iterator[tuple[RunDir, Services]]:
    """Take up a run that has not finished and open its services, for scripts that drive a graph themselves.

    Args:
        path: The run directory.
        budget: What the run may spend in all, if not what it was begun with.
        models: The chat models that the run was begun with, where these were objects.

    Raises:
        ConfigError: If such an object is missing, or another one than the run was begun with.
        RunError: As with `resume_study`.
    """
    found = RunDir.open(path)
    steady_heap()
    check_money(budget or found.config.budget, found.prices, model_specs(found.config).values())
    with refusals_told(), only_mine(found.config.private), RunDir.resume(path, budget) as run:
        run.config = _with_models(run.config, models)
        prompts = PromptLibrary(run.config.prompts)
        changed = sorted(name for name, sha in prompts.hashes().items() if run.info["prompts"].get(name, sha) != sha)
        if changed:
            raise RunError(f"{path}: the prompt {changed[0]} has changed since this run began; restore it to go on.")
        config, before = run.config, run.info.get("knowledge", {})
        if other := knowledge_of(run.info["models"], config.household, config.changes).items() ^ before.items():
            what = "file of changes" if any(by.startswith(_CHANGES) for by, _ in other) else "household file"
            raise RunError(f"{path}: the {what} has changed since this run began; restore it to go on.")
        logs = open_logs(run.config, plan_days(run.config))
        with open_services(run.config, run, run.people(), prompts, logs) as services:
            yield run, services


def knowledge_of(specs: Mapping[Role, str], household: str, changes: str = NONE) -> dict[str, str]:
    """SHA-256 of each household file that is read besides the person's shipped one, and of a file of changes.

    Args:
        specs: Model of each role.
        household: The setting: `own`, `shared` or a file.
        changes: The setting: `none`, `seeded` or a file.

    Returns:
        By the model that names the file, such as "offline:FILE", or by the setting, such as "household: own".

    Raises:
        ConfigError: If one is not there or cannot be read.
    """
    found: dict[str, str] = {}
    for role, spec in specs.items():
        path = household_of(spec, role, household)
        if path is not None:
            by = spec if household_file(spec) else f"household: {household}"
            found[by] = _sha256(path, "household file")
    if (file := changes_file(changes)) is not None:
        found[f"{_CHANGES}{changes}"] = _sha256(file, "file of changes")
    return found


def _sha256(path: Path, what: str) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as err:
        raise ConfigError(f"{path}: the {what} cannot be read ({reason(err)}).") from err


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


def _carry_on(
    run: RunDir,
    services: Services,
    on_event: Callable[[Event], None] | None,
    ask_person: Interview,
    callbacks: Sequence[BaseCallbackHandler],
) -> dict[str, Any]:
    plans = plan_days(run.config)
    with _checkpoints(run, plans, services.embeddings) as saver:
        graph = build_study_graph(saver)
        given: Any = None if graph.get_state(THREAD).values else {"schedule": plans}
        scored = [hour.success.predicate for hour in run.hours() if hour.success]
        asker: object = ask_person
        if isinstance(asker, Attended):
            asker.attend(Sitting(run.root, run.config, partial(_checked, services), run.check))
        if (question := waiting(graph, THREAD)) is None:
            question = _run_on(run, graph, services, given, scored, on_event, callbacks)
        while question is not None:
            given = question.answered(_ask(run, question.question, ask_person))
            question = _run_on(run, graph, services, given, scored, on_event, callbacks)
    summary = run.finish()
    if run.resumable:
        write_report(run)
    return summary


def _completed(run: RunDir) -> dict[str, Any]:
    """Write what a finished run lacks, and remove checkpoints that are damaged.

    It was killed before the end, or its files were lost or altered.
    """
    seals.refuse_broken(run.root)
    claim.sweep(run.root)
    if run.resumable:
        plans = plan_days(run.config)
        give_up_if_wrong(run.root / CHECKPOINTS, plans, steps_done(run, plans))
    odd = {one.file for one in seals.broken(run.root)}
    lost = {name for name in (*seals.FIGURES, seals.REPORT) if name in odd or not (run.root / name).is_file()}
    if seals.is_sealed(run.root) and not seals.sealed_sha(run.root, seals.REPORT):
        lost.add(seals.REPORT)
    summary = run.write_figures() if lost & set(seals.FIGURES) else run.summary()
    if run.resumable and seals.REPORT in lost:
        write_report(run)
    return summary


@contextmanager
def _checkpoints(run: RunDir, plans: Sequence[DayPlan], embeddings: Embeddings) -> Iterator[BaseCheckpointSaver[Any]]:
    """Checkpoints and memories that agree with the trace."""
    if not run.resumable:
        yield InMemorySaver(serde=serializer())
        return
    file = run.root / CHECKPOINTS
    give_up_if_wrong(file, plans, steps_done(run, plans))
    if bring_to_the_trace(run, plans, embeddings):
        give_up(file)
    run.seal_days()
    with open_checkpoints(file) as saver:
        yield saver


def _checked(services: Services, question: Question, step: str) -> str:
    """Check one step of a real person's in the home that they live in."""
    home, search = services.home(SceneId(question.scene)), partial(Search, services.embeddings)
    return checked_step(step, question, home, search, services.human_agent)


def _ask(run: RunDir, question: Question, ask_person: Interview) -> Answer:
    """Put a question to the person; until it is answered it stands in the run's folder, for whoever shows it."""
    waiting = run.root / QUESTION
    write_atomic(waiting, canonical_json(question.model_dump(mode="json")))
    answer = ask_person(question)
    waiting.unlink(missing_ok=True)
    return answer


def _run_on(
    run: RunDir,
    graph: CompiledStateGraph[Any, Services, Any, Any],
    services: Services,
    given: Any,
    scored: list[Counts],
    on_event: Callable[[Event], None] | None,
    callbacks: Sequence[BaseCallbackHandler],
) -> Waiting | None:
    """Let the study go on until its end, or until a question to a real person, which is then returned.

    Where the one who is told of events fails, the work is stopped before its services are closed.
    """

    def work(listener: Listener) -> None:
        thread: RunnableConfig = {**THREAD, "callbacks": [*callbacks, listener]}
        graph.invoke(given, thread, context=services, durability="async")

    def after(heard: Heard) -> None:
        if heard.node == "day":  # between the days, when the work holds least that will be garbage
            give_back()

    now: dict[str, Any] = {"day": 0, "hour": None, "success": pool(scored).f1}
    with lasting(), closing(listened_to(work, after)) as events, run.stopped_by_failure():
        for node, said in events:
            if said is not None:
                now |= {"day": said["day"], "hour": said["hour"]}
                if said["success"]:
                    scored[:] = [pool([*scored, Counts.model_validate(said["success"]["predicate"])])]
                    now["success"] = scored[0].f1
            if on_event is not None:
                on_event({**now, "node": node})
    return waiting(graph, THREAD)
