"""Memory: embeddings, semantic search over fixed lists, and the recency-weighted memory stream."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from memory.embeddings import CachedEmbeddings, as_array, bundled

_HOMES = {
    "CachedEmbeddings": "memory.embeddings",
    "as_array": "memory.embeddings",
    "bundled": "memory.embeddings",
}

__all__ = ["CachedEmbeddings", "as_array", "bundled"]


def __getattr__(name: str) -> Any:
    """Load a public name with its first use, so that importing the package costs nothing."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
