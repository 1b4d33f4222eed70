"""What there is to choose from, and a configuration completed and checked against it before anything is written."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import NamedTuple

from coopera.config.at_most import cut, said_by
from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.core.people import Persona
from coopera.graphs.players.person_models import PERSON_MODELS
from coopera.models.classifiers import find_classifier
from coopera.models.classifiers.instruction import read_recipe
from coopera.models.households import chosen_household, household_file
from coopera.models.offline.household.knowledge import ROBOTS, Household, shipped
from coopera.models.offline.household.knowledge import load as load_household
from coopera.people import shipped as humans
from coopera.people.answers import consent_text
from coopera.people.changes import open_changes
from coopera.people.shipped import read_persona
from coopera.rundir.claim import refuse_used
from coopera.simulation.bodies.robot import load_robot
from coopera.simulation.drawing.context import chosen
from coopera.simulation.motions.user_folder import load_motions
from coopera.simulation.sight.video import need_video
from coopera.studies.own_files import by_id


class Catalogues(NamedTuple):
    """Ids that a configuration may name; people and scenes in the order in which a setting takes them.

    `needs` gives, by setting, (people of one episode, scenes of one episode, days of one episode).
    """

    people: list[str]
    scenes: list[str]
    methods: list[str]
    needs: dict[int, tuple[int, int, int]]


def load_catalogues(config: Config) -> Catalogues:
    """Gather what ships with coopera and what stands in the configuration's data folder."""
    # These rooms are slow to import, and `coopera --help` needs none of them.
    from coopera.evaluation import SETTINGS, known_methods  # noqa: PLC0415
    from coopera.simulation.homes.scene import list_scenes  # noqa: PLC0415

    shipped = list_scenes()
    imported = [scene for scene in list_scenes([config.data_dir / "scenes"]) if scene not in shipped]
    return Catalogues(
        people=list(humans.known_ids(config.data_dir)),
        scenes=[*shipped, *imported],
        methods=known_methods(),
        needs={number: (setting.people, setting.scenes, setting.days) for number, setting in SETTINGS.items()},
    )


def resolve(config: Config, catalogues: Catalogues | None = None) -> Config:
    """Fill in what the setting decides and check every name; humans, scenes, days and out are then set.

    Sizes are cut to those of COOPERA_AT_MOST (`coopera.config.at_most`).

    Raises:
        ConfigError: Naming the field, what is wrong and what there is.
    """
    known = catalogues or load_catalogues(config)
    config = _by_schedule(by_id(config))
    n_people, n_scenes, days = known.needs[config.setting]
    _refuse_what_comes_later(config)
    _check("method", "method", [config.method], known.methods)
    _check("person_model", "person model", [config.person_model], list(PERSON_MODELS))
    load_robot(config.robot)
    _refuse_unknowable(config)
    _refuse_online(config)
    _check("humans", "person", config.humans or [], [*known.people, *config.files.humans])
    _check("scenes", "home", config.scenes or [], [*known.scenes, *config.files.scenes])
    people = config.humans or _first("humans", known.people, n_people, config.setting)
    scenes = config.scenes or _first("scenes", known.scenes, n_scenes, config.setting)
    if not config.schedule:
        _groups("humans", people, n_people, config.setting)
        _groups("scenes", scenes, n_scenes, config.setting)
    load_motions(config.motions)
    _knowledge(config)
    consent_text(config)
    if config.out is not None:
        refuse_used(config.out)
    for person in people:
        _livable(find_person(config, person), config.person_model)
    return cut(
        config.model_copy(
            update={
                "humans": list(people),
                "scenes": list(scenes),
                "days": config.days or days,
                "out": config.out or next_folder(Path("runs")),
                "renderer": chosen(config.renderer) if config.takes_pictures else config.renderer,
            }
        )
    )


def find_person(config: Config, person: str) -> Persona:
    """Return somebody who takes part, from a file that was given or from the catalogue.

    Raises:
        ConfigError: If there is nobody of that id, or the file cannot be used.
    """
    given = config.files.humans.get(person)
    return read_persona(given) if given else humans.find(person, config.data_dir)


def tuned_model(config: Config) -> str | None:
    """The language model in this process that the method finetunes itself, if it does."""
    from coopera.evaluation import find_method  # noqa: PLC0415 - slow to import

    robot = config.models.robot
    kind, _, name = robot.partition(":")
    return {"huggingface": name, "smol": robot}.get(kind) if find_method(config.method).tunes else None


