"""One life of a run: a command of coopera in a process of its own, which may be killed at a moment that is asked for.

The processes are forked from one that has imported everything, so that a life does not begin with seconds of imports.
"""

from __future__ import annotations

import multiprocessing
import os
import re
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.cli import main as coopera

_PATIENCE = 600.0
"""Seconds after which a life that was not killed counts as one that hangs."""
_LOST = 255
"""What Python says where its server of processes told it no exit code: now and then, where two threads ask it."""
_processes = multiprocessing.get_context("forkserver")
_processes.set_forkserver_preload(["benchmarks.warm", __name__])


class Moment(NamedTuple):
    """When a life is to end: after some seconds, or right before the `nth` time that it does this to a file."""

    seconds: float | None = None
    step: str = ""
    nth: int = 1


def live(arguments: Sequence[str], folder: Path, moment: Moment | None = None) -> int:
    """Carry out a command of coopera, in `folder`, until it ends or is killed.

    What it says stands in the file `said` of the folder afterwards. A life that is not to be killed leaves a file
    `steps`, too: a line for each time that it opened, renamed or removed a file of the folder `run`, or made a folder.

    Returns:
        Its exit code, -9 where it was killed.
    """
    (folder / "ended").unlink(missing_ok=True)
    code = in_a_process(_live, arguments, folder, moment, patience=moment.seconds if moment else None)
    if code == _LOST and (folder / "ended").exists():
        return int((folder / "ended").read_text())
    return code


def in_a_process(work: Any, *arguments: Any, patience: float | None = None) -> int:
    """Call a function at the top of a module in a process of its own, and kill it if it takes too long."""
    process = _processes.Process(target=work, args=arguments)
    process.start()
    process.join(_PATIENCE if patience is None else patience)
    if process.is_alive():
        process.kill()
        process.join()
    assert process.exitcode is not None
    return process.exitcode


def _live(arguments: Sequence[str], folder: Path, moment: Moment | None) -> None:
    os.chdir(folder)
    said = os.open("said", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(said, 1)
    os.dup2(said, 2)
    watched = _Watched(folder / "run", moment)
    sys.addaudithook(watched)
    code = coopera(arguments)
    if moment is None:
        Path("steps").write_text("\n".join(watched.steps))
    Path("ended").write_text(str(code))
    sys.exit(code)


class _Watched:
    """Hears of all that the process does to files, and kills it at the step that was asked for."""

    def __init__(self, run: Path, moment: Moment | None) -> None:
        self.steps: list[str] = []
        self._run, self._moment = f"{run}/", moment

    def __call__(self, event: str, args: tuple[Any, ...]) -> None:
        if event not in {"open", "os.rename", "os.remove", "os.mkdir"}:
            return
        if event == "open" and not (isinstance(args[2], int) and args[2] & (os.O_WRONLY | os.O_RDWR)):
            return
        target = args[1] if event == "os.rename" else args[0]
        if isinstance(target, str | Path) and (path := os.path.abspath(target)).startswith(self._run):
            step = f"{event} {re.sub(r'[.][0-9]+[.]', '.N.', path[len(self._run) :])}"
            self.steps.append(step)
            if self._moment and step == self._moment.step and self.steps.count(step) == self._moment.nth:
                os.kill(os.getpid(), signal.SIGKILL)
