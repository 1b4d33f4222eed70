from __future__ import annotations

import numpy as np
import pytest

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory import CachedEmbeddings, Search, bundled


def encode_by_name(text: str) -> np.ndarray:
    """A fake encoder: "3 4" becomes the vector (3, 4)."""
    return np.array([float(number) for number in text.split()], np.float32)


@pytest.fixture
def search() -> Search:
    return Search(CachedEmbeddings(encode_by_name, "names"), ["0 1", "1 0", "3 4", "2 0", "-1 0"])


def test_the_nearest_come_first_with_their_cosines(search: Search) -> None:
    found = search.top("1 0", 3)
    # (1, 0) and (2, 0) point the same way; (3, 4) / 5 has the cosine 0.6
    assert found == [("1 0", 1.0), ("2 0", 1.0), ("3 4", pytest.approx(0.6, abs=1e-7))]


def test_equal_entries_keep_the_order_of_the_list() -> None:
    search = Search(CachedEmbeddings(encode_by_name, "names"), ["2 0", "1 0", "0 1", "4 0", "0 3"])
    assert [text for text, _ in search.top("0 5", 5)] == ["0 1", "0 3", "2 0", "1 0", "4 0"]


def test_k_may_exceed_the_list_and_the_list_may_be_empty(search: Search) -> None:
    assert len(search.top("1 1", 99)) == len(search) == 5
    assert Search(CachedEmbeddings(encode_by_name, "names"), []).top("1 1", 3) == []


def test_the_list_is_encoded_once() -> None:
    embeddings = CachedEmbeddings(encode_by_name, "names")
    search = Search(embeddings, ["1 0", "0 1"])
    for _ in range(5):
        search.top("1 0", 1)
    assert embeddings.misses == 2


def test_bad_input_is_told(search: Search) -> None:
    with pytest.raises(ConfigError, match="k must be at least 1, not 0"):
        search.top("1 0", 0)
    with pytest.raises(ConfigError, match="not empty"):
        search.top(" ", 1)
    with pytest.raises(MemoryStoreError, match="norm"):
        search.top("0 0", 1)


def test_with_real_embeddings_things_are_found_by_meaning() -> None:
    search = Search(bundled(), ["coffee machine", "bathtub", "bookshelf", "guitar"])
    assert search.top("make an espresso", 1)[0][0] == "coffee machine"
    assert search.top("play some music", 1)[0][0] == "guitar"
