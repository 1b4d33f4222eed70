"""Language models behind one door, the offline routine model, and the classifiers; names load when used."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_WHERE = {
    "Door": "models.door",
    "OfflineChatModel": "models.offline.chat",
    "open_door": "models.door",
}
"""Public name -> the module that defines it. To re-export a name, add it here."""

__all__ = sorted(_WHERE)


def __getattr__(name: str) -> Any:
    """Import a name when it is first used."""
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_WHERE[name]), name)
