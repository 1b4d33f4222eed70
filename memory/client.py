"""How Chroma is reached: a folder's client, a server's client, and its errors as ours."""

from __future__ import annotations

import ctypes
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory.folder import CHROMA

if TYPE_CHECKING:
    import httpx
    from chromadb.api import ClientAPI

_PATIENCE = 10.0  # seconds to wait for a server's answer when connecting
_REQUEST_PATIENCE = 60.0
_THREAD = "tokio-rt-worker"
_LOOKS = (0.0, 0.001, *[0.01] * 20)
"""After which pauses one looks at threads that should rest (seconds)."""
_PAGES = 100
"""Pages of 4 kB of its database that each connection of Chroma's keeps in RAM; by SQLite's own measure, 2 MB each."""


@contextmanager
def translated(where: str) -> Iterator[None]:
    """Turn what Chroma and its transport raise into our error.

    Raises:
        MemoryStoreError: Naming the store and the reason.
    """
    import httpx  # noqa: PLC0415 - heavy
    from chromadb.errors import ChromaError  # noqa: PLC0415

    try:
        yield
    except httpx.HTTPError as err:
        raise MemoryStoreError(f"{where}: the memory server does not answer ({type(err).__name__}: {err})") from err
    except (ChromaError, ValueError, OSError) as err:
        raise MemoryStoreError(f"{where}: the memory store failed: {err}") from err


def open_client(folder: Path) -> ClientAPI:
    """Open a folder with Chroma; the caller holds the lock.

    Of its database Chroma then keeps little in RAM: what is read again and again a stream keeps itself, and half a
    dozen connections would each hold more of it every day.
    """
    import chromadb  # noqa: PLC0415 - heavy
    from chromadb.config import Settings  # noqa: PLC0415

    with suppress(sqlite3.Error):  # Chroma tells what is wrong
        _limit_pages(folder / CHROMA)
    with translated(str(folder)):
        try:
            return chromadb.PersistentClient(str(folder), settings=Settings(anonymized_telemetry=False))
        except BaseException:
            _forget(str(folder))
            raise


def _limit_pages(database: Path) -> None:
    """Note in the database, made now if need be, how much of it a connection may keep."""
    with closing(sqlite3.connect(database)) as connection:
        if connection.execute("PRAGMA default_cache_size").fetchone() != (_PAGES,):
            connection.execute(f"PRAGMA default_cache_size = {_PAGES}")


def _forget(folder: str) -> None:
    """Have Chroma forget what it could not begin: it keeps it, and would give it to whoever opens the folder next."""
    from chromadb.api.shared_system_client import SharedSystemClient  # noqa: PLC0415 - heavy

    SharedSystemClient._identifier_to_system.pop(folder, None)
    SharedSystemClient._identifier_to_refcount.pop(folder, None)


def connect(url: str) -> ClientAPI:
    """Connect to a Chroma server, waiting a bounded time for it."""
    import chromadb  # noqa: PLC0415 - heavy
    import httpx  # noqa: PLC0415
    from chromadb.config import Settings  # noqa: PLC0415

    parts = urlsplit(url)
    secure = parts.scheme == "https"
    try:
        port = parts.port or (443 if secure else 8000)
    except ValueError as err:
        raise ConfigError(f"{url}: is no address of a memory server: {err}") from err
    if not parts.hostname:
        raise ConfigError(f"{url}: is no address of a memory server; expected http://host:port")
    host = f"[{parts.hostname}]" if ":" in parts.hostname else parts.hostname
    with translated(url):
        answer = httpx.get(f"{parts.scheme}://{host}:{port}/api/v2/heartbeat", timeout=_PATIENCE)
        if answer.status_code != httpx.codes.OK or "nanosecond heartbeat" not in answer.text:
            raise MemoryStoreError(f"{url}: something answers there, but it is no Chroma server")
        client = chromadb.HttpClient(
            host=parts.hostname, port=port, ssl=secure, settings=Settings(anonymized_telemetry=False)
        )
    for session in _sessions(client):
        session.timeout = httpx.Timeout(_REQUEST_PATIENCE)
    return client


def disconnect(client: ClientAPI) -> None:
    """Close a client with its connections, but not what would never close.

    Chroma's pool of connections (sqlx-core 0.8.6) rarely comes to count itself without end, from which closing it never
    returns, nor lets Ctrl-C through: https://github.com/launchbadge/sqlx/issues/3645. Such a pool stays until the
    process ends. What was written is on disk.
    """
    pools = _sessions(client)
    bindings = getattr(getattr(client, "_server", None), "bindings", None)
    if bindings is not None and _never_rests():
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(bindings))  # so that nothing, not even Python's end, drops it
    client.close()  # type: ignore[attr-defined]  # Chroma's base class lacks it
    for pool in pools:
        pool.close()


def _never_rests() -> bool:
    """Whether one of the pool's threads runs whenever one looks, though nobody asks anything of it (Linux alone)."""
    busy: set[Path] | None = None
    for pause in _LOOKS:
        threading.Event().wait(pause)
        running = {task for task in Path("/proc/self/task").glob("*") if _runs(task)}
        busy = running if busy is None else busy & running
        if not busy:
            return False
    return True


def _runs(task: Path) -> bool:
    try:
        name, _, rest = (task / "stat").read_text(encoding="utf-8").partition(" (")[2].rpartition(") ")
    except OSError:  # it has ended
        return False
    return name == _THREAD and rest.startswith("R")


def _sessions(client: ClientAPI) -> list[httpx.Client]:
    """Return the connection pools of a server's client: Chroma neither limits their waiting nor closes them."""
    import httpx  # noqa: PLC0415 - heavy

    found = []
    for part in (client, getattr(client, "_admin_client", None)):
        session = getattr(getattr(part, "_server", None), "_session", None)
        if isinstance(session, httpx.Client):
            found.append(session)
    return found
