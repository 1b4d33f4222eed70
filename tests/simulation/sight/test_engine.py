from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from coopera.simulation.sight.engine import quiet


def test_after_threads_have_been_quiet_at_the_same_time_the_process_is_heard_again(
    capfd: pytest.CaptureFixture[str],
) -> None:
    together = threading.Barrier(4)

    def be_quiet(_: int) -> None:
        together.wait(20)
        for _ in range(20):
            with quiet():
                os.write(1, b"the engine\n")

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(be_quiet, range(4)))
    os.write(1, b"the command")
    assert capfd.readouterr().out == "the command"
