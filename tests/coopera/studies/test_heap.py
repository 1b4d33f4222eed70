from __future__ import annotations

import gc
import os
import subprocess
import sys
import threading
import weakref
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

from coopera import Config, run_study
from coopera.studies.heap import clear_up, give_back, lasting, steady_heap

HEAPS = """
import ctypes, re, tempfile, threading
from coopera.studies.heap import steady_heap
assert steady_heap()
libc = ctypes.CDLL(None)
libc.malloc.restype = libc.fopen.restype = ctypes.c_void_p
libc.malloc_info.argtypes = (ctypes.c_int, ctypes.c_void_p)
libc.fclose.argtypes = (ctypes.c_void_p,)
ready = threading.Barrier(9)

def work():
    libc.malloc(ctypes.c_size_t(1000))
    ready.wait()
    ready.wait()

for _ in range(8):
    threading.Thread(target=work).start()
ready.wait()
with tempfile.NamedTemporaryFile() as told:
    file = libc.fopen(told.name.encode(), b"w")
    libc.malloc_info(0, file)
    libc.fclose(file)
    print(len(re.findall("<heap nr", told.read().decode())))
ready.wait()
"""


LARGE = """
import ctypes
from coopera.studies.heap import steady_heap
assert steady_heap()
libc = ctypes.CDLL(None)
libc.malloc.restype = ctypes.c_void_p
libc.free.argtypes = (ctypes.c_void_p,)
libc.sbrk.restype = ctypes.c_void_p
libc.free(libc.malloc(ctypes.c_size_t(24 << 20)))
before = libc.sbrk(0)
libc.malloc(ctypes.c_size_t(16 << 20))
print(libc.sbrk(0) - before < 1 << 20)
"""


def test_large_arrays_lie_outside_the_heap_even_after_others_were_freed() -> None:
    if not steady_heap():
        pytest.skip("this C library has no such setting")
    told = subprocess.run([sys.executable, "-c", LARGE], check=True, capture_output=True, text=True)
    assert told.stdout == "True\n"


def test_the_threads_of_a_run_share_one_heap() -> None:
    if not steady_heap():
        pytest.skip("this C library has no such setting")
    told = subprocess.run([sys.executable, "-c", HEAPS], check=True, capture_output=True, text=True)
    assert told.stdout == "1\n"


HOLES = """
import ctypes
from pathlib import Path
from coopera.studies.heap import give_back, steady_heap
assert steady_heap()
libc = ctypes.CDLL(None)
libc.malloc.restype = libc.memset.restype = ctypes.c_void_p
libc.memset.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_size_t)
libc.free.argtypes = (ctypes.c_void_p,)
size = 100_000
blocks = [libc.memset(libc.malloc(ctypes.c_size_t(size)), 1, size) for _ in range(400)]
last = libc.malloc(ctypes.c_size_t(size))  # the heap cannot end before it
for block in blocks:
    libc.free(block)
held = lambda: next(int(l.split()[1]) for l in Path("/proc/self/status").read_text().splitlines() if "RssAnon" in l)
before = held()
give_back()
print(before - held() > 30_000)
"""


def test_what_is_free_within_the_heap_is_given_back() -> None:
    if not steady_heap() or not sys.platform.startswith("linux"):
        pytest.skip("this C library has no such setting")
    told = subprocess.run([sys.executable, "-c", HOLES], check=True, capture_output=True, text=True)
    assert told.stdout == "True\n"


SCRATCH = """
from pathlib import Path
import numpy as np
from coopera.studies.heap import give_back
held = lambda: next(int(l.split()[1]) for l in Path("/proc/self/status").read_text().splitlines() if "RssAnon" in l)
small, large = np.ones((2, 2)), np.arange(1_440_000.0).reshape(1_200, 1_200)
small @ small
give_back()
before = held()
told = (large @ large).sum()
after = held()
give_back()
print(after - before > 2_000, held() - before < 500, (large @ large).sum() == told)
"""


def test_the_room_in_which_matrices_are_multiplied_is_given_back_and_can_be_used_again() -> None:
    if not sys.platform.startswith("linux") or all(one["internal_api"] != "openblas" for one in threadpool_info()):
        pytest.skip("this is not how linear algebra is done here")
    one = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # as many as an evening uses
    told = subprocess.run([sys.executable, "-c", SCRATCH], check=True, capture_output=True, text=True, env=one)
    assert told.stdout == "True True True\n"


def test_a_run_looks_for_garbage_once_in_ten_thousand_new_objects_and_not_each_moment() -> None:
    before, looked = gc.get_threshold(), []

    def note(phase: str, about: dict[str, int]) -> None:
        looked.append(phase)

    try:
        gc.set_threshold(700, 10, 10)
        steady_heap()
        gc.collect()
        gc.callbacks.append(note)
        held: list[list[int]] = [[] for _ in range(5_000)]
        assert looked == []
        held += [[] for _ in range(20_000)]
        assert "start" in looked
    finally:
        gc.callbacks.remove(note)
        gc.set_threshold(*before)


def test_garbage_goes_with_the_evening_and_the_end_of_a_run_looks_through_everything_again() -> None:
    class Ring:
        pass

    with lasting():
        give_back()
        assert gc.get_freeze_count()
        ring = Ring()
        ring.itself = ring  # type: ignore[attr-defined]
        left = weakref.ref(ring)
        del ring
        give_back()
        assert left() is None
    assert not gc.get_freeze_count()


def test_what_outlives_an_evening_is_not_looked_through_each_evening() -> None:
    with lasting():
        give_back()
        held: list[list[int]] = [[] for _ in range(20_000)]
        give_back()
        assert len(gc.get_objects()) < len(held)


def test_what_becomes_garbage_after_the_evening_that_it_outlived_goes_in_the_end() -> None:
    class Ring:
        pass

    with lasting():
        give_back()
        ring = Ring()
        ring.itself = ring  # type: ignore[attr-defined]
        left = weakref.ref(ring)
        give_back()
        del ring
        for _ in range(100):
            give_back()
        assert left() is None


def test_memory_is_given_back_between_the_days_while_the_work_waits(
    tmp_path: Path, letters: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    at: list[tuple[str, int]] = []

    def look() -> None:
        at.append((threading.current_thread().name, len(list((tmp_path / "run").glob("trace/day-*/evening.json")))))

    monkeypatch.setattr("coopera.studies.study.give_back", look)
    run_study(Config(days=3, hours=1, pictures="none", out=tmp_path / "run", data_dir=letters))
    assert at == [("study", 1), ("study", 2), ("study", 3)]


def test_what_some_runs_of_a_process_left_is_let_go_of_before_the_next_ones() -> None:
    class Run:
        pass

    gc.disable()
    try:
        left = []
        for _ in range(12):
            run = Run()
            run.itself = run  # type: ignore[attr-defined]
            left.append(weakref.ref(run))
            del run
            clear_up()
        still = [one for one in left if one() is not None]
    finally:
        gc.enable()
    assert len(still) < 5
    assert left[0]() is None
