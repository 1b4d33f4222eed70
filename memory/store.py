"""A store of streams: a folder that one process at a time may open, or a Chroma server.

Each stream is a Chroma collection of its own. Chroma is used as a durable log and text store addressed by id; its
index of neighbours is never asked, so it is built as cheaply as can be.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import threading
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Protocol, TypeVar

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory.client import connect, disconnect, open_client, translated
from coopera.memory.damage import damage
from coopera.memory.folder import DamagedMemoryError, check_folder, is_as_sealed, lock, seal, unseal, was_closed
from coopera.memory.rows import FORMAT, FORMATS
from coopera.memory.vectors import Vectors

if TYPE_CHECKING:
    from chromadb.api import ClientAPI
    from chromadb.api.models.Collection import Collection

    from coopera.memory.ram import RamClient

_SPACE = "ip"
_QUEUE = 100
"""Records of a collection of which Chroma keeps a log until it writes its index.

Each write reads through the log of all collections, so that with Chroma's 1000 an evening's took twice as long after
two months.
"""
_INDEX = {
    "hnsw": {
        "space": _SPACE,
        "ef_construction": 10,
        "max_neighbors": 4,
        "batch_size": _QUEUE,
        "sync_threshold": _QUEUE,
    }
}
MAX_NAME = 200


class Flushed(Protocol):
    """Something that keeps back what it writes, and holds what it read."""

    def flush(self) -> None:
        """Write it."""
        ...

    def let_go(self) -> None:
        """Hold nothing any longer."""
        ...


_Shared = TypeVar("_Shared", bound=Flushed)


class Store:
    """An open store; get one by `Store.open`, and `close` it as often as you opened it.

    Attributes:
        where: The folder or URL, for messages.
        exclusive: Whether no one else can write (a folder, locked).
        pid: The process that opened it.
    """

    _open: dict[Hashable, Store] = {}
    _guard = threading.RLock()

    def __init__(self, client: ClientAPI, where: str, key: Hashable, holding: IO[str] | None) -> None:
        """Use `Store.open`."""
        self.where = where
        self.exclusive = holding is not None
        self.pid = os.getpid()
        self._client = client
        self._key = key
        self._holding = holding
        self._users = 0
        self._shared: dict[str, tuple[int, Any]] = {}
        self._vectors: dict[str, Vectors] = {}

    @classmethod
    def open(cls, where: Path | str | ClientAPI | RamClient, *, create: bool = True) -> Store:
        """Open a folder, a server by URL, or a Chroma client of the caller's.

        Each is opened once per process, however many streams use it.

        Raises:
            ConfigError: If the folder is something else than a store, or missing and not to be created.
            MemoryStoreError: If another process has the folder open, or the server does not answer.
        """
        remote = isinstance(where, str) and where.startswith(("http://", "https://"))
        given = not isinstance(where, str | Path)
        key: Hashable = str(where) if remote else id(where) if given else Path(str(where)).resolve()
        with cls._guard:
            store = cls._open.get(key)
            if store is None or store.pid != os.getpid():  # a forked child shares the parent's lock, not its store
                if isinstance(key, Path):
                    store = cls._open_folder(key, create)
                elif remote:
                    store = cls(connect(str(where)), str(where), key, None)
                else:
                    store = cls(where, "the given Chroma client", key, None)  # type: ignore[arg-type]
                cls._open[key] = store
            store._users += 1
            return store

    @classmethod
    def _open_folder(cls, folder: Path, create: bool) -> Store:
        check_folder(folder, create)
        holding = lock(folder)
        try:
            if not is_as_sealed(folder):
                reason = damage(folder)
                if reason is not None:
                    raise DamagedMemoryError(str(folder), reason, interrupted=not was_closed(folder))
            unseal(folder)
            return cls(open_client(folder), str(folder), folder, holding)
        except BaseException:
            holding.close()
            raise

    def close(self) -> None:
        """Release the store; the last user's call closes Chroma and then the lock."""
        with Store._guard:
            self._users -= 1
            theirs = self.pid != os.getpid()  # of the process that this one was forked from
            if theirs or self._users > 0 or Store._open.get(self._key) is not self:
                return
            del Store._open[self._key]
            try:
                self.flush()
            finally:
                if not isinstance(self._key, int):  # a client of the caller's stays open
                    disconnect(self._client)
                if self._holding is not None:
                    seal(Path(self.where))
                    self._holding.close()

    def flush(self) -> None:
        """Have all that was added to the streams on disk.

        Raises:
            MemoryStoreError: If the store fails.
        """
        with Store._guard:
            shared = [thing for _, thing in self._shared.values()]
        for thing in shared:
            thing.flush()

    @classmethod
    def close_all(cls) -> None:
        """Close all open stores at the end of a program, so that its next start need not look for damage."""
        with cls._guard:
            for store in [store for store in cls._open.values() if store.pid == os.getpid()]:
                store._users = 1
                store.close()

    def streams(self) -> list[str]:
        """Return the names of the streams, sorted."""
        with translated(self.where):
            metadata = [collection.metadata or {} for collection in self._client.list_collections()]
        return sorted(str(entry["stream"]) for entry in metadata if "stream" in entry)

    def collection(self, name: str, model: str, *, create: bool = True) -> Collection:
        """Return a stream's collection, checked to be of this model and space.

        Raises:
            ConfigError: If the name is unusable, or the stream unknown and not to be created.
            MemoryStoreError: If the stream was written with another model, space or format.
        """
        if not isinstance(name, str) or not name.strip() or len(name) > MAX_NAME:
            raise ConfigError(f"the name of a memory stream must have 1 to {MAX_NAME} characters, not {name!r:.80}")
        if not name.isprintable():
            raise ConfigError(f"the name of a memory stream must be printable, not {name!r:.80}")
        known = create or name in self.streams()
        if not known:
            there = ", ".join(self.streams()) or "none"
            raise ConfigError(f"{self.where}: there is no memory stream {name!r}; those there: {there}")
        with translated(self.where):
            collection = self._client.get_or_create_collection(
                collection_name(name),
                configuration=_INDEX,  # type: ignore[arg-type]
                metadata={"stream": name, "model": model, "format": FORMAT},
                embedding_function=None,
            )
        self._check(collection, name, model)
        return collection

    def raw(self, name: str) -> Collection:
        """Return an existing stream's collection as it is, unchecked."""
        with translated(self.where):
            return self._client.get_collection(collection_name(name), embedding_function=None)

    def vectors(self, name: str) -> Vectors | None:
        """Where the vectors of an existing stream's texts are; None where its collection has them itself."""
        about = self.raw(name).metadata or {}
        model = str(about.get("model"))
        if about.get("format") == 1:
            return None
        with Store._guard:
            if model not in self._vectors:
                with translated(self.where):
                    collection = self._client.get_or_create_collection(
                        f"vectors-{_digest(model)}",
                        configuration=_INDEX,  # type: ignore[arg-type]
                        metadata={"model": model, "format": FORMAT},
                        embedding_function=None,
                    )
                self._vectors[model] = Vectors(collection, self.where)
            return self._vectors[model]

    def share(self, name: str, make: Callable[[], _Shared]) -> _Shared:
        """Return what `make` made at the first call for this name, to all who ask until all have let go of it."""
        with Store._guard:
            users, thing = self._shared.get(name) or (0, make())
            self._shared[name] = (users + 1, thing)
            return thing

    def unshare(self, name: str) -> None:
        """Let go of what `share` returned."""
        with Store._guard:
            users, thing = self._shared.pop(name)
            if users > 1:
                self._shared[name] = (users - 1, thing)
            else:
                thing.let_go()

    def _check(self, collection: Collection, name: str, model: str) -> None:
        """Refuse a stream that is of another kind than asked for."""
        found = collection.metadata or {}
        space = (collection.configuration_json.get("hnsw") or {}).get("space")
        at = f"{self.where}: the memory stream {name!r}"
        if found.get("stream") != name or found.get("format") not in FORMATS:
            raise MemoryStoreError(f"{at} was not written by this version of coopera (format {found.get('format')!r})")
        if found.get("model") != model:
            raise MemoryStoreError(f"{at} was written with the embeddings {found.get('model')!r}, not {model!r}")
        if space != _SPACE:
            raise MemoryStoreError(f"{at} has the vector space {space!r}, where {_SPACE!r} was expected")


def streams(where: Path | str | ClientAPI) -> list[str]:
    """Return the names of a store's streams, sorted.

    Raises:
        ConfigError: If there is no such store.
        MemoryStoreError: If it is in use, or does not answer.
    """
    store = Store.open(where, create=False)
    try:
        return store.streams()
    finally:
        store.close()


atexit.register(Store.close_all)


def collection_name(stream: str) -> str:
    """Return the Chroma collection's name for a stream; Chroma takes no free text as a name."""
    return f"stream-{_digest(stream)}"


def _digest(name: str) -> str:
    return hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:40]
