"""A store's folder: what makes it one, its lock, and the seal that tells how it was closed."""

from __future__ import annotations

import fcntl
import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from coopera.core.errors import ConfigError, MemoryStoreError

CHROMA = "chroma.sqlite3"
_LOCK = "writer.lock"
_SEAL = "closed.json"


class DamagedMemoryError(MemoryStoreError):
    """A store is damaged; the text says how it can be rebuilt.

    Attributes:
        where: The store, and the stream if it is known.
        what: What is wrong.
        interrupted: Whether its last writer ended without closing it, which explains a half-written index.
    """

    def __init__(self, where: str, what: str, *, interrupted: bool = False) -> None:
        """Tell of the damage and of the way out."""
        super().__init__(
            f"{where}: the memory is damaged: {what}; `coopera memory repair` rebuilds it from its texts, if these are "
            f"whole, and `coopera doctor --repair` from the trace of its run"
        )
        self.where = where
        self.what = what
        self.interrupted = interrupted


def check_folder(folder: Path, create: bool) -> None:
    """Make sure that a folder is a store or may become one."""
    if folder.exists() and not folder.is_dir():
        raise ConfigError(f"{folder}: a memory store is a folder, and this is a file")
    if not folder.exists() and repaired(folder).exists():  # complete, since it was about to take the store's place
        repaired(folder).rename(folder)
    if (folder / CHROMA).exists():
        return
    others = (
        sorted(entry.name for entry in folder.iterdir() if entry.name not in (_LOCK, _SEAL)) if folder.exists() else []
    )
    if others:
        raise ConfigError(f"{folder}: is no memory store, since it has no {CHROMA} but {', '.join(others[:3])}")
    if not create:
        raise ConfigError(f"{folder}: there is no memory store")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as err:
        raise ConfigError(f"{folder}: the memory store cannot be created: {err}") from err


def begun(folder: Path) -> bool:
    """Whether there is anything of a store; the process that made the folder may have died right then."""
    return folder.exists() and any(entry.name not in (_LOCK, _SEAL) for entry in folder.iterdir())


def repaired(folder: Path) -> Path:
    """Return where a store is rebuilt before it takes the place of the damaged one."""
    return folder.with_name(f"{folder.name}.repaired")


def lock(folder: Path) -> IO[str]:
    """Take the folder's lock, which the system releases when the process ends, however it ends."""
    try:
        file = (folder / _LOCK).open("a+")
    except OSError as err:
        raise ConfigError(f"{folder}: the memory store cannot be written: {err}") from err
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as err:
        file.seek(0)
        holder = {"pid": "unknown", "host": "unknown"}
        with suppress(ValueError):
            holder |= json.loads(file.read())
        file.close()
        raise MemoryStoreError(
            f"{folder}: the memory store is in use by process {holder['pid']} on {holder['host']}; "
            "one process at a time may open it (several can share one through a Chroma server)"
        ) from err
    file.truncate(0)
    file.write(json.dumps({"pid": os.getpid(), "host": socket.gethostname()}))
    file.flush()
    return file


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold an existing store's lock without opening it.

    Raises:
        ConfigError: If the folder is no store.
        MemoryStoreError: If someone has it open.
    """
    check_folder(folder, create=False)
    with lock(folder):
        yield


def _files(folder: Path) -> dict[str, list[int]]:
    """Return size and time of change of each of Chroma's files."""
    files = {}
    for path in sorted([*folder.glob("*/*"), *folder.glob(f"{CHROMA}*")]):
        about = path.stat()
        files[str(path.relative_to(folder))] = [about.st_size, about.st_mtime_ns]
    return files


def seal(folder: Path) -> None:
    """Note the state in which the store was closed."""
    with suppress(OSError):  # without a seal, the next opening looks more closely
        (folder / _SEAL).write_text(json.dumps(_files(folder)))


def unseal(folder: Path) -> None:
    """Note that the store is open, by taking away its seal."""
    (folder / _SEAL).unlink(missing_ok=True)


def was_closed(folder: Path) -> bool:
    """Whether the last process to open the store also closed it, whatever became of the files since."""
    return (folder / _SEAL).exists()


def is_as_sealed(folder: Path) -> bool:
    """Whether a store's files are those that were closed; if not, a crash or a copy lies between."""
    files = _files(folder)
    try:
        return not files or bool(json.loads((folder / _SEAL).read_text()) == files)
    except (OSError, ValueError):
        return False
