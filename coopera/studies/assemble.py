"""The rooms wired together: from a configuration to the services that the graphs work with."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from langchain_core.embeddings import Embeddings

from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.core.hour import CandidateKind, ModelCall
from coopera.core.household import SceneId
from coopera.core.lazy import made_once
from coopera.core.people import Persona
from coopera.core.protocols import Ask, Classifier, Home, Reply, Role
from coopera.core.randomness import Address
from coopera.evaluation import Measure, find_method
from coopera.graphs import Method, Services
from coopera.graphs.earlier_life import EarlierLife
from coopera.graphs.life import LivedNow
from coopera.graphs.players.answering import Answering
from coopera.graphs.players.living import Living
from coopera.graphs.players.person_models import PERSON_MODELS
from coopera.graphs.players.player import Player
from coopera.graphs.players.simulated import Simulated
from coopera.graphs.players.stated import Interviewed, Logged, Logs
from coopera.graphs.robots.learning import KINDS, Learner
from coopera.graphs.robots.own_robot import MakeRobot, OwnRobot
from coopera.memory import CachedEmbeddings, MemoryStream, Search, bundled
from coopera.memory.ram import RamClient
from coopera.models.budget import Meter
from coopera.models.classifiers import Inputs, make_classifier
from coopera.models.classifiers.instruction import Instruct
from coopera.models.door import open_door
from coopera.people.changes import open_changes
from coopera.prompts import PromptLibrary
from coopera.rundir.directory import RunDir
from coopera.rundir.earlier_life import open_earlier_life
from coopera.simulation import Scene, World, load_scene
from coopera.simulation.motions.library import Library, Rank
from coopera.simulation.motions.user_folder import load_motions
from coopera.simulation.sight.studio import ready
from coopera.studies.catalogues import known_activities, persons_household, tuned_model


def model_specs(config: Config) -> dict[Role, str]:
    """Which model plays which role."""
    robot = config.backbone if find_method(config.method).other_backbone else config.models.robot
    return {"human": config.models.human, "robot": robot, "judge": config.models.judge}


def open_embeddings(config: Config) -> CachedEmbeddings:
    """The bundled sentence encoder, with a cache that all runs share; those of one process have it in RAM, too.

    To be used in a `with` statement: whoever has opened it closes the file.

    Raises:
        ConfigError: If the data folder cannot be made or written.
    """
    folder = config.data_dir.resolve()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as err:
        raise ConfigError(
            f"{folder}: the data folder cannot be written ({err.strerror}); name another one (data_dir of a study, or "
            "COOPERA_DATA_DIR in the environment)."
        ) from err
    return _embeddings(folder / "embeddings.sqlite")


@made_once(2)
def _embeddings(cache: Path) -> CachedEmbeddings:
    return bundled(cache)


@contextmanager
def open_ask(
    config: Config,
    *,
    prompts: PromptLibrary | None = None,
    embeddings: Embeddings | None = None,
    root: Path | None = None,
    check: Callable[[], None] = lambda: None,
    meter: Meter | None = None,
) -> Iterator[Ask]:
    """Open the one door to the configured language models, and close its files at the end.

    Args:
        config: Says which models.
        prompts: The prompt folder, where it has been read already.
        embeddings: The sentence encoder, where it has been opened already.
        root: The run directory: pictures are named relative to it, and replies are cached in it.
        meter: Counts what is spent.
        check: Raises if the run was asked to stop; called while a server is waited for.

    Raises:
        PromptError: If a prompt file is broken, naming file and line.
        ConfigError: If a model is unknown or cannot be used here.
    """
    with ExitStack() as stack:
        door = open_door(
            prompts=prompts or PromptLibrary(config.prompts),
            # a model that is finetuned is held by the robot itself, and twice would be once too often
            model={**model_specs(config), **({"robot": "offline"} if tuned_model(config) else {})},
            seed=config.seed,
            embeddings=embeddings or stack.enter_context(open_embeddings(config)),
            base_url=config.base_url,
            cache=root / "llm_cache.sqlite" if root else None,
            shared=_shared_cache(config) if root else None,
            meter=meter,
            settings=config.calls,
            check=check,
            root=root,
            household=config.household,
        )
        yield stack.enter_context(closing(door))


def _shared_cache(config: Config) -> Path | None:
    """Where replies are kept that runs share; a private run has only one that it was told of."""
    return config.cache or (None if config.private else config.data_dir / "llm_cache.sqlite")


@contextmanager
def open_services(
    config: Config,
    run: RunDir,
    people: Mapping[str, Persona],
    prompts: PromptLibrary | None = None,
    logs: Logs | None = None,
) -> Iterator[Services]:
    """Open everything that a run works with, and close it at the end.

    Args:
        config: Resolved by `coopera.studies.catalogues.resolve`.
        run: The run directory, which may be asked to stop.
        people: Those who may take part, by id.
        prompts: The prompt folder, where it has been read already.
        logs: What a real person wrote down of the hours.
    """
    with ExitStack() as stack:
        embeddings = stack.enter_context(open_embeddings(config))
        priced = (run.prices.money, run.prices.currency) if run.prices else ()
        meter = Meter(config.budget, run.spent(), *priced)
        stack.callback(lambda: run.note_spent(meter.spent))
        prompts = prompts or PromptLibrary(config.prompts)
        door = open_ask(config, prompts=prompts, embeddings=embeddings, root=run.root, check=run.check, meter=meter)
        ask = _Interruptible(stack.enter_context(door), run.check)
        method = find_method(config.method)
        frames = config.frames if config.takes_pictures else 0
        if frames and not ask.sees("robot"):
            stack.enter_context(ready(config.renderer, people.values()))
        days = open_earlier_life(config)
        services = Services(
            ask=ask,
            method=method,
            people={persona.id: persona for persona in people.values()},
            home=_Homes(stack, config, embeddings, run.root),
            stream=_Streams(stack, run.root / "memory" if run.resumable else RamClient(), embeddings),
            embeddings=embeddings,
            learner=_learner(config, run, embeddings, prompts),
            identity_known=config.identity == "known",
            hourly_traits=config.traits == "hourly",
            own=_own_pupil(config, run, people, embeddings),
            recorder=run,
            score=Measure(ask, embeddings),
            seed=config.seed,
            frames=frames,
            help_frames=config.help_frames,
            video=config.pictures == "video",
            person=PERSON_MODELS[config.person_model],
            living=open_living(config),
            answering=_answering(config),
            sizes=config.search,
            player=_player(config, logs),
            life=EarlierLife(days) if days else LivedNow(),
            stranger=days.stranger if days and method.swapped else None,
        )
        with run.settling():  # before its homes are closed
            yield services


def open_pupil(
    config: Config, run: RunDir, people: Mapping[str, Persona], embeddings: Embeddings
) -> Learner | OwnRobot:
    """Who learns in a run's evenings, with its files in `run`."""
    own = _own_pupil(config, run, people, embeddings)
    return own or _learner(config, run, embeddings, PromptLibrary(config.prompts))


