"""Prompts as files that a user edits, and the library that loads, checks and renders them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from prompts.loader import PromptLibrary, check

_HOMES = {"PromptLibrary": "prompts.loader", "check": "prompts.loader"}

__all__ = ["PromptLibrary", "check"]


def __getattr__(name: str) -> Any:
    """Load a public name with its first use, so that importing the package costs nothing."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
