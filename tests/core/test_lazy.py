from __future__ import annotations

import gc
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from coopera.core.lazy import lazy_names, made_once


@pytest.fixture
def thresholds() -> Iterator[None]:
    """Python's thresholds, as they were before."""
    before = gc.get_threshold()
    yield
    gc.set_threshold(*before)


@pytest.mark.usefixtures("thresholds")
@pytest.mark.parametrize(("given", "meanwhile"), [(700, 10_000), (50_000, 50_000), (0, 0)])
def test_garbage_is_looked_for_rarely_while_a_name_loads_and_as_before_afterwards(
    given: int, meanwhile: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "heavy_of_lazy.py").write_text("import gc\nthreshold = gc.get_threshold()[0]\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "heavy_of_lazy", raising=False)
    load, _ = lazy_names("coopera", {"threshold": "heavy_of_lazy"})
    gc.set_threshold(given, 11, 12)
    assert load("threshold") == meanwhile
    assert gc.get_threshold() == (given, 11, 12)
    with pytest.raises(AttributeError):
        load("nobody")


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
