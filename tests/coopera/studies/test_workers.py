from __future__ import annotations

import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import threading
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from coopera.benchmark.cluster import work_on_ray
from coopera.core.errors import ConfigError, RunError
from coopera.studies.workers import Done, Queue, start, stop_all, work_through


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


def first_kill_the_idle(errand: Errand) -> None:
    """An errand with deaths first kills the process that has none, and waits until that is dead."""
    if errand.deaths:
        [idle] = [other for other in _siblings() if other != os.getpid()]
        os.kill(idle, signal.SIGKILL)
        while _state(idle) != "Z":
            os.sched_yield()
    go(Errand(errand.name, errand.folder, errand.after))


def _siblings() -> list[int]:
    """The worker processes of this one's parent."""
    every = [int(path.name) for path in Path("/proc").iterdir() if path.name.isdigit()]
    return [one for one in every if _fields(one)[1:2] == [str(os.getppid())] and b"spawn_main" in _command(one)]


def _fields(process: int) -> list[str]:
    """State, parent and so on of a process; nothing of one that is gone."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def _state(process: int) -> str:
    return (_fields(process) or ["Z"])[0]


def _command(process: int) -> bytes:
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return b""


def test_a_worker_that_is_killed_while_it_has_nothing_to_do_is_replaced(tmp_path: Path) -> None:
    folder = str(tmp_path)
    jobs = [Errand("a", folder, deaths=1), Errand("b", folder, after="a"), Errand("c", folder, after="a")]
    ended = {end.job.name: end.error for end in work_through(jobs, first_kill_the_idle, workers=2)}
    assert ended == {"a": None, "b": None, "c": None}


def stumble(errand: Errand) -> None:
    raise TypeError("nobody foresaw this")


def test_a_job_that_fails_unexpectedly_is_told_in_a_sentence_with_its_log_and_not_done_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path))
    [end] = work_through([Errand("a")], stumble)
    [log] = (tmp_path / "crashes").iterdir()
    assert end.error
    assert "TypeError: nobody foresaw this. Details: " + str(log) in end.error
    assert "worker a" in log.read_text()


class FakeRay:
    """A cluster whose tasks run at once, and whose process dies with some of them, however often they are tried."""

    class exceptions:  # noqa: N801 - as Ray has it
        class RayError(Exception): ...

        class WorkerCrashedError(RayError): ...

        class LocalRayletDiedError(RayError): ...

    def __init__(self, dying: str = "", gone: bool = False, raylet_dies: bool = False) -> None:
        self.dying, self.gone, self.raylet_dies = dying, gone, raylet_dies
        self.open, self.given = False, dict[str, object]()

    def init(self, **given: object) -> None:
        self.open, self.given = True, given

    def shutdown(self) -> None:
        self.open = False

    def cluster_resources(self) -> dict[str, float]:
        return {"CPU": 2.0}

    def remote(self, **given: object) -> Any:
        def decorated(function: Any) -> Any:
            def task(work: Any, job: Errand) -> tuple[Any, ...]:
                return (None, job.name) if job.name == self.dying else (function(work, job), job.name)

            return SimpleNamespace(remote=task)

        return decorated

    def wait(self, tasks: list[Any]) -> tuple[list[Any], list[Any]]:
        if self.gone:
            raise self.exceptions.RayError("the head is gone")
        return tasks[:1], tasks[1:]

    def get(self, task: tuple[Any, str]) -> Any:
        if self.raylet_dies:
            raise self.exceptions.LocalRayletDiedError("SIGKILL")
        if task[1] == self.dying:
            raise self.exceptions.WorkerCrashedError("SIGKILL")
        return task[0]


def test_a_killed_worker_of_a_cluster_costs_its_job_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ray = FakeRay(dying="doomed")
    monkeypatch.setitem(sys.modules, "ray", ray)
    folder = str(tmp_path)
    jobs = [Errand("doomed", folder), Errand("b", folder), Errand("late", folder, after="doomed")]
    ended = {end.job.name: end.error for end in work_on_ray(jobs, go, address="local")}
    died = "its process died 3 times (WorkerCrashedError)"
    assert ended == {"b": None, "doomed": died, "late": f"doomed failed: {died}"}
    assert not ray.open


def test_a_local_cluster_is_one_of_its_own_even_where_another_runs_already(monkeypatch: pytest.MonkeyPatch) -> None:
    ray = FakeRay()
    monkeypatch.setitem(sys.modules, "ray", ray)
    assert not list(work_on_ray([], go, address="local", workers=3))
    assert ray.given["address"] == "local"  # without an address, Ray joins the one that runs
    assert ray.given["num_cpus"] == 3


@pytest.mark.parametrize("ray", [FakeRay(gone=True), FakeRay(raylet_dies=True)], ids=["head", "raylet"])
def test_a_cluster_that_goes_away_is_one_sentence(ray: FakeRay, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", ray)
    with pytest.raises(RunError, match="--ray local: the cluster is gone"):
        list(work_on_ray([Errand("a")], stumble, address="local"))
    assert not ray.open


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


def note_cores(errand: Errand) -> None:
    """An errand that writes down which cores its process may use."""
    cores = ",".join(map(str, sorted(os.sched_getaffinity(0))))
    Path(errand.folder, f"{os.getpid()}.cores").write_text(cores)


@pytest.mark.skipif(len(getattr(os, "sched_getaffinity", lambda _: ())(0)) < 2, reason="needs two cores")
def test_each_of_several_workers_keeps_to_cores_of_its_own_and_a_single_one_has_all(tmp_path: Path) -> None:
    mine = {str(core) for core in os.sched_getaffinity(0)}
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        folder.mkdir()
        assert not any(
            end.error
            for end in work_through([Errand(name, str(folder)) for name in "abcd"], note_cores, workers=workers)
        )
        shares = [set(file.read_text().split(",")) for file in folder.glob("*.cores")]
        assert sum(map(len, shares)) == len(set().union(*shares))
        assert set().union(*shares) <= mine
        if workers == 1:
            assert shares == [mine]


def be_interrupted(pipe: Connection) -> None:
    signal.raise_signal(signal.SIGINT)
    pipe.send("still here")


def test_a_process_leaves_ctrl_c_to_the_one_that_started_it() -> None:
    process, pipe = start(multiprocessing.get_context("spawn"), be_interrupted, 0, 1)
    assert pipe.recv() == "still here"
    process.join()
    assert process.exitcode == 0


def refuse_to_end(pipe: Connection) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    pipe.send("at work")
    threading.Event().wait(600)


def test_a_process_that_does_not_end_when_it_is_told_to_is_killed() -> None:
    process, pipe = start(multiprocessing.get_context("spawn"), refuse_to_end, 0, 1)
    assert pipe.recv() == "at work"
    stop_all([process])
    process.join(60)
    assert process.exitcode == -signal.SIGKILL
