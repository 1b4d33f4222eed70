"""The process's heap: a run lives for weeks, in short threads and with large arrays that come and go each evening."""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count

from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

from coopera.core.lazy import NEW_OBJECTS

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8  # of glibc's malloc.h
_LARGE = 2**20
"""Bytes from which on memory is the system's again once it is free."""
_SCRATCH = 16 * _LARGE
"""What OpenBLAS may have used of the room that it keeps for itself; it keeps as much or more on every processor."""
_DONTNEED = 4  # of Linux's mman.h
_EVENINGS = 64
"""After so many, all of what is there is looked through once more, which takes 0.1 s."""
_RUNS = 5
"""After so many runs of a process what they left is looked for, which takes a third of a second."""
_evenings = 0
"""How many there were since a run began."""
_ended = count(1)


def rare_collections() -> None:
    """Look for cycles that are garbage every 10,000 new objects, not every 700.

    A tenth of a process's start went into looking, and a quarter of what LangGraph and the memory take in a long life.
    """
    gc.set_threshold(NEW_OBJECTS)


def steady_heap() -> bool:
    """Keep the memory of a long run from growing by holes, and look for garbage rarely; return if the system can.

    All threads that begin from now on share one heap: with glibc's default of eight heaps a core, holes were half of
    all growth. Large arrays lie outside the heap: by default glibc takes them into it, up to 32 MB each, after the
    first of such a size was freed.
    """
    rare_collections()
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    settings = ((_ARENA_MAX, 1), (_MMAP_THRESHOLD, _LARGE), (_TRIM_THRESHOLD, 8 * _LARGE))
    return mallopt is not None and all(mallopt(name, value) for name, value in settings)


def give_back() -> None:
    """After an evening: let go of what only refers to itself, and give the system the pages that are free.

    Left to Python, such garbage gathers for days, among what stays, since a run holds so much. What is there after an
    evening (libraries, weights, homes, what was learned) is therefore no longer looked through, until the run ends
    (`lasting`) or all is looked through once more. So it is to be called between the days: what the next one works with
    by then would be counted among what stays, and is garbage by its evening.
    """
    global _evenings
    if _evenings:  # on the first, all would be looked through, and there is little to find
        if _evenings % _EVENINGS == 0:
            gc.unfreeze()
        gc.collect()
    gc.freeze()
    _evenings += 1
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
    if sys.platform == "linux":
        _give_back_scratch()


def _give_back_scratch() -> None:
    """Give the system the pages in which linear algebra lays out its matrices: 11 MB after a long life's evening.

    OpenBLAS, of which numpy and scipy have one each, keeps all that it ever used of them. Here it is asked for that
    room as its own functions ask for it, so that none of them is in it meanwhile.
    """
    madvise = ctypes.CDLL(None).madvise
    madvise.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    for library in ThreadpoolController().lib_controllers:
        blas = ctypes.CDLL(library.filepath)
        if not hasattr(blas, "blas_memory_alloc"):
            continue
        blas.blas_memory_alloc.restype, blas.blas_memory_free.argtypes = ctypes.c_void_p, (ctypes.c_void_p,)
        room = blas.blas_memory_alloc(1)
        madvise(room, _SCRATCH, _DONTNEED)
        blas.blas_memory_free(room)


@contextmanager
def lasting() -> Iterator[None]:
    """A run: when it ends, Python looks through everything again."""
    global _evenings
    try:
        yield
    finally:
        gc.unfreeze()
        _evenings = 0


def clear_up() -> None:
    """After a run, once its homes and memories are closed: let go, every few runs, of what refers only to itself.

    A run leaves some 20 MB of it, which Python would look for only once as much again as all libraries is new.
    """
    if next(_ended) % _RUNS == 0:
        gc.collect()
