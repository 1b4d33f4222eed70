"""Taking hold of a run's folder: one writer at a time, and nothing left behind where a start fails."""

from __future__ import annotations

import fcntl
import os
import shutil
import socket
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from coopera.config.files import reason
from coopera.core.errors import ConfigError, RunError


def refuse_used(out: Path) -> None:
    """Refuse a folder that a new run cannot have.

    Raises:
        ConfigError: If it holds another run, is not empty, or is a file, or if its name is no text.
    """
    try:
        os.fspath(out).encode()
    except UnicodeEncodeError:
        raise ConfigError(f"out: {out} must be UTF-8 text, since the run's files name it.") from None
    try:
        if (out / "run.json").exists():
            raise ConfigError(
                f"out: {out} already holds another run; choose another folder, or `coopera resume {out}`."
            )
        if out.exists() and not out.is_dir():
            raise ConfigError(f"out: {out} must be a folder, and it is a file.")
        if out.is_dir() and any(out.iterdir()):
            raise ConfigError(f"out: {out} is not empty; a new run needs an empty folder or a new one.")
    except OSError as err:
        raise ConfigError(f"out: {out} cannot be written ({reason(err)}).") from err


def make_folder(out: Path) -> list[Path]:
    """Make a run's folder and say which folders were made for it, innermost first.

    Raises:
        ConfigError: If the folder cannot be had or made.
    """
    refuse_used(out)
    missing = [folder for folder in (out, *out.parents) if not folder.exists()]
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as err:
        clear(out, missing)
        raise ConfigError(f"out: {out} cannot be written ({reason(err)}).") from err
    return missing


def clear(root: Path, made: Sequence[Path]) -> None:
    """Undo a start that failed: our files go, and so do the folders that were made for them."""
    for name in ("config.yaml", "run.json", "seal.json", "lock"):
        with suppress(OSError):
            (root / name).unlink()
    for name in ("people", "scenes"):
        shutil.rmtree(root / name, ignore_errors=True)
    for folder in made:
        with suppress(OSError):  # one that is not empty holds something of others, and stays
            folder.rmdir()


def empty(root: Path, made: Sequence[Path]) -> None:
    """Undo a start after which nothing was done: all that the folder holds goes, and the folders made for it."""
    for inside in root.iterdir():
        if inside.is_dir():
            shutil.rmtree(inside, ignore_errors=True)
        else:
            inside.unlink(missing_ok=True)
    clear(root, made)


def lock(root: Path, what: str = "run") -> IO[str]:
    """Take the lock of a run's or a benchmark's folder, which the system frees when this process ends, however it does.

    Raises:
        RunError: If another process holds it.
        OSError: If the folder cannot be written.
    """
    file = (root / "lock").open("w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise RunError(f"{root}: another process is writing this {what}; stop it first, or wait for its end.") from None
    return file


def writer() -> dict[str, Any]:
    """This process, as run.json names it."""
    pid = os.getpid()
    return {"pid": pid, "pid_start": _start_of(pid), "host": socket.gethostname()}


def refuse_second_writer(path: Path, info: Mapping[str, Any]) -> None:
    """Refuse a run whose writer lives; of a writer on another machine only the lock can tell.

    Raises:
        RunError: Naming the process.
    """
    if info["state"] == "running" and info.get("pid") != os.getpid() and is_gone(info) is False:
        raise RunError(f"{path}: process {info['pid']} is still writing this run; stop it first, or wait for its end.")


def is_gone(info: Mapping[str, Any]) -> bool | None:
    """Whether the process that run.json names has ended; None where that cannot be told, as of another machine's."""
    pid = info.get("pid")
    if info.get("host") != socket.gethostname() or not isinstance(pid, int):
        return None
    started = _start_of(pid)
    return started is None or info.get("pid_start") not in (started, None)


def _start_of(pid: int) -> int | None:
    """When a process started, in clock ticks since boot, so that a reused number is not taken for it; None if gone."""
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19])
    except (OSError, ValueError, IndexError):
        return None


def sweep(root: Path) -> None:
    """Remove what a killed writer left half written in a run."""
    for half in root.rglob(".*.tmp"):
        half.unlink(missing_ok=True)
