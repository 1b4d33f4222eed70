"""pybullet, imported without its line on standard error: standard error belongs to the running command."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes.util import find_library
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from coopera.core.errors import ConfigError
from coopera.simulation.bodies.urdf import Urdf
from coopera.simulation.drawing.context import Renderer

_QUIET = threading.RLock()


@contextmanager
def quiet() -> Iterator[None]:
    """Let the process's standard output and error lead nowhere: the engine and its EGL plugin write to both.

    One thread at a time: another would take the way into nowhere for the one to go back to.
    """
    with _QUIET:
        sys.stdout.flush()
        sys.stderr.flush()
        kept, sink = (os.dup(1), os.dup(2)), os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(sink, 1)
            os.dup2(sink, 2)
            yield
        finally:
            ctypes.CDLL(None).fflush(None)  # what C has buffered goes nowhere, too
            for number, copy in enumerate(kept, 1):
                os.dup2(copy, number)
                os.close(copy)
            os.close(sink)


def _quietly(name: str) -> Any:
    with quiet():
        return import_module(name)


pybullet: Any = sys.modules.get("pybullet") or _quietly("pybullet")


def load_urdf(urdf: Urdf, client: int, *, drawn: bool = True) -> int:
    """Load a body with a fixed base.

    Raises:
        ConfigError: If the engine cannot make anything of the description.
    """
    flags = 0 if drawn else pybullet.URDF_IGNORE_VISUAL_SHAPES
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / urdf.path.name
        whole.write_text(urdf.text, encoding="utf-8")
        try:
            return int(pybullet.loadURDF(str(whole), useFixedBase=True, physicsClientId=client, flags=flags))
        except pybullet.error as err:
            raise ConfigError(f"{urdf.path}: pybullet cannot load this URDF; what it prints says why.") from err


def start_renderer(name: Renderer, client: int) -> int:
    """Make a client draw with a renderer, and return its number for pictures.

    pybullet's EGL plugin, once loaded, draws all pictures of its process: so a process keeps to one renderer.

    Raises:
        ConfigError: If EGL is asked for and is not to be had here.
    """
    if name in ("tiny", "gl"):
        return int(pybullet.ER_TINY_RENDERER)
    found = find_spec("eglRenderer")
    plugin = -1
    if found is not None and found.origin is not None and find_library("EGL") is not None:
        with quiet():
            plugin = pybullet.loadPlugin(found.origin, "_eglRendererPlugin", physicsClientId=client)
    if plugin < 0:
        raise ConfigError("renderer: egl is not to be had on this machine (it needs libEGL); choose tiny.")
    return int(pybullet.ER_BULLET_HARDWARE_OPENGL)
