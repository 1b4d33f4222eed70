"""What run.json says of a run: who writes it, with what, and how it stands."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from coopera.config.prices import Prices
from coopera.core.errors import RunError
from coopera.core.version import __version__
from coopera.models.given import GivenModel
from coopera.models.settings import Spent
from coopera.rundir import claim
from coopera.rundir.code import code_fingerprint
from coopera.rundir.trace_files import damaged, read_json

SCHEMA = 2
_PACKAGES = [
    "chromadb",
    "langchain-core",
    "langgraph",
    "numpy",
    "peft",
    "pillow",
    "pybullet",
    "pydantic",
    "scikit-learn",
    "torch",
    "transformers",
]


class _Told(BaseModel):
    """The shape of run.json, as far as it is read; other fields may stand there."""

    model_config = ConfigDict(strict=True, extra="allow")
    state: Literal["running", "stopped", "failed", "finished"]
    prompts: dict[str, str] = {}
    models: dict[str, str] = {}
    knowledge: dict[str, str] = {}
    versions: dict[str, str] = {}
    resumable: bool = True
    prices: Annotated[Prices | None, Field(strict=False)] = None
    spent: Annotated[Spent, Field(strict=False)] = Spent()


def read_about(path: Path) -> dict[str, Any]:
    """Read run.json.

    Raises:
        RunError: If it is damaged, or newer than this version understands; names the file and the field.
    """
    info = read_json(path)
    schema = info.get("schema") if isinstance(info, dict) else None
    if not isinstance(schema, int) or isinstance(schema, bool):
        raise RunError(f"{path}: the field schema is missing, so this run cannot be read.")
    if schema > SCHEMA:
        raise RunError(f"{path}: schema {schema} was written by a newer coopera; this one knows {SCHEMA}.")
    try:
        _Told.model_validate(info)
    except ValidationError as err:
        raise damaged(path, err) from err
    return dict(info)


def about(prompts: Mapping[str, str], models: Mapping[str, str]) -> dict[str, Any]:
    """What is known of a run when it begins; of models that are objects of a script, a fingerprint."""
    objects = {role: spec.mark for role, spec in models.items() if isinstance(spec, GivenModel)}
    return {
        "schema": SCHEMA,
        "state": "running",
        "reason": "",
        **claim.writer(),
        "started": now(),
        "ended": None,
        "versions": {
            "coopera": __version__,
            "code": code_fingerprint(),
            "python": platform.python_version(),
            **{name: version for name in _PACKAGES if (version := _version(name))},
        },
        "prompts": dict(prompts),
        "models": dict(models),
        **({"model_objects": objects} if objects else {}),
    }


@cache
def _version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def now() -> str:
    """The time, in UTC."""
    return datetime.now(UTC).isoformat(timespec="seconds")
