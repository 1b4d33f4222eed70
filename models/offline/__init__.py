"""The offline routine model: person, robot and judge by rules, household knowledge and text similarity.

It is a LangChain chat model, but not a language model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.models.offline.chat import OfflineChatModel

__all__ = ["OfflineChatModel"]

_HOMES = {"OfflineChatModel": "coopera.models.offline.chat"}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