def _learner(config: Config, run: RunDir, embeddings: Embeddings, prompts: PromptLibrary) -> Learner:
    method = find_method(config.method)
    return Learner(
        {kind: _classifier(config, method, kind, embeddings, prompts.instruct) for kind in KINDS},
        run,
        config.seed,
        config.learning,
        dict(zip(KINDS, method.replay, strict=True)),
        turns=method.turns,
    )


def _own_pupil(config: Config, run: RunDir, people: Mapping[str, Persona], embeddings: Embeddings) -> OwnRobot | None:
    make = _own_robot(config, find_method(config.method), people, embeddings)
    return OwnRobot(make, run, config.seed) if make else None


def open_living(config: Config) -> Living:
    """How people live.

    Raises:
        ConfigError: If the file of changes is wrong.
    """
    return Living(
        lasting=config.intentions == "lasting",
        absence=config.absence == "named",
        remembers_days=config.person_memory == "days",
        changes=open_changes(config.changes, config.seed, known_activities(config)),
    )


def _answering(config: Config) -> Answering:
    """How simulated people answer; what a real person says is taken as it is."""
    if config.attended:
        return Answering()
    return Answering(rate=config.feedback_rate, noise=config.feedback_noise)


def _player(config: Config, logs: Logs | None) -> Player:
    """Who plays the people: those who wrote logs, somebody who is asked, or a language model."""
    graded = config.feedback == "graded"
    if logs:
        return Logged(logs, Simulated(graded))
    return Interviewed(graded, config.real_person.questions) if config.attended else Simulated(graded)


