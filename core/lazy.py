"""What is heavy waits until it is needed, and is then made once."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache, update_wrapper
from importlib import import_module
from threading import RLock
from typing import Any, Generic, ParamSpec, TypeVar

NEW_OBJECTS = 10_000
"""After so many new objects Python looks for garbage, where that is to be rare; by itself after 700."""

Given = ParamSpec("Given")
Thing = TypeVar("Thing")


def lazy_names(package: str, homes: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return a package's `__getattr__` and `__dir__`: its names load when first used, so an unused room costs nothing.

    In a clone a room can also be imported by its folder's name (`from graphs import build_day_graph`). It then hands
    on the very same objects, and has no modules of its own: those exist once, as `coopera.graphs.…`.

    Args:
        package: Its `__name__`.
        homes: Public name -> the module that defines it.
    """
    module = sys.modules[package]
    if not package.startswith("coopera"):
        module.__path__ = []

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        with _rarely_collecting():
            return getattr(import_module(homes[name]), name)

    def names() -> list[str]:
        return sorted({*vars(module), *homes})

    return load, names


@contextmanager
def _rarely_collecting() -> Iterator[None]:
    """While modules load, whose objects stay, look for garbage rarely: to look took a sixth of their time."""
    before = gc.get_threshold()
    gc.set_threshold(before[0] and max(before[0], NEW_OBJECTS), *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


class Made(Generic[Given, Thing]):
    """A function that makes each thing once, by what it is made of, and keeps the last so many.

    Threads may ask for the same thing at once: one makes it, the others wait. Under `lru_cache` each thread would make
    its own. Studies start together, and weights or a server's gate must exist only once.
    """

    def __init__(self, make: Callable[Given, Thing], most: int | None) -> None:
        """Wrap what makes a thing; `most` of them are kept, or all."""
        update_wrapper(self, make)
        self._kept, self._lock = lru_cache(maxsize=most)(make), RLock()

    def __call__(self, *args: Given.args, **kwargs: Given.kwargs) -> Thing:
        """Return the thing, made now if need be."""
        with self._lock:
            return self._kept(*args, **kwargs)  # type: ignore[arg-type]

    def forget(self) -> None:
        """Let go of everything made so far."""
        self._kept.cache_clear()


def made_once(most: int | None = None) -> Callable[[Callable[Given, Thing]], Made[Given, Thing]]:
    """Return the decorator for `Made`."""
    return lambda make: Made(make, most)
