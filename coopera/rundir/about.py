"""What run.json says of a run: who writes it, with what, and how it stands."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from coopera.core.version import __version__
from coopera.rundir import claim

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


def about(prompts: Mapping[str, str], models: Mapping[str, str]) -> dict[str, Any]:
    """What is known of a run when it begins."""
    return {
        "schema": SCHEMA,
        "state": "running",
        "reason": "",
        **claim.writer(),
        "started": now(),
        "ended": None,
        "versions": {
            "coopera": __version__,
            "python": platform.python_version(),
            **{name: version for name in _PACKAGES if (version := _version(name))},
        },
        "prompts": dict(prompts),
        "models": dict(models),
    }


def _version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def now() -> str:
    """The time, in UTC."""
    return datetime.now(UTC).isoformat(timespec="seconds")
