from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.errors import RunError
from coopera.models.cache import ReplyCache


def test_a_damaged_cache_is_named(tmp_path: Path) -> None:
    path = tmp_path / "llm_cache.sqlite"
    path.write_bytes(b"not a database at all, but long enough to be read as one" * 100)
    with pytest.raises(RunError, match=r"llm_cache\.sqlite"):
        ReplyCache(path)
    with pytest.raises(RunError, match="nowhere"):
        ReplyCache(tmp_path / "nowhere" / "c")
