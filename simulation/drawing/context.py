"""The process's one OpenGL context, on a thread of its own.

Contexts belong to threads, and homes are used from many; and neither outlives a fork.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal, TypeVar

from coopera.core.errors import ConfigError

_T = TypeVar("_T")
Renderer = Literal["auto", "gl", "tiny", "egl"]
"""What draws pictures: our own with OpenGL, pybullet's own with OpenGL ("egl"), or pybullet's that needs nothing.

Their pixels differ. "auto" is "gl" where OpenGL is to be had, else "tiny"; gl and egl need the system's libEGL.
"""
_PACKAGES = "on Debian and Ubuntu: apt-get install libegl1 libgl1-mesa-dri"
_FORKED = "this process was forked from one that draws with OpenGL; start it by spawn"
_LEAST = 430
_one_at_a_time = threading.Lock()


class _Drawer:
    """A thread that owns a context."""

    def __init__(self, *, forked: bool) -> None:
        self.process = os.getpid()
        self.pool = ThreadPoolExecutor(1, thread_name_prefix="drawing")
        found: tuple[Any, str] = (None, _FORKED) if forked else self.pool.submit(_context).result()
        self.context, self.problem = found


_drawers: list[_Drawer] = []


def _context() -> tuple[Any, str]:
    """A context, or else why there is none."""
    try:
        import moderngl  # noqa: PLC0415 - it is looked for here only

        os.environ.setdefault("EGL_LOG_LEVEL", "fatal")  # what is wrong is said in a sentence
        make: Any = moderngl.create_context
        context: Any = make(standalone=True, backend="egl", require=_LEAST)
    except ImportError as err:
        return None, f"moderngl cannot be imported ({err}): pip install moderngl"
    except Exception as err:  # noqa: BLE001 - moderngl raises bare Exception
        return None, f"EGL does not start ({str(err).strip() or type(err).__name__}); {_PACKAGES}"
    return context, ""


def _drawer() -> _Drawer:
    with _one_at_a_time:
        if not _drawers or _drawers[0].process != os.getpid():
            _drawers[:] = [_Drawer(forked=bool(_drawers))]
        return _drawers[0]


def problem() -> str:
    """Why nothing can be drawn with OpenGL here, and what would help; empty where it can."""
    return _drawer().problem


def chosen(name: Renderer) -> Renderer:
    """The renderer that a name stands for on this machine.

    Raises:
        ConfigError: If ours is asked for and is not to be had here; says which package would help.
    """
    why = problem() if name in ("auto", "gl") else ""
    if name == "gl" and why:
        raise ConfigError(f"renderer: gl is not to be had on this machine: {why}; or choose tiny.")
    if name == "auto":
        return "tiny" if why else "gl"
    return name


def on_context(work: Callable[[Any], _T]) -> _T:
    """Do something with the context, on its thread.

    Raises:
        ConfigError: If there is none.
    """
    drawer = _drawer()
    if drawer.context is None:
        raise ConfigError(f"renderer: gl is not to be had on this machine: {drawer.problem}.")
    return drawer.pool.submit(work, drawer.context).result()
