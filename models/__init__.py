"""Language models behind one door, the offline routine model, and the classifiers; names load when used."""

from __future__ import annotations

from core.lazy import lazy_names

_WHERE = {
    "Door": "models.door",
    "OfflineChatModel": "models.offline.chat",
    "open_door": "models.door",
}
"""Public name -> the module that defines it. To re-export a name, add it here."""

__all__ = sorted(_WHERE)

__getattr__ = lazy_names(__name__, _WHERE)