def _refuse_online(config: Config) -> None:
    """Refuse a method that finetunes the robot's model where that model is on a server."""
    from coopera.evaluation import find_method  # noqa: PLC0415 - slow to import

    here = config.models.robot.startswith("offline") or tuned_model(config)
    if find_method(config.method).tunes and not here:
        raise ConfigError(
            f"method: {config.method} finetunes the robot's model in this process, which can be offline, smol or "
            f"huggingface:REPO-OR-FOLDER, and the robot model here is {config.models.robot}."
        )


def _refuse_unknowable(config: Config) -> None:
    """Refuse a ceiling where nobody knows the person's true parameters, and a swap where there is nobody else."""
    from coopera.evaluation import find_method  # noqa: PLC0415 - slow to import

    if find_method(config.method).swapped and (config.earlier_life is None or config.schedule):
        raise ConfigError(
            f"method: the robot of {config.method} is told of another person's days, so it needs an earlier_life of at "
            "least two people, each with days of their own."
        )
    if not find_method(config.method).knows:
        return
    if not config.models.human.startswith("offline") or config.played_by != "simulated":
        who = config.models.human if config.played_by == "simulated" else f"played by {config.played_by}"
        raise ConfigError(
            f"method: {config.method} knows the true person, whom only the offline model has; the person here is {who}."
        )


def _by_schedule(config: Config) -> Config:
    """With a schedule, its people, homes and days are the run's."""
    if not config.schedule:
        return config
    said = said_by(config.schedule)
    for field, value in said.items():
        if getattr(config, field) not in (None, value):
            raise ConfigError(f"{field}: the schedule says this already; leave it out.")
    return config.model_copy(update=said)


def _first(field: str, ids: Sequence[str], count: int, setting: int) -> list[str]:
    if len(ids) < count:
        there = f"only {', '.join(ids)} exists" if len(ids) == 1 else f"there are {', '.join(ids) or 'none'}"
        raise ConfigError(f"{field}: setting {setting} needs {count}, and {there}.")
    return list(ids[:count])


def _check(field: str, what: str, wanted: Sequence[str], known: Sequence[str]) -> None:
    for name in wanted:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            shown = ", ".join(known[:12]) + (f" and {len(known) - 12} more" if len(known) > 12 else "")
            hint = f"did you mean {near[0]}? " if near else ""
            raise ConfigError(f"{field}: there is no {what} {name!r} ({hint}known are {shown or 'none'}).")
        if wanted.count(name) > 1:
            raise ConfigError(f"{field}: {name} stands twice, and each may stand once.")


def _livable(persona: Persona, model: str) -> None:
    """Refuse a person who lacks the text that a person model lives by."""
    if not PERSON_MODELS[model].profile(persona):
        raise ConfigError(
            f"humans: {persona.id} has no notes in the persona file, and --person-model {model} lives by them."
        )


def _knowledge(config: Config) -> None:
    """Refuse a household file of one's own, or a file of changes, that is wrong before anything is written."""
    named = [household_file(spec) for spec in sorted(set(config.models.model_dump().values()))]
    for own in (chosen_household(config.household), *named):
        if own is not None and own != ROBOTS and own.is_file():
            load_household(own)
    open_changes(config.changes, config.seed, known_activities(config))


def known_activities(config: Config) -> Collection[str] | None:
    """Activities that a file of changes may name; None where the person's model is no offline model and reads words."""
    if not config.models.human.startswith("offline"):
        return None
    return persons_household(config).index


def persons_household(config: Config) -> Household:
    """The household file that people live by whom the offline model plays."""
    path = household_file(config.models.human)
    return load_household(path) if path else shipped()


def _groups(field: str, ids: Sequence[str], size: int, setting: int) -> None:
    if len(ids) % size:
        a_multiple = f"{size} or a multiple of it" if size > 1 else "at least 1"
        raise ConfigError(f"{field}: setting {setting} takes {a_multiple}, not {len(ids)} ({', '.join(ids)}).")


def next_folder(runs: Path) -> Path:
    """The first of run-001, run-002, … that is not there yet."""
    number = 1
    while (folder := runs / f"run-{number:03d}").exists():
        number += 1
    return folder


def _refuse_what_comes_later(config: Config) -> None:
    """Refuse choices that are named in the design but not built yet."""
    if config.pictures == "video":
        need_video()
    check_recipe = find_classifier(config.classifier).check_recipe
    if config.classifier_config is not None:
        check_recipe = read_recipe if tuned_model(config) else check_recipe
        if check_recipe is None:
            raise ConfigError(f"classifier_config: the classifier {config.classifier} takes no recipe file.")
        check_recipe(config.classifier_config)
    if config.prompts is not None and not config.prompts.is_dir():
        raise ConfigError(f"prompts: {config.prompts} must be a folder of prompt files, and there is no such folder.")
