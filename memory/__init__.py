"""Memory: embeddings, semantic search over fixed lists, and the recency-weighted memory stream."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from memory.embeddings import CachedEmbeddings, as_array, bundled
    from memory.log import Record
    from memory.search import Search
    from memory.stream import MemoryStream, Recollection

_HOMES = {
    "CachedEmbeddings": "memory.embeddings",
    "MemoryStream": "memory.stream",
    "Recollection": "memory.stream",
    "Record": "memory.log",
    "Search": "memory.search",
    "as_array": "memory.embeddings",
    "bundled": "memory.embeddings",
}

__all__ = ["CachedEmbeddings", "MemoryStream", "Recollection", "Record", "Search", "as_array", "bundled"]


def __getattr__(name: str) -> Any:
    """Load a public name with its first use, so that importing the package costs nothing."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
