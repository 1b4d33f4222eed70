"""The configuration of one study: a YAML file, flags that override it, and clear refusals of what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import Field, ValidationError, field_validator, model_validator

from coopera.config.complaints import complaint
from coopera.config.declared import declared, in_words_of_today
from coopera.config.files import read_yaml
from coopera.config.sections import Files as Files
from coopera.config.sections import FrameSize, HelpFrames, KeptAdapters, Labels, PlayedBy, Private, RealPerson, Text
from coopera.config.sections import Models as Models
from coopera.core.clock import FIRST_HOUR, HOURS_PER_DAY
from coopera.core.errors import ConfigError
from coopera.core.hour import SearchSizes
from coopera.core.household import Collab, PerceptErrors
from coopera.core.people import Frozen
from coopera.core.setting import Setting
from coopera.core.setting import default_data_dir as default_data_dir
from coopera.graphs.players.person_models import PERSON_MODELS
from coopera.models.given import by_role
from coopera.models.settings import ADDRESS, AN_ADDRESS, OWN, SHARED, Budget, CallSettings

MAX_HOURS = 24 - FIRST_HOUR
Ids = Annotated[list[Text], Field(min_length=1)]
SMALL, LARGE = (320, 240), (1024, 768)


class Config(Frozen):
    """What to run. `None` means "as the setting has it"; `coopera.studies.catalogues.resolve` fills that in.

    A setting is declared here and nowhere else; errors, flag, help and docs/reference/settings.md follow from it.
    """

    setting: Annotated[
        Literal[1, 2, 3, 4], Setting("One of the paper's four settings (PAPER §4.1).", flag="--setting")
    ] = 1
    collab: Annotated[Collab, Setting("Collaboration type: 1 watch and help, 2 free-form.", flag="--collab")] = 2
    humans: Annotated[
        Ids | None,
        Setting(
            "People, by id or as files, in the order in which they take part.",
            "a list of one or more persona ids",
            flag="--humans",
            metavar="ID-or-FILE,…",
            unset="as many as the setting takes",
            listed="people",
        ),
    ] = None
    scenes: Annotated[
        Ids | None,
        Setting(
            "Homes, by id or as files, in the order in which they are lived in.",
            "a list of one or more scene ids",
            flag="--scenes",
            metavar="ID-or-FILE,…",
            unset="as many as the setting takes",
            listed="homes",
        ),
    ] = None
    days: Annotated[
        Annotated[int, Field(strict=True, ge=1, le=366)] | None,
        Setting("Days of each episode.", flag="--days", unset="as the setting has it"),
    ] = None
    hours: Annotated[
        int,
        Field(strict=True, ge=1, le=MAX_HOURS),
        Setting("Hours of each day, the first at 9 am (PAPER §3.2: 13).", flag="--hours"),
    ] = HOURS_PER_DAY
    method: Annotated[
        Text,
        Setting("The robot's method.", "the name of a method", flag="--method", metavar="NAME", listed="methods"),
    ] = "ours"
    seed: Annotated[
        int,
        Field(strict=True, ge=0, lt=2**63),
        Setting("Every random draw derives from it.", flag="--seed"),
    ] = 0
    out: Annotated[
        Path | None, Setting("The run directory.", flag="--out", metavar="DIR", unset="the next free runs/run-NNN")
    ] = None
    private: Private = False
    models: Annotated[
        Models,
        Setting("Language model of every role.", flag="--model", metavar="SPEC", unset="offline", listed="models"),
    ] = Models()
    household: Annotated[
        Text,
        Setting(
            "What a robot and a judge played by the offline model know of life at home: what the robot's own household "
            "file says (own), the one that the person lives by (shared), or a file of yours.",
            "own, shared or the path of a household file",
            flag="--household",
            metavar="own|shared|FILE",
        ),
    ] = OWN
    base_url: Annotated[
        Annotated[str, Field(pattern=ADDRESS)] | None,
        Setting(
            "Address of an OpenAI-compatible server, where a model needs one.",
            AN_ADDRESS,
            flag="--base-url",
            metavar="URL",
            unset="the provider's own",
        ),
    ] = None
    prompts: Annotated[
        Path | None,
        Setting(
            "Prompt files that replace the shipped ones of the same name.",
            flag="--prompts",
            metavar="DIR",
            unset="the shipped ones",
        ),
    ] = None
    classifier: Annotated[
        Text,
        Setting(
            "The robot's yes/no classifiers.",
            "the name of a classifier",
            flag="--classifier",
            metavar="NAME",
            listed="classifiers",
        ),
    ] = "kernel"
    classifier_config: Annotated[
        Path | None,
        Setting(
            "Recipe of a classifier that takes one, such as another base of lora-instruct.",
            "the path of a recipe file",
            flag="--classifier-config",
            metavar="FILE",
            unset="the paper's",
        ),
    ] = None
    learning: Annotated[
        Literal["warm", "fresh"],
        Setting(
            "Whether an evening goes on from the one before, with the day's examples and a fixed number of earlier "
            "ones (warm), or starts anew on all of them, as the authors' code does (fresh).",
            flag="--learning",
        ),
    ] = "warm"
    keep_adapters: KeptAdapters = "all"
    identity: Annotated[
        Literal["known", "unknown"],
        Setting(
            "Whether the robot is told whom it is with, or only on the first day with somebody, to guess from "
            "behaviour on later days (unknown).",
            flag="--identity",
            formerly="who",
        ),
    ] = "known"
    traits: Annotated[
        Literal["evening", "hourly"],
        Setting(
            "When the robot works out the person's traits: in the evening, from what it was told, or each hour too, "
            "from its own guesses of the day so far.",
            flag="--traits",
        ),
    ] = "evening"
    played_by: PlayedBy = "simulated"
    real_person: Annotated[RealPerson, Setting("How a real person is asked who plays the person.")] = RealPerson()
    feedback: Annotated[
        Literal["yes_no", "graded"],
        Setting(
            "What the person answers in the evening: yes or no (the paper's way), or a grade from 1 to 5.",
            flag="--feedback",
        ),
    ] = "yes_no"
    feedback_rate: Annotated[
        Annotated[float, Field(ge=0, le=1)],
        Setting("Chance that a question of the evening is answered.", "a number from 0 to 1", flag="--feedback-rate"),
    ] = 1.0
    feedback_noise: Annotated[
        Annotated[float, Field(ge=0, le=0.5)],
        Setting(
            "Chance that an answer of the evening is the opposite of what the person meant.",
            "a number from 0 to 0.5",
            flag="--feedback-noise",
        ),
    ] = 0.0
    person_model: Annotated[
        Text,
        Setting(
            "How a simulated person is made: the paper's way, or one of its ablations.",
            flag="--person-model",
            formerly="person",
            values=tuple(PERSON_MODELS),
        ),
    ] = "full"
    intentions: Annotated[
        Literal["lasting", "hourly"],
        Setting(
            "Whether an intention may go on for hours, with other tasks, or each hour has one of its own that does not "
            "come twice running, as the paper has it (hourly).",
            flag="--intentions",
        ),
    ] = "lasting"
    absence: Annotated[
        Literal["none", "named"],
        Setting(
            "Whether people are away from home at times, at work, school or in town; those hours are named, and have "
            "neither tasks nor a robot (the paper has none).",
            flag="--absence",
        ),
    ] = "none"
    person_memory: Annotated[
        Literal["today", "days"],
        Setting(
            "What the person knows of what they did: today's alone, as the paper has it, or in one line that of "
            "earlier days too (days); the offline person does not read that line.",
            flag="--person-memory",
        ),
    ] = "today"
    changes: Annotated[
        Text,
        Setting(
            "What becomes different in people's lives, such as moods, illness or a new hobby: nothing (as in the "
            "paper), drawn by the seed, or what a file says.",
            "none, seeded or the path of a YAML file",
            flag="--changes",
            metavar="none|seeded|FILE",
        ),
    ] = "none"
    search: Annotated[SearchSizes, Setting("How much the person is offered for an intention, at most.")] = SearchSizes()
    motions: Annotated[
        Path | None,
        Setting(
            "Motion-X (.npy) or AMASS (.npz) clips that the person can do beside the shipped motions.",
            "the path of a folder of .npy or .npz clips",
            flag="--motions",
            metavar="DIR",
            unset="the shipped motions alone",
        ),
    ] = None
    robot: Annotated[
        Text,
        Setting(
            "The robot's body.",
            "a robot's body: a name such as fetch, or the path of its YAML file",
            flag="--robot",
            metavar="NAME|FILE",
            listed="robots",
        ),
    ] = "fetch"
    pictures: Annotated[
        Literal["sampled", "none", "video"],
        Setting("How the first task of each hour is recorded.", flag="--pictures"),
    ] = "sampled"
    frames: Annotated[
        int, Field(strict=True, ge=1, le=64), Setting("Pictures per view and hour, of different moments.")
    ] = 4
    help_frames: HelpFrames = 1
    labels: Labels = False
    frame_size: FrameSize = SMALL
    renderer: Annotated[
        Literal["auto", "gl", "tiny", "egl"],
        Setting("What draws the pictures; auto is gl where OpenGL is to be had, else tiny.", flag="--renderer"),
    ] = "auto"
    perception: Annotated[
        PerceptErrors,
        Setting("How the perception errs by which a robot is told of the person whose model sees no pictures."),
    ] = PerceptErrors()
    calls: Annotated[CallSettings, Setting("How models are called.")] = CallSettings()
    schedule: Annotated[
        Annotated[list[tuple[Text, Text]], Field(min_length=1, max_length=366)] | None,
        Setting(
            "The days of one episode, each a person and a home, in place of the setting's own order.",
            "a list of days, each [person, scene]",
            unset="the setting's own",
        ),
    ] = None
    backbone: Annotated[
        Text,
        Setting(
            "The robot's language model in methods that are there to try another one.",
            "a model such as offline:words",
        ),
    ] = "offline:words"
    earlier_life: Annotated[
        Path | None,
        Setting(
            "A finished run of --method none, whose days the people live again.",
            "the path of a finished run without a robot",
            flag="--earlier-life",
            formerly="lived",
            metavar="RUN",
            unset="the days are lived now",
        ),
    ] = None
    budget: Annotated[Budget, Setting("What the run may spend on models before it stops, to be resumed with more.")] = (
        Budget()
    )
    cache: Annotated[
        Path | None,
        Setting(
            "File of replies that runs share, so that a rerun costs nothing; each run keeps its own replies besides.",
            metavar="FILE",
            unset="llm_cache.sqlite in the data folder",
        ),
    ] = None
    files: Annotated[
        Files, Setting("People and homes given as files; filled in from paths in humans, scenes and schedule.")
    ] = Files()
    data_dir: Annotated[
        Path,
        Setting(
            "Folder of imported people and homes.",
            metavar="DIR",
            unset="COOPERA_DATA_DIR, or the user's own data folder",
        ),
    ] = Field(default_factory=default_data_dir)

    @model_validator(mode="before")
    @classmethod
    def _in_words_of_today(cls, data: Any) -> Any:
        return in_words_of_today(cls, data, "Config") if isinstance(data, dict) else data

    @model_validator(mode="before")
    @classmethod
    def _pictures_fit_the_eye(cls, data: Any) -> Any:
        """A robot whose model looks at pictures gets large ones (PAPER App. A: 1024x768), if nothing else is asked."""
        if isinstance(data, dict) and data.get("frame_size") is None:
            models = by_role(data.get("models"), tuple(Models.model_fields))
            robot = models.get("robot") if isinstance(models, dict) else getattr(models, "robot", None)
            return {**data, "frame_size": SMALL if str(robot or "offline").startswith("offline") else LARGE}
        return data

    @field_validator("setting", "collab", mode="before")
    @classmethod
    def _is_no_switch(cls, value: Any) -> Any:
        if isinstance(value, bool):  # YAML's yes and true would pass for 1
            raise ValueError
        return value

    @property
    def attended(self) -> bool:
        """Whether somebody is there who is asked."""
        return self.played_by in ("me", "web")

    @property
    def takes_pictures(self) -> bool:
        """Whether pictures are sampled, of a video or without one."""
        return self.pictures in ("sampled", "video")

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


SETTINGS = declared(Config)
"""Every setting by name, such as `days` or `calls.timeout`."""
AS_BEFORE = {"household": SHARED, "intentions": "hourly", "renderer": "tiny", "help_frames": 0}
"""How runs were made before there was a choice, where that is not the default of today."""


def load_config(path: Path | None = None, flags: Mapping[str, Any] | None = None) -> Config:
    """Read a study file and lay flags over it; a flag of None was not given.

    Flags are named as the fields are; of `models`, `calls`, `budget` and `search`, mappings of what was given.

    Raises:
        ConfigError: Naming the file or flag, the field and what was expected.
    """
    data = _as_it_was_made(path, in_words_of_today(Config, read_yaml(path, "study file"), str(path))) if path else {}
    given = {name: value for name, value in (flags or {}).items() if value is not None}
    if "models" in data:
        data["models"] = by_role(data["models"], tuple(Models.model_fields))
    merged = {**data, **given}
    for section in (name for name, one in SETTINGS.items() if one.section):
        if isinstance(data.get(section), dict) and section in given:
            merged[section] = {**data[section], **given[section]}
    try:
        return Config.model_validate(merged)
    except ValidationError as err:
        raise ConfigError(complaint(err, Config, str(path), given)) from None


def _as_it_was_made(path: Path, data: dict[str, Any]) -> dict[str, Any]:
    """Fill in what the configuration of an older run does not say, as that run was made."""
    of_a_run = path.name == "config.yaml" and (path.parent / "run.json").is_file()
    return {**AS_BEFORE, **data} if of_a_run else data
