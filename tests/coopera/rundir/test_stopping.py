from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from coopera.rundir.stopping import ends_soon

ROOT = Path(__file__).parents[3]
PROGRAM = """
import signal, sys, threading
from coopera.rundir.stopping import ends_soon

def farewell():
    print("it goes on later", file=sys.stderr, flush=True)
    {reader}

def work():
    threading.Event().wait({seconds})

with ends_soon(130, farewell):
    thread = threading.Thread(target=work)
    thread.start()
    try:
        print("at work", flush=True)
        signal.pause()
    except KeyboardInterrupt:
        thread.join()
print("ended by itself", flush=True)
"""
FOR_EVER = 600


def ended(number: signal.Signals, *, seconds: float, reader: str = "") -> tuple[int, str, str]:
    """Exit code, output and errors of a program that gets a signal while its work takes so many seconds."""
    program = PROGRAM.format(seconds=seconds, reader=reader)
    if number == signal.SIGTERM:
        program = f"import signal; signal.signal(signal.SIGTERM, signal.default_int_handler){program}"
    with subprocess.Popen(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "at work\n"
        running.send_signal(number)
        out, err = running.communicate(timeout=60)
    return running.returncode, out, err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_program_whose_work_cannot_be_interrupted_ends_all_the_same(number: signal.Signals) -> None:
    assert ended(number, seconds=FOR_EVER) == (130, "", "it goes on later\n")


def test_nobody_waits_for_a_farewell_that_nobody_reads() -> None:
    code, _, _ = ended(signal.SIGINT, seconds=FOR_EVER, reader=f"threading.Event().wait({FOR_EVER})")
    assert code == 130


def test_work_that_ends_by_itself_is_waited_for() -> None:
    assert ended(signal.SIGINT, seconds=0.0) == (0, "ended by itself\n", "")


def test_in_another_thread_nothing_is_heard_and_signals_are_as_before() -> None:
    before = signal.set_wakeup_fd(-1)
    signal.set_wakeup_fd(before)

    def within() -> None:
        with ends_soon(130, lambda: None):
            pass

    thread = threading.Thread(target=within)
    thread.start()
    thread.join()
    within()
    assert signal.set_wakeup_fd(before) == before
