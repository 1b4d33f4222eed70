"""The offline routine model: people, robot and judge by rules, household knowledge and text similarity."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_WHERE = {"OfflineChatModel": "models.offline.chat"}

__all__ = ["OfflineChatModel"]


def __getattr__(name: str) -> Any:
    """Import a name when it is first used."""
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_WHERE[name]), name)
