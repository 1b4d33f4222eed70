"""The configuration of one study: a YAML file, flags that override it, and clear refusals of what is wrong."""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import Field, ValidationError, field_validator, model_validator

from coopera.config.files import read_yaml
from coopera.core.clock import FIRST_HOUR, HOURS_PER_DAY
from coopera.core.errors import ConfigError
from coopera.core.hour import SearchSizes
from coopera.core.household import Collab, PerceptErrors
from coopera.core.people import Frozen
from coopera.models.settings import Budget, CallSettings

MAX_HOURS = 24 - FIRST_HOUR

Text = Annotated[str, Field(min_length=1)]
Ids = Annotated[list[Text], Field(min_length=1)]
Pixels = Annotated[int, Field(strict=True, ge=32, le=2048)]

SMALL, LARGE = (320, 240), (1024, 768)
_EXPECTED = {
    "setting": "1, 2, 3 or 4",
    "collab": "1 or 2",
    "humans": "a list of one or more persona ids",
    "scenes": "a list of one or more scene ids",
    "days": "a whole number from 1 to 366",
    "hours": f"a whole number from 1 to {MAX_HOURS}",
    "method": "the name of a method",
    "seed": "a whole number from 0 up",
    "out": "the path of a folder",
    "models": "a mapping with any of human, robot and judge",
    "models.human": "a model such as offline",
    "models.robot": "a model such as offline",
    "models.judge": "a model such as offline",
    "base_url": "an address such as http://localhost:8000/v1",
    "prompts": "the path of a folder",
    "classifier": "kernel, lora or lora-instruct",
    "classifier_config": "the path of a recipe file",
    "learning": "warm or fresh",
    "who": "known or unknown",
    "traits": "evening or hourly",
    "human": "simulated, me or log:FILE",
    "feedback": "yes_no or graded",
    "person": "full, no_extension or single_shot",
    "search": "a mapping with objects, motions or both",
    "search.objects": "a whole number from 1 to 1000",
    "search.motions": "a whole number from 1 to 1000",
    "motions": "the path of a folder of .npy or .npz clips",
    "robot": "the name of a robot's body such as fetch",
    "pictures": "sampled, none or video",
    "frames": "a whole number from 1 to 64",
    "schedule": "a list of days, each [person, scene]",
    "backbone": "a model such as offline:words",
    "lived": "the path of a finished run without a robot",
    "renderer": "tiny or egl",
    "frame_size": "two whole numbers from 32 to 2048, [width, height]",
    "perception": "a mapping with any of motion_confused, in_hand_missed and joint_noise",
    "perception.motion_confused": "a share from 0 to 1",
    "perception.in_hand_missed": "a share from 0 to 1",
    "perception.joint_noise": "a number of metres from 0 to 1",
    "budget": "a mapping with calls, tokens or both",
    "budget.calls": "a whole number from 1 up",
    "budget.tokens": "a whole number from 1 up",
    "cache": "the path of a file",
    "calls": "a mapping of settings such as timeout, retries and max_tokens",
    "calls.timeout": "a number of seconds above 0",
    "calls.retries": "a whole number from 0 to 20",
    "calls.backoff": "a number of seconds above 0",
    "calls.max_pause": "a number of seconds above 0",
    "calls.per_minute": "a whole number of requests from 1 up",
    "calls.at_once": "a whole number from 1 to 1024",
    "calls.attempts": "a whole number from 1 to 10",
    "calls.max_tokens": "a whole number from 64 up",
    "calls.structure": "auto, json_schema, tools, json_object or text",
    "calls.device": "auto, cpu, mps, cuda or cuda:N",
    "calls.dtype": "auto, float32, bfloat16 or float16",
    "calls.batch": "a whole number from 1 to 256",
    "data_dir": "the path of a folder",
}


class Models(Frozen):
    """Which language model plays which role."""

    human: Text = "offline"
    robot: Text = "offline"
    judge: Text = "offline"


def default_data_dir() -> Path:
    """Where imported people and homes live: COOPERA_DATA_DIR, else the user's own data folder."""
    given = os.environ.get("COOPERA_DATA_DIR")
    if given:
        return Path(given).expanduser()
    base = os.environ.get("XDG_DATA_HOME")
    return (Path(base) if base else Path.home() / ".local" / "share") / "coopera"


