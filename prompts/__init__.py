"""The prompts, as files for a user to edit.

The prompt library loads, checks and renders them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.prompts.loader import PromptLibrary, check

__all__ = ["PromptLibrary", "check"]

_HOMES = {"PromptLibrary": "coopera.prompts.loader", "check": "coopera.prompts.loader"}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