def _own_robot(
    config: Config, method: Method, people: Mapping[str, Persona], embeddings: Embeddings
) -> MakeRobot | None:
    """What takes the place of our graph, if anything does."""
    if method.knows:
        known = {one.id: one for one in people.values()}
        texts = {name: PERSON_MODELS[config.person_model].profile(one) for name, one in known.items()}
        return partial(method.knows, texts, known, persons_household(config), embeddings)
    if method.tunes and (model := tuned_model(config)):
        return partial(method.tunes, model, config.classifier_config)
    return method.own


def open_home(config: Config, scene: SceneId, embeddings: Embeddings, run: Path) -> World:
    """Open one of a run's homes as it was built, the run's own copy if it has one; it is to be closed after use."""
    return open_world(config, open_layout(config, scene, run), embeddings)


def open_world(config: Config, layout: Scene, embeddings: Embeddings) -> World:
    """A home, given as data, as the configuration says; it is to be closed after use."""
    motions = load_motions(config.motions)
    match = _nearest_motions(embeddings, motions)
    return World(
        layout,
        robot=config.robot,
        frame_size=config.frame_size,
        labels=config.labels,
        renderer=config.renderer,
        motions=motions,
        match=match,
        errors=config.perception,
    )


def open_layout(config: Config, scene: SceneId, run: Path) -> Scene:
    """One of a run's homes as data, the run's own copy if it has one."""
    return load_scene(scene, [config.data_dir / "scenes", run / "scenes"])


class _Interruptible:
    """The one door, shut once the run is asked to stop, so that a slow model does not hold it up for an hour."""

    def __init__(self, ask: Ask, check: Callable[[], None]) -> None:
        self._ask, self._check = ask, check

    def __call__(self, prompt: str, reply: type[Reply], /, **given: Any) -> Reply:
        self._check()
        return self._ask(prompt, reply, **given)

    def sees(self, role: Role) -> bool:
        return self._ask.sees(role)

    def instant(self, role: Role) -> bool:
        return self._ask.instant(role)

    def take_calls(self, at: Address | None = None) -> list[ModelCall]:
        return self._ask.take_calls(at)


class _Homes:
    """Opens a home at its first use and keeps it open."""

    def __init__(self, stack: ExitStack, config: Config, embeddings: Embeddings, run: Path) -> None:
        self._stack, self._config, self._embeddings, self._run = stack, config, embeddings, run
        self._open: dict[SceneId, Home] = {}

    def __call__(self, scene: SceneId) -> Home:
        if scene not in self._open:
            self._open[scene] = self._stack.enter_context(open_home(self._config, scene, self._embeddings, self._run))
        return self._open[scene]


class _Streams:
    """Opens a memory stream at its first use and keeps it open."""

    def __init__(self, stack: ExitStack, store: Path | RamClient, embeddings: Embeddings) -> None:
        self._stack, self._store, self._embeddings = stack, store, embeddings
        self._open: dict[str, MemoryStream] = {}

    def __call__(self, name: str) -> MemoryStream:
        if name not in self._open:
            stream = MemoryStream.open(self._store, name, self._embeddings, durable=False)  # the trace has it all
            self._open[name] = self._stack.enter_context(stream)
        return self._open[name]


def _classifier(
    config: Config, method: Method, kind: CandidateKind, embeddings: Embeddings, instruct: Instruct
) -> Callable[[], Classifier]:
    if method.judge is not None:
        return partial(method.judge, kind)
    time_only = method.time_only
    inputs = Inputs(
        traits=method.traits and not time_only,
        context=method.context and not time_only,
        rank=method.order and not time_only,
    )
    return partial(
        make_classifier,
        config.classifier,
        kind=kind,
        embeddings=embeddings,
        inputs=inputs,
        recipe=config.classifier_config,
        instruct=instruct,
    )


def _nearest_motions(embeddings: Embeddings, motions: Library) -> Rank:
    """Ranks the captions of the library by how similar they are to a free-form text."""
    search = Search(embeddings, motions.captions)
    return lambda text: search.top(text, len(motions.captions))
