"""Processes that are forked from one that has imported everything: trials of a whole program that begin at once."""

from __future__ import annotations

import importlib
import json
import os
import select
import socket
import subprocess
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any


def prober() -> Callable[..., str | None]:
    """A stand-in for `coopera.memory.damage.damage`, whose processes are forked and need not import anything anew.

    They come from one that is forked now, while there are no threads that could hold a lock then.
    """
    from coopera.memory.probe import reason_against  # noqa: PLC0415 - heavy

    ours, theirs = socket.socketpair()
    if os.fork() == 0:
        ours.close()
        talk = theirs.makefile("rw")
        for line in talk:
            talk.write(json.dumps(_in_a_fork(partial(reason_against, **json.loads(line)))) + "\n")
            talk.flush()
        os._exit(0)
    theirs.close()
    talk = ours.makefile("rw")

    def damage(folder: Path, *, everything: bool = False) -> str | None:
        talk.write(json.dumps({"folder": str(folder), "everything": everything}) + "\n")
        talk.flush()
        found: str | None = json.loads(talk.readline())
        return found

    return damage


class Photographer:
    """A stand-in for `subprocess.Popen` where `coopera.simulation.sight.studio` calls it, once: it gives a fork.

    That is made now, while there are no threads, and need not import anything anew.
    """

    def __init__(self) -> None:
        """Fork the process; it waits for its pipes."""
        from coopera.simulation.sight.darkroom import serve  # noqa: PLC0415 - heavy

        ours, theirs = socket.socketpair()
        self.pid = os.fork()
        if self.pid == 0:
            ours.close()
            os.setpgid(0, 0)
            _, pipes, _, _ = socket.recv_fds(theirs, 1, 8)
            with suppress(BaseException):
                serve(pipes) if pipes else None
            os._exit(0)
        theirs.close()
        self._talk = ours

    def __call__(self, given: Sequence[str], *, pass_fds: Sequence[int], **options: Any) -> Photographer:
        """Give the process its pipes."""
        socket.send_fds(self._talk, [b" "], pass_fds)
        return self

    def wait(self, timeout: float | None = None) -> int:
        """Its exit code, once it has ended."""
        handle = os.pidfd_open(self.pid)
        try:
            if not select.select([handle], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("pictures", timeout or 0.0)
        finally:
            os.close(handle)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


def _in_a_fork(look: Callable[[], str | None]) -> str | None:
    """What a function says in a process of its own, or how that process ended."""
    given, taken = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(taken, (look() or "").encode())
            os._exit(0)
        finally:
            os._exit(70)
    os.close(taken)
    with os.fdopen(given) as file:
        said = file.read()
    _, status = os.waitpid(child, 0)
    code = os.waitstatus_to_exitcode(status)
    return (said or None) if code == 0 else f"reading its index ends the process with {code}"


def redirect(err: Path, out: Path) -> None:
    """Have this process write its standard streams to files, anew."""
    for number, path in ((1, out), (2, err)):
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, number)
        os.close(file)


def import_all(names: Iterable[str]) -> None:
    """Import what a run imports, so that each trial need not."""
    for name in names:
        try:
            importlib.import_module(name)
        except Exception:  # noqa: BLE001 - some names are none of a module of its own
            continue
