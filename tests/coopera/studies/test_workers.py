from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

import pytest

from coopera.benchmark.cluster import work_on_ray
from coopera.core.errors import ConfigError, RunError
from coopera.studies.workers import Done, Queue, work_through


@dataclass(frozen=True)
class Errand:
    name: str
    folder: str = ""
    after: str | None = None
    deaths: int = 0
    """How many processes die of it before it succeeds."""
    fails: bool = False


def go(errand: Errand) -> None:
    folder = Path(errand.folder)
    tries = len(list(folder.glob(f"{errand.name}.try*")))
    (folder / f"{errand.name}.try{tries}").touch()
    if tries < errand.deaths:
        os.kill(os.getpid(), signal.SIGKILL)
    if errand.fails:
        raise RunError("no luck")
    if errand.after:
        assert (folder / errand.after).exists()
    (folder / errand.name).touch()


def test_a_worker_that_is_killed_costs_its_job_and_another_does_it_again(tmp_path: Path) -> None:
    folder = str(tmp_path)
    jobs = [
        Errand("b", folder, after="a"),
        Errand("a", folder, deaths=1),
        Errand("doomed", folder, deaths=9),
        Errand("bad", folder, fails=True),
        Errand("late", folder, after="bad"),
    ]
    ended = {end.job.name: end.error for end in work_through(jobs, go, workers=2)}
    assert ended == {
        "a": None,
        "b": None,
        "doomed": "its process died 3 times (exit code -9)",
        "bad": "no luck",
        "late": "bad failed: no luck",
    }
    assert len(list(tmp_path.glob("doomed.try*"))) == 3
    assert not list(tmp_path.glob("late*"))


PARENT = """
import sys
from tests.coopera.studies.test_workers import Errand, stay
from coopera.studies.workers import work_through
if __name__ == "__main__":
    list(work_through([Errand("stays", sys.argv[1])], stay, workers=1))
"""


def stay(errand: Errand) -> None:
    """Open the pipe of a parent that dies meanwhile, and stay."""
    with (Path(errand.folder) / "pipe").open("w") as told:
        told.write("at work\n")
        told.flush()
        threading.Event().wait(30)
        told.write("outlived its parent\n")


def test_a_worker_at_work_dies_with_its_parent_however_that_dies(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    program = tmp_path / "parent.py"
    program.write_text(PARENT)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    parent = subprocess.Popen([sys.executable, str(program), str(tmp_path)], env=environment)
    with (tmp_path / "pipe").open() as heard:
        assert heard.readline() == "at work\n"
        parent.kill()
        parent.wait()
        assert heard.read() == ""


def test_a_job_waits_for_the_one_before_it_and_not_for_one_that_is_done_already() -> None:
    queue = Queue([Errand("b", after="a"), Errand("a"), Errand("c", after="done before")])
    first = queue.take()
    assert first.name == "a"
    assert queue.take().name == "c"
    assert queue.take() is None
    assert queue.close(first, None) == [Done(first)]
    assert queue.take().name == "b"


def test_a_cluster_that_does_not_answer_is_refused_at_once() -> None:
    pytest.importorskip("ray")
    with socket.create_server(("127.0.0.1", 0)) as server:
        free = server.getsockname()[1]
    with pytest.raises(ConfigError, match=f"--ray 127.0.0.1:{free}: nothing answers there"):
        list(work_on_ray([], go, address=f"127.0.0.1:{free}"))
