from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path

import pytest
from langchain_core.documents import Document
from langchain_core.embeddings import Embeddings
from langchain_core.runnables import RunnableLambda
from pydantic import ValidationError

from coopera.memory import MemoryRetriever, MemoryStream


@pytest.fixture
def stream(tmp_path: Path, letters: Embeddings) -> Iterator[MemoryStream]:
    with MemoryStream.open(tmp_path, "x", letters, decay=0.5) as opened:
        yield opened


def test_documents_come_with_their_scores_and_their_own_metadata(stream: MemoryStream) -> None:
    retriever = MemoryRetriever(memory=stream, now=4, k=2)
    retriever.add_documents([Document("ab"), Document("a", metadata={"page": 7})], hour=3)
    [first, second] = retriever.invoke("a")
    assert first == Document("a", metadata={"page": 7, "hour": 3, "relevance": 1, "recency": 0.5, "score": 0.5})
    assert second.page_content == "ab"


def test_time_is_the_caller_s(stream: MemoryStream) -> None:
    for hour in range(3):
        stream.add(["a" * (hour + 1)], hour)
    clock = {"now": 0}
    retriever = MemoryRetriever(memory=stream, now=lambda: clock["now"], k=1)
    seen = []
    for clock["now"] in (0, 1, 2, 0):
        seen += [document.page_content for document in retriever.invoke("a")]
    assert seen == ["a", "aa", "aaa", "a"]


def test_it_is_a_link_of_a_chain_and_runs_asynchronously(stream: MemoryStream) -> None:
    stream.add(["abc", "d"], 0)
    chain = MemoryRetriever(memory=stream, now=0, k=1) | RunnableLambda(lambda documents: documents[0].page_content)
    assert chain.invoke("d") == "d"
    assert asyncio.run(chain.ainvoke("ab")) == "abc"


def test_k_below_one_is_refused(stream: MemoryStream) -> None:
    with pytest.raises(ValidationError, match="greater than or equal to 1"):
        MemoryRetriever(memory=stream, now=0, k=0)
