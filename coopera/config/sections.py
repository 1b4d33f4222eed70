"""Parts of the configuration: those that have fields of their own, and types with their words."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator, model_validator

from coopera.core.people import Frozen
from coopera.core.setting import Setting
from coopera.models.given import GivenModel, as_spec, by_role

Text = Annotated[str, Field(min_length=1)]
Pixels = Annotated[int, Field(strict=True, ge=32, le=2048)]

KeptAdapters = Annotated[
    str,
    Field(pattern=r"^(all|last|every:[1-9][0-9]{0,2})$"),
    Setting(
        "Which evenings' trained classifiers a run keeps, of each episode: all, the newest alone (last), or those of "
        "every Nth evening besides (every:N); examples are always kept.",
        "all, last or every:N, such as every:5",
        flag="--keep-adapters",
        metavar="all|last|every:N",
    ),
]

FrameSize = Annotated[
    tuple[Pixels, Pixels],
    Setting(
        "Width and height of a picture in pixels.",
        "two whole numbers from 32 to 2048, [width, height]",
        unset="320 x 240, or 1024 x 768 where the robot's model looks at pictures",
    ),
]

HelpFrames = Annotated[
    int,
    Field(strict=True, ge=0, le=16),
    Setting("Pictures of each of the robot's own acts, where pictures are taken; no model is shown them."),
]

Labels = Annotated[
    bool,
    Setting(
        "Whether names are written into the pictures, for vision models that see little: of the thing in hand, of who "
        "is there and of the furniture beside them.",
        flag="--labels",
    ),
]

_MODEL = "a model such as offline"


def _kept(value: Any, check: ValidatorFunctionWrapHandler) -> str:
    """A model's spec; a chat model that a script gives stays with its spec."""
    spec = as_spec(value)
    return spec if isinstance(spec, GivenModel) else str(check(spec))


Model = Annotated[Text, WrapValidator(_kept)]


class Models(Frozen):
    """Which language model plays which role: specs, or chat models of LangChain; one alone plays all."""

    human: Annotated[Model, Setting("Language model of the person.", _MODEL, flag="--human-model", metavar="SPEC")] = (
        "offline"
    )
    robot: Annotated[Model, Setting("Language model of the robot.", _MODEL, flag="--robot-model", metavar="SPEC")] = (
        "offline"
    )
    judge: Annotated[Model, Setting("Language model of the judge.", _MODEL, flag="--judge-model", metavar="SPEC")] = (
        "offline"
    )

    @model_validator(mode="before")
    @classmethod
    def _for_all_roles(cls, data: Any) -> Any:
        return by_role(data, tuple(cls.model_fields))


class Files(Frozen):
    """Where people and homes are that no catalogue has, by id."""

    humans: Annotated[dict[str, Path], Setting("Persona files by id.", "a mapping of ids to files")] = {}
    scenes: Annotated[dict[str, Path], Setting("Files of homes by id.", "a mapping of ids to files")] = {}


PlayedBy = Annotated[
    str,
    Field(pattern=r"^(simulated|me|web|log:.+)$"),
    Setting(
        "Who plays the person: the simulation, you (asked hour by hour, in this terminal or on a page in the browser), "
        "or a real person's log or diary.",
        "simulated, me, web or log:FILE",
        flag="--played-by",
        formerly="human",
        metavar="simulated|me|web|log:FILE",
    ),
]


class RealPerson(Frozen):
    """How a real person is asked who plays the person."""

    questions: Annotated[
        int,
        Field(strict=True, ge=1, le=10_000),
        Setting(
            "Questions of an evening at most; of more, each hour has as many as the others, drawn at random.",
            flag="--evening-questions",
        ),
    ] = 60
    participant: Annotated[
        Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,59}$")] | None,
        Setting(
            "The participant's id in your study, never a name; kept in the run.",
            "up to 60 letters, digits, dots, dashes and underscores",
            flag="--participant",
            metavar="ID",
            unset="asked for before the first question, where there is a consent text",
        ),
    ] = None
    consent: Annotated[
        Path | None,
        Setting(
            "Text that a participant must agree to before the first question; kept in the run, with the answer.",
            "the path of a text file",
            flag="--consent",
            metavar="FILE",
            unset="nothing is to be agreed to",
        ),
    ] = None


Private = Annotated[
    bool,
    Field(strict=True),
    Setting(
        "Nobody else on this machine may read the run: its files have mode 0600, its folders 0700, and its replies go "
        "to no cache that runs share, unless `cache` names one.",
        "true or false",
        flag="--private",
        unset="false",
    ),
]
