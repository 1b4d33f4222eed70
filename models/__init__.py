"""Language models behind one door: servers, weights in this process, recorded replies, and the offline routine model.

The robot's yes/no classifiers are here, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.models.door import Door, open_door
    from coopera.models.offline.chat import OfflineChatModel

__all__ = ["Door", "OfflineChatModel", "open_door"]

_HOMES = {
    "Door": "coopera.models.door",
    "OfflineChatModel": "coopera.models.offline.chat",
    "open_door": "coopera.models.door",
}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
