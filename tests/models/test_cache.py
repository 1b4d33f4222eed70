from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from coopera.core.errors import RunError
from coopera.models.cache import CachedReply, ReplyCache


def test_a_damaged_cache_is_named(tmp_path: Path) -> None:
    path = tmp_path / "llm_cache.sqlite"
    path.write_bytes(b"not a database at all, but long enough to be read as one" * 100)
    with pytest.raises(RunError, match=r"llm_cache\.sqlite"):
        ReplyCache(path)
    with pytest.raises(RunError, match="nowhere"):
        ReplyCache(tmp_path / "nowhere" / "c")


def test_a_paid_reply_waits_for_the_disk_in_the_runs_own_file_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: dict[str, sqlite3.Connection] = {}
    connect = sqlite3.connect

    def noted(path: Path, **how: object) -> sqlite3.Connection:
        opened[path.name] = connect(path, **how)  # type: ignore[call-overload]
        return opened[path.name]

    monkeypatch.setattr(sqlite3, "connect", noted)
    with closing(ReplyCache(tmp_path / "own", tmp_path / "others" / "shared")) as cache:
        cache.put([("key", CachedReply("yes"))])
        levels = {name: db.execute("PRAGMA synchronous").fetchone()[0] for name, db in opened.items()}
    full, normal = 2, 1
    assert levels == {"own": full, "shared": normal}
    for name in ("own", "others/shared"):
        with closing(ReplyCache(tmp_path / name)) as cache:
            assert cache.get("key") == CachedReply("yes")
