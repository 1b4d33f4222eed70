"""A memory stream as a LangChain retriever, for anyone's chain or agent."""

from __future__ import annotations

from collections.abc import Callable

from langchain_core.callbacks import CallbackManagerForRetrieverRun
from langchain_core.documents import Document
from langchain_core.retrievers import BaseRetriever
from pydantic import ConfigDict, Field
from typing_extensions import override

from coopera.memory.stream import MemoryStream


class MemoryRetriever(BaseRetriever):
    """Retrieves the documents of the highest recency x relevance, best first.

    Each document's metadata holds the record's own, and beside it `hour`, `relevance`, `recency` and `score`.

    Attributes:
        memory: The stream to read.
        now: Hour of the recall, or a function that tells it: time is yours, simulated or real.
        k: How many documents, at least 1.
        since: First hour in question; None for no limit.
    """

    model_config = ConfigDict(arbitrary_types_allowed=True)

    memory: MemoryStream
    now: int | Callable[[], int]
    k: int = Field(5, ge=1)
    since: int | None = None

    def add_documents(self, documents: list[Document], hour: int) -> None:
        """Add an hour's documents to the stream; their metadata must be JSON data."""
        self.memory.add([document.page_content for document in documents], hour, [d.metadata for d in documents])

    @override
    def _get_relevant_documents(self, query: str, *, run_manager: CallbackManagerForRetrieverRun) -> list[Document]:
        now = self.now() if callable(self.now) else self.now
        documents = []
        for text, hour, relevance, recency, score, own in self.memory.recall(query, now, self.k, self.since):
            scores = {"hour": hour, "relevance": relevance, "recency": recency, "score": score}
            documents.append(Document(text, metadata={**own, **scores}))
        return documents
