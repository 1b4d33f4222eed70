"""The calls of OpenGL that take long, without the interpreter's lock, which moderngl holds, so that others wait.

By `ctypes`, from the library that moderngl has loaded already. Where that cannot be, moderngl's own calls serve.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import lru_cache
from typing import Any

_TRIANGLES, _UNSIGNED_INT, _INDIRECT = 0x0004, 0x1405, 0x8F3F
_ORDER = 20  # bytes


@lru_cache(maxsize=16)
def _call(name: str, *takes: Any) -> Callable[..., None] | None:
    """A function of OpenGL by its name; None where it is not to be had."""
    try:
        find = ctypes.CDLL("libEGL.so.1").eglGetProcAddress
    except (OSError, AttributeError):
        return None
    find.restype, find.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
    address = find(name.encode())
    return ctypes.CFUNCTYPE(None, *takes)(address) if address else None


def finish(context: Any) -> None:
    """Wait until all that was asked for is drawn."""
    (_call("glFinish") or context.finish)()


def render_picture(array: Any) -> None:
    """Draw the one triangle that covers a picture; Mesa waits here for what the picture is made of."""
    number = ctypes.c_uint
    use, bind = _call("glUseProgram", number), _call("glBindVertexArray", number)
    draw = _call("glDrawArrays", number, ctypes.c_int, ctypes.c_int)
    if use is None or bind is None or draw is None:
        array.render(vertices=3)
        return
    use(array.program.glo)
    bind(array.glo)
    draw(_TRIANGLES, 0, 3)


def render(array: Any, orders: Any) -> None:
    """Draw a vertex array by orders in a buffer, as moderngl's `render_indirect` does."""
    number = ctypes.c_uint
    use, bind = _call("glUseProgram", number), _call("glBindVertexArray", number)
    take = _call("glBindBuffer", number, number)
    draw = _call("glMultiDrawElementsIndirect", number, number, ctypes.c_void_p, ctypes.c_int, ctypes.c_int)
    if use is None or bind is None or take is None or draw is None:
        array.render_indirect(orders)
        return
    use(array.program.glo)
    bind(array.glo)
    take(_INDIRECT, orders.glo)
    draw(_TRIANGLES, _UNSIGNED_INT, None, orders.size // _ORDER, _ORDER)
