"""pybullet, imported without the line that it prints to standard error: that belongs to the command that runs us."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import Any


def _quietly(name: str) -> Any:
    """Import a module while the process's standard error leads nowhere."""
    sys.stderr.flush()
    kept, sink = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, 2)
        return import_module(name)
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(sink)


pybullet: Any = sys.modules.get("pybullet") or _quietly("pybullet")
