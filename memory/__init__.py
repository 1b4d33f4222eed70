"""Memory: embeddings, semantic search over fixed lists, and the recency-weighted memory stream."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.lazy import lazy_names

if TYPE_CHECKING:
    from memory.embeddings import CachedEmbeddings, as_array, bundled, hugging_face
    from memory.log import Record
    from memory.rebuild import Repaired, repair
    from memory.retriever import MemoryRetriever
    from memory.search import Search
    from memory.store import streams
    from memory.stream import MemoryStream, Recollection
    from memory.transfer import export_jsonl, import_jsonl

_HOMES = {
    "CachedEmbeddings": "memory.embeddings",
    "MemoryRetriever": "memory.retriever",
    "MemoryStream": "memory.stream",
    "Recollection": "memory.stream",
    "Record": "memory.log",
    "Repaired": "memory.rebuild",
    "Search": "memory.search",
    "as_array": "memory.embeddings",
    "bundled": "memory.embeddings",
    "export_jsonl": "memory.transfer",
    "hugging_face": "memory.embeddings",
    "import_jsonl": "memory.transfer",
    "repair": "memory.rebuild",
    "streams": "memory.store",
}

__all__ = [
    "CachedEmbeddings",
    "MemoryRetriever",
    "MemoryStream",
    "Recollection",
    "Record",
    "Repaired",
    "Search",
    "as_array",
    "bundled",
    "export_jsonl",
    "hugging_face",
    "import_jsonl",
    "repair",
    "streams",
]

__getattr__ = lazy_names(__name__, _HOMES)