class Config(Frozen):
    """What to run. `None` means "as the setting has it"; `coopera.studies.catalogues.resolve` fills that in.

    Attributes:
        setting: One of the paper's four settings (PAPER §4.1).
        collab: Collaboration type, 1 (watch and help) or 2 (free-form).
        humans: Persona ids in the order in which they take part.
        scenes: Scene ids in the order in which they are lived in.
        days: Days of each episode.
        hours: Hours of each day, the first at 9 am (PAPER §3.2: 13).
        method: Name in `evaluation.METHODS`.
        seed: Every random draw derives from it.
        out: The run directory; None takes the next free runs/run-NNN.
        models: Language model of each role.
        base_url: Address of an OpenAI-compatible server, where a model needs one.
        prompts: A folder whose files replace shipped prompts of the same name.
        classifier: Kind of the robot's yes/no classifiers.
        classifier_config: Recipe of `lora-instruct`, by default the paper's (models/classifiers/lora_instruct.yaml).
        learning: Whether an evening goes on from the one before, with the day's examples and a fixed number of earlier
            ones ("warm"), or starts anew on all of them, as the authors' code does ("fresh").
        who: Whether the robot is told whom it is with; "unknown" tells it on the first day with somebody, and has it
            guess from behaviour on later days.
        traits: When the robot infers the person's traits: in the evening from the account, or each hour too, from its
            own guesses of the day so far.
        human: Who plays the person: the simulation, a real person's log (`coopera.people.real`), or a real person who
            is asked, on the terminal or wherever `run_study` is told to ask.
        feedback: What the person answers in the evening: yes or no (the paper's way), or a grade from 1 to 5.
        person: How a simulated person is made: the paper's way or one of its ablations (`coopera.graphs.person`).
        search: How many objects and motions the person is offered for an intention, at most.
        motions: A folder of Motion-X or AMASS clips that the person can do beside the shipped motions.
        robot: The robot's body, one of `coopera.simulation.bodies.robot.ROBOTS`.
        pictures: Whether the first task of each hour is recorded as pictures.
        frames: Pictures per view and hour.
        frame_size: Width and height of a picture in pixels; 1024x768 where the robot's model is not the offline one.
        renderer: What draws the pictures.
        perception: The errors of the percept, for a robot whose model does not look at pictures.
        calls: How models are called (`coopera.models.settings.CallSettings`).
        schedule: The days of one episode, each a person and a home, in place of the setting's own order.
        backbone: The robot's language model in methods that are there to try another one.
        lived: A finished run without a robot, whose days the people live again.
        budget: What the run may spend on models before it stops, to be resumed with more.
        cache: File of replies, shared by runs; None takes the one in the data folder. A rerun then costs nothing, and
            other methods meet the person's days for nothing. Each run keeps its own replies besides.
        data_dir: Folder of imported people and homes.
    """

    setting: Literal[1, 2, 3, 4] = 1
    collab: Collab = 2
    humans: Ids | None = None
    scenes: Ids | None = None
    days: Annotated[int, Field(strict=True, ge=1, le=366)] | None = None
    hours: Annotated[int, Field(strict=True, ge=1, le=MAX_HOURS)] = HOURS_PER_DAY
    method: Text = "ours"
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] = 0
    out: Path | None = None
    models: Models = Models()
    base_url: Annotated[str, Field(pattern=r"^https?://\S+$")] | None = None
    prompts: Path | None = None
    classifier: Literal["kernel", "lora", "lora-instruct"] = "kernel"
    classifier_config: Path | None = None
    learning: Literal["warm", "fresh"] = "warm"
    who: Literal["known", "unknown"] = "known"
    traits: Literal["evening", "hourly"] = "evening"
    human: Annotated[str, Field(pattern=r"^(simulated|me|log:.+)$")] = "simulated"
    feedback: Literal["yes_no", "graded"] = "yes_no"
    person: Text = "full"
    search: SearchSizes = SearchSizes()
    motions: Path | None = None
    robot: Text = "fetch"
    pictures: Literal["sampled", "none", "video"] = "sampled"
    frames: Annotated[int, Field(strict=True, ge=1, le=64)] = 8
    frame_size: tuple[Pixels, Pixels] = SMALL
    renderer: Literal["tiny", "egl"] = "tiny"
    perception: PerceptErrors = PerceptErrors()
    calls: CallSettings = CallSettings()
    schedule: Annotated[list[tuple[Text, Text]], Field(min_length=1, max_length=366)] | None = None
    backbone: Text = "offline:words"
    lived: Path | None = None
    budget: Budget = Budget()
    cache: Path | None = None
    data_dir: Path = Field(default_factory=default_data_dir)

    @model_validator(mode="before")
    @classmethod
    def _pictures_fit_the_eye(cls, data: Any) -> Any:
        """A robot whose model looks at pictures gets large ones (PAPER App. A: 1024x768), if nothing else is asked."""
        if isinstance(data, dict) and data.get("frame_size") is None:
            models = data.get("models")
            robot = models.get("robot") if isinstance(models, dict) else getattr(models, "robot", None)
            return {**data, "frame_size": SMALL if (robot or "offline").startswith("offline") else LARGE}
        return data

    @field_validator("setting", "collab", mode="before")
    @classmethod
    def _is_no_switch(cls, value: Any) -> Any:
        if isinstance(value, bool):  # YAML's yes and true would pass for 1
            raise ValueError
        return value

    @property
    def day_hours(self) -> list[int]:
        """The hours of each day, such as [9, 10, …, 21]."""
        return list(range(FIRST_HOUR, FIRST_HOUR + self.hours))

    def to_yaml(self) -> str:
        """The configuration as YAML, in the order of the fields.

        `out` is left out: a rerun of the file goes to a folder of its own.
        """
        data = self.model_dump(mode="json", exclude={"out"})
        return yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=120)


