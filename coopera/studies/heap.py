"""The process's heap: a run lives in many short threads, each of which would leave holes in a heap of its own."""

from __future__ import annotations

import ctypes

_ARENA_MAX = -8  # M_ARENA_MAX of glibc's malloc.h


def one_arena() -> bool:
    """Have all threads that begin from now on share one heap; return whether this system's C library can.

    With glibc's default of eight heaps a core, the memory of a long run grows by holes: it was half of all growth.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    return mallopt is not None and bool(mallopt(_ARENA_MAX, 1))
