"""The process's one OpenGL context, on a thread of its own: contexts belong to threads, and homes are used from many."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from coopera.core.errors import ConfigError

_T = TypeVar("_T")
_PACKAGES = "on Debian and Ubuntu: apt-get install libegl1 libgl1-mesa-dri"
_LEAST = 430


class _Drawer:
    """A thread that owns a context."""

    def __init__(self) -> None:
        self.process = os.getpid()
        self.pool = ThreadPoolExecutor(1, thread_name_prefix="drawing")
        self.context, self.problem = self.pool.submit(_context).result()


_drawers: list[_Drawer] = []


def _context() -> tuple[Any, str]:
    """A context, or else why there is none."""
    try:
        import moderngl  # noqa: PLC0415 - it is looked for here only

        context = moderngl.create_context(standalone=True, backend="egl", require=_LEAST)
    except ImportError as err:
        return None, f"moderngl cannot be imported ({err}): pip install moderngl"
    except Exception as err:  # noqa: BLE001 - moderngl raises bare Exception
        return None, f"EGL does not start ({str(err).strip() or type(err).__name__}); {_PACKAGES}"
    return context, ""


def _drawer() -> _Drawer:
    if not _drawers or _drawers[0].process != os.getpid():  # threads do not outlive a fork
        _drawers[:] = [_Drawer()]
    return _drawers[0]


def problem() -> str:
    """Why nothing can be drawn with OpenGL here, and what would help; empty where it can."""
    return _drawer().problem


def on_context(work: Callable[[Any], _T]) -> _T:
    """Do something with the context, on its thread.

    Raises:
        ConfigError: If there is none.
    """
    drawer = _drawer()
    if drawer.context is None:
        raise ConfigError(f"renderer: gl is not to be had on this machine: {drawer.problem}.")
    return drawer.pool.submit(work, drawer.context).result()
