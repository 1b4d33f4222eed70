"""Memory: the memory stream (relevance x recency), search over fixed lists, and embeddings.

Stores of memory streams are checked, repaired, exported and imported here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.memory.embeddings import CachedEmbeddings, as_array, bundled, hugging_face
    from coopera.memory.questions import Recollection, Relevances, Texts
    from coopera.memory.rebuild import Repaired, repair
    from coopera.memory.retriever import MemoryRetriever
    from coopera.memory.rows import Record
    from coopera.memory.search import Search
    from coopera.memory.store import streams
    from coopera.memory.stream import MemoryStream, extend_together
    from coopera.memory.transfer import export_jsonl, import_jsonl

_HOMES = {
    "CachedEmbeddings": "coopera.memory.embeddings",
    "MemoryRetriever": "coopera.memory.retriever",
    "MemoryStream": "coopera.memory.stream",
    "Recollection": "coopera.memory.questions",
    "Record": "coopera.memory.rows",
    "Relevances": "coopera.memory.questions",
    "Repaired": "coopera.memory.rebuild",
    "Search": "coopera.memory.search",
    "Texts": "coopera.memory.questions",
    "as_array": "coopera.memory.embeddings",
    "bundled": "coopera.memory.embeddings",
    "export_jsonl": "coopera.memory.transfer",
    "extend_together": "coopera.memory.stream",
    "hugging_face": "coopera.memory.embeddings",
    "import_jsonl": "coopera.memory.transfer",
    "repair": "coopera.memory.rebuild",
    "streams": "coopera.memory.store",
}

__all__ = [
    "CachedEmbeddings",
    "MemoryRetriever",
    "MemoryStream",
    "Recollection",
    "Record",
    "Relevances",
    "Repaired",
    "Search",
    "Texts",
    "as_array",
    "bundled",
    "export_jsonl",
    "extend_together",
    "hugging_face",
    "import_jsonl",
    "repair",
    "streams",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
