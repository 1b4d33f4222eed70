"""Runs that nobody else may read: while one is written, this process makes files of mode 0600 and folders of 0700."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_OWNER_ALONE = 0o077
_writing = threading.Lock()
_before: list[int] = []
"""The process's own masks, one for each that is in force; only the first is another than ours."""


@contextmanager
def only_mine(private: bool = True) -> Iterator[None]:
    """Make files for this user alone; runs beside it, which share the process's mask, are then no more open than it."""
    if not private:
        yield
        return
    with _writing:
        _before.append(os.umask(_OWNER_ALONE))
    try:
        yield
    finally:
        with _writing:
            mask = _before.pop()
            if not _before:
                os.umask(mask)
