from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from coopera.core.lazy import made_once


def test_threads_that_ask_at_once_get_one_and_the_same_thing() -> None:
    threads, made = 4, []
    together = threading.Barrier(threads)

    @made_once()
    def thing(name: str) -> object:
        """Make a thing."""
        made.append(name)
        threading.Event().wait(0.05)
        return object()

    def ask(_: int) -> object:
        together.wait(20)
        return thing("engine")

    with ThreadPoolExecutor(threads) as pool:
        assert len(set(pool.map(ask, range(threads)))) == 1
    assert made == ["engine"]
    assert thing.__doc__ == "Make a thing."


def test_only_the_last_few_things_are_kept() -> None:
    @made_once(1)
    def thing(name: str) -> object:
        return object()

    first = thing("a")
    assert thing("a") is first
    thing("b")
    assert thing("a") is not first
    again = thing("a")
    thing.forget()
    assert thing("a") is not again