_SECTIONS: dict[str, type[Frozen]] = {
    "models": Models,
    "perception": PerceptErrors,
    "calls": CallSettings,
    "budget": Budget,
    "search": SearchSizes,
}


def load_config(path: Path | None = None, flags: Mapping[str, Any] | None = None) -> Config:
    """Read a study file and lay flags over it; a flag of None was not given.

    Flags are named as the fields are; of `models`, `calls`, `budget` and `search`, mappings of what was given.

    Raises:
        ConfigError: Naming the file or flag, the field and what was expected.
    """
    data = read_yaml(path, "study file") if path else {}
    given = {name: value for name, value in (flags or {}).items() if value is not None}
    merged = {**data, **given}
    for section in _SECTIONS:
        if isinstance(data.get(section), dict) and section in given:
            merged[section] = {**data[section], **given[section]}
    try:
        return Config.model_validate(merged)
    except ValidationError as err:
        raise ConfigError(_sentence(err, str(path), given)) from None


def _sentence(err: ValidationError, file: str, flags: Mapping[str, Any]) -> str:
    """Turn the first of pydantic's complaints into one sentence."""
    first = err.errors(include_url=False)[0]
    names = [part for part in first["loc"] if isinstance(part, str)]
    known = [".".join(names[:size]) for size in range(len(names), 0, -1)]
    field = next((name for name in known if name in _EXPECTED), ".".join(names))
    if first["type"] == "extra_forbidden":
        name = str(first["loc"][-1])
        fields = (_SECTIONS[names[0]] if len(names) > 1 else Config).model_fields
        near = difflib.get_close_matches(name, fields, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(fields)}"
        return f"{file}: there is no field {name!r} ({hint})."
    where = _flag(names, flags) or f"{file}: {field}"
    return f"{where} must be {_EXPECTED.get(field, 'otherwise')}, not {first['input']!r}."


def _flag(names: list[str], flags: Mapping[str, Any]) -> str | None:
    """The flag that a wrong value came from, or None where it came from the file."""
    if names[0] == "models" and len(names) > 1:
        roles = flags.get("models", {})
        one_for_all = len(roles) == len(Models.model_fields) and len(set(roles.values())) == 1
        return None if names[1] not in roles else "--model" if one_for_all else f"--{names[1]}-model"
    if names[0] in ("budget", "search") and len(names) > 1:
        return f"--{names[0]}-{names[1]}" if names[1] in flags.get(names[0], {}) else None
    return f"--{names[0].replace('_', '-')}" if names[0] in flags else None
