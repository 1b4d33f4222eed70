"""pybullet, imported without the line that it prints to standard error: that belongs to the command that runs us."""

from __future__ import annotations

import os
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any

_SHIPPED = "pybullet_data/"


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


def load_urdf(path: Path, client: int) -> int:
    """Load a body with a fixed base; a mesh named "pybullet_data/…" comes from what ships with pybullet."""
    text = path.read_text(encoding="utf-8")
    if _SHIPPED not in text:
        return int(pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client))
    data = str(import_module("pybullet_data").getDataPath())
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / path.name
        text = text.replace('filename="', f'filename="{path.parent}/').replace(f"{path.parent}/{_SHIPPED}", f"{data}/")
        whole.write_text(text, encoding="utf-8")
        return int(pybullet.loadURDF(str(whole), useFixedBase=True, physicsClientId=client))
