"""Whether a store can be read at all, asked of a process of its own (`coopera.memory.probe`)."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from coopera.core.errors import MemoryStoreError

_PATIENCE = 600.0  # seconds, for a store of a million records


def damage(folder: Path, *, everything: bool = False) -> str | None:
    """Return what is wrong with a store, or None.

    Args:
        folder: The store; the caller holds its lock, and has not opened it.
        everything: Read and check every record, instead of each stream's first and last.

    Raises:
        MemoryStoreError: If there is no answer within ten minutes.
    """
    root = str(Path(__file__).absolute().parents[2])  # what holds coopera/, in a clone and in site-packages
    paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
    command = [sys.executable, "-m", "coopera.memory.probe", str(folder), *(["--all"] if everything else [])]
    try:
        done = subprocess.run(
            command,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired as err:
        raise MemoryStoreError(f"{folder}: the memory store could not be read within {_PATIENCE:.0f} s") from err
    if done.returncode == 0:
        return None
    if done.returncode < 0:
        return f"reading its index ends the process with signal {-done.returncode}"
    return done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"status {done.returncode}"
