"""Replies of language models by content, in SQLite: methods and reruns that ask the same share the answer."""

from __future__ import annotations

import hashlib
import json
import sqlite3
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from coopera.core.errors import RunError

_PATIENCE = 60.0  # seconds that a process waits for another one's write


class CachedReply(NamedTuple):
    """A model's raw reply, and the tokens that it took."""

    text: str
    tokens_in: int = 0
    tokens_out: int = 0
    cut: bool = False
    """Whether the reply ended at the length limit."""


def key_of(model: str, messages: Sequence[object], images: Iterable[bytes], form: Sequence[object], seed: int) -> str:
    """SHA-256 over all that decides a reply.

    Args:
        model: Its name.
        messages: What it is told, as plain JSON data without the pictures.
        images: The pictures, as files.
        form: The parameters of the call: temperature, length, schema.
        seed: Which draw it is.
    """
    hashed = [hashlib.sha256(image).hexdigest() for image in images]
    content = json.dumps([model, messages, hashed, form, seed], ensure_ascii=False, sort_keys=True)
    return hashlib.sha256(content.encode("utf-8", "surrogatepass")).hexdigest()


class ReplyCache:
    """A table from key to reply. Threads and processes may share the file."""

    def __init__(self, path: Path, shared: Path | None = None, *, copy: bool = False) -> None:
        """Open or create the file.

        Args:
            path: Where replies are kept.
            shared: A second file that other runs use too; what it knows is copied into the first.
            copy: Whether another file has the same, so that no reply waits for the disk. If the power fails, the last
                ones may then be missing from this file.

        Raises:
            RunError: If the file cannot be opened or is something else.
        """
        self._path = path
        self._shared: ReplyCache | None = None
        self._lock = threading.Lock()
        with self._guarded():
            self._db = sqlite3.connect(path, timeout=_PATIENCE, check_same_thread=False, isolation_level=None)
            try:
                self._db.execute("PRAGMA journal_mode=WAL")
                if copy:
                    self._db.execute("PRAGMA synchronous=NORMAL")
                self._db.execute(
                    "CREATE TABLE IF NOT EXISTS replies(key TEXT PRIMARY KEY, reply TEXT, tokens_in INTEGER,"
                    " tokens_out INTEGER, cut INTEGER) WITHOUT ROWID"
                )
            except sqlite3.Error:
                self._db.close()
                raise
        if shared is not None:
            try:
                shared.parent.mkdir(parents=True, exist_ok=True)
                self._shared = ReplyCache(shared, copy=True)
            except (OSError, RunError):
                self._db.close()
                raise

    def get(self, key: str) -> CachedReply | None:
        """The reply of a key, or None."""
        with self._lock, self._guarded():
            query = "SELECT reply, tokens_in, tokens_out, cut FROM replies WHERE key = ?"
            row = self._db.execute(query, (key,)).fetchone()
        if row:
            return CachedReply(row[0], row[1], row[2], bool(row[3]))
        known = self._shared.get(key) if self._shared is not None else None
        if known is not None:
            self._insert([(key, known)])
        return known

    def put(self, replies: Iterable[tuple[str, CachedReply]]) -> None:
        """Keep replies; what is there already stays."""
        fresh = list(replies)
        self._insert(fresh)
        if self._shared is not None:
            self._shared.put(fresh)

    def _insert(self, replies: Iterable[tuple[str, CachedReply]]) -> None:
        rows = [(key, *reply) for key, reply in replies]
        with self._lock, self._guarded():
            self._db.executemany("INSERT OR IGNORE INTO replies VALUES (?, ?, ?, ?, ?)", rows)

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._db.close()
        if self._shared is not None:
            self._shared.close()

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as err:
            raise RunError(f"{self._path}: the cache of model replies cannot be used: {err}") from err
