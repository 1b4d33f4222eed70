"""The process's heap: a run lives for weeks, in short threads and with large arrays that come and go each evening."""

from __future__ import annotations

import ctypes
import gc

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8  # of glibc's malloc.h
_LARGE = 2**20
"""Bytes from which on memory is the system's again once it is free."""
_NEW_OBJECTS = 10_000


def rare_collections() -> None:
    """Look for cycles that are garbage every 10,000 new objects, not every 700.

    A tenth of a process's start went into looking.
    """
    gc.set_threshold(_NEW_OBJECTS)


def steady_heap() -> bool:
    """Keep the memory of a long run from growing by holes; return whether this system's C library can.

    All threads that begin from now on share one heap: with glibc's default of eight heaps a core, holes were half of
    all growth. Large arrays lie outside the heap: by default glibc takes them into it, up to 32 MB each, after the
    first of such a size was freed.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    settings = ((_ARENA_MAX, 1), (_MMAP_THRESHOLD, _LARGE), (_TRIM_THRESHOLD, 8 * _LARGE))
    return mallopt is not None and all(mallopt(name, value) for name, value in settings)


def give_back() -> None:
    """Give the system the pages that are free within the heap: after an evening, some ten megabytes."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
