"""Parts of the configuration that have fields of their own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from coopera.core.people import Frozen
from coopera.core.setting import Setting

Text = Annotated[str, Field(min_length=1)]

_MODEL = "a model such as offline"


class Models(Frozen):
    """Which language model plays which role."""

    human: Annotated[Text, Setting("Language model of the person.", _MODEL, flag="--human-model", metavar="SPEC")] = (
        "offline"
    )
    robot: Annotated[Text, Setting("Language model of the robot.", _MODEL, flag="--robot-model", metavar="SPEC")] = (
        "offline"
    )
    judge: Annotated[Text, Setting("Language model of the judge.", _MODEL, flag="--judge-model", metavar="SPEC")] = (
        "offline"
    )


class Files(Frozen):
    """Where people and homes are that no catalogue has, by id."""

    humans: Annotated[dict[str, Path], Setting("Persona files by id.", "a mapping of ids to files")] = {}
    scenes: Annotated[dict[str, Path], Setting("Files of homes by id.", "a mapping of ids to files")] = {}
