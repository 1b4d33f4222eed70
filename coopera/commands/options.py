"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

RunPath = Annotated[Path, typer.Argument(metavar="RUN", help="A run directory, such as runs/run-001.")]
AsJson = Annotated[bool, typer.Option("--json", help="End with one line of JSON on standard output.")]
Model = Annotated[str | None, typer.Option(metavar="SPEC", help="Language model of every role. [default: offline]")]
BaseUrl = Annotated[str | None, typer.Option(metavar="URL", help="Address of an OpenAI-compatible server.")]
PromptFolder = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Prompt files that replace the shipped ones of the same name.")
]

CallBudget = Annotated[int | None, typer.Option(metavar="N", help="Stop, to be resumed, after N calls to models.")]
TokenBudget = Annotated[int | None, typer.Option(metavar="N", help="Stop, to be resumed, after N tokens.")]


def as_list(text: str | None) -> list[str] | None:
    """Split "a,b" into its names; None stays None."""
    return None if text is None else [name.strip() for name in text.split(",") if name.strip()]
