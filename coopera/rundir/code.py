"""The fingerprint of the code that runs, so that results tell by what they were made."""

from __future__ import annotations

import functools
import hashlib
import os
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]
_DECIDES = (".py", ".md", ".yaml")


@functools.cache
def code_fingerprint() -> str:
    """SHA-256 of the package's modules, prompts and knowledge files, the same wherever it is installed."""
    found = hashlib.sha256()
    for folder, folders, names in os.walk(_PACKAGE, followlinks=True):  # in a clone the rooms are links
        folders.sort()
        for name in sorted(names):
            if name.endswith(_DECIDES):
                path = Path(folder, name)
                found.update(f"{path.relative_to(_PACKAGE).as_posix()}\n".encode())
                found.update(hashlib.sha256(path.read_bytes()).digest())
    return found.hexdigest()
