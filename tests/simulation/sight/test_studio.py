from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from contextlib import ExitStack
from multiprocessing import Pipe
from pathlib import Path

import pytest

from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT
from coopera.simulation.drawing.context import problem
from coopera.simulation.people.appearance import Appearance, appearance_of
from coopera.simulation.sight import darkroom, studio
from coopera.simulation.world import World
from tests.fakes import MARA
from tests.simulation.flat import bring, flat, move

pytestmark = pytest.mark.skipif(bool(problem()), reason=f"nothing can be drawn with OpenGL here: {problem()}")
SITS = move("sofa_1", "book", "sit and read")
SCRIPT = """
import os, sys
from pathlib import Path
from coopera.core.household import HUMAN
from coopera.simulation.sight import studio
from coopera.simulation.world import World
from tests.simulation.flat import flat, move

world = World(flat(), frame_size=(96, 72), renderer="gl")
world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True)
world.frames(2, Path(sys.argv[1]), wait=False)
world.frames_due()()
print(studio._processes[0]._first.pid, flush=True)
if sys.argv[2] == "dies":
    os.kill(os.getpid(), 9)
world.close()
"""


def filmed(folder: Path) -> World:
    """A home of which pictures are being taken."""
    world = World(flat(), frame_size=(96, 72), renderer="gl")
    assert world.perform(HUMAN, SITS, record=True).ok
    world.frames(2, folder, wait=False)
    return world


def wait_for(world: World) -> None:
    if due := world.frames_due():
        due()


def ends(pid: int) -> bool:
    """Whether a process ends within some seconds."""
    try:
        watched = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([watched], [], [], 20)[0])
    finally:
        os.close(watched)


def test_the_homes_of_a_process_share_those_that_take_pictures_which_end_with_the_last_of_them(tmp_path: Path) -> None:
    first, second = filmed(tmp_path / "first"), filmed(tmp_path / "second")
    process = studio._processes[0]._first
    first.close()
    wait_for(second)
    assert len(list((tmp_path / "second").iterdir())) == 4
    assert process.poll() is None
    second.close()
    assert process.poll() == 0


def test_processes_that_were_got_ready_for_somebody_take_the_same_pictures_and_end_without_a_home(
    tmp_path: Path,
) -> None:
    looks = dict[str, bytes]()
    for name in ("ready", "not ready"):
        with ExitStack() as stack:
            if name == "ready":
                stack.enter_context(studio.ready("gl", [MARA]))
                process = studio._processes[0]._first
            with World(flat(), frame_size=(96, 72), renderer="gl") as world:
                world.inhabit(HUMAN, MARA)
                assert world.perform(HUMAN, SITS, record=True).ok
                world.frames(1, tmp_path / name, wait=False)
                wait_for(world)
        looks[name] = (tmp_path / name / "human-0.webp").read_bytes()
    assert looks["ready"] == looks["not ready"]
    with studio.ready("gl", [MARA]):
        assert studio._processes[0]._first is not process
        process = studio._processes[0]._first
    assert process.poll() is not None


def test_people_are_made_as_long_as_nothing_else_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs = Pipe()
    made = list[str]()

    def make(looks: Appearance, outfit: str) -> None:
        made.append(outfit)
        if len(made) == 2:
            ours.send(None)

    monkeypatch.setattr(darkroom, "skinned", make)
    ours.send(studio.Expected((appearance_of(MARA.profile, MARA.id),)))
    with ours, theirs:
        darkroom._make_people(theirs)
        assert made == ["day", "bath"]
        assert theirs.recv() is None, "what is asked for is left for who does it"


def forks(pid: int) -> list[int]:
    """The children of a process."""
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@pytest.mark.parametrize("which", ["the first", "its fork"])
def test_where_a_process_is_killed_who_waits_is_told_and_the_next_home_has_others(tmp_path: Path, which: str) -> None:
    world = filmed(tmp_path / "lost")
    world.frames(2, tmp_path / "lost", wait=False)
    wait_for(world)  # by now there is a fork
    for _ in range(20):
        world.frames(4, tmp_path / "lost", wait=False)
    first = studio._processes[0]._first.pid
    all_of_them = [first, *forks(first)]
    os.kill(all_of_them[0 if which == "the first" else -1], signal.SIGKILL)
    with pytest.raises(SimulationError, match="process that draws pictures ended"):
        wait_for(world)
    world.close()
    assert all(ends(pid) for pid in all_of_them)
    with filmed(tmp_path / "again") as again:
        wait_for(again)
    assert len(list((tmp_path / "again").iterdir())) == 4


def test_pictures_that_cannot_be_written_are_a_sentence_for_who_waits_later(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with filmed(tmp_path / "file" / "frames") as world, pytest.raises(SimulationError, match="cannot be written"):
        wait_for(world)


def test_what_waits_for_pictures_of_a_home_that_is_closed_is_told(tmp_path: Path) -> None:
    with filmed(tmp_path) as world:
        for _ in range(20):
            world.frames(4, tmp_path, wait=False)
        due = world.frames_due()
    assert due is not None
    with pytest.raises(Exception, match=r"^$"):  # cancelled
        due()


@pytest.mark.parametrize("end", ["closes", "dies"])
def test_a_script_may_take_pictures_anywhere_and_leaves_no_process_however_it_ends(tmp_path: Path, end: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, tmp_path / "frames", end], capture_output=True, text=True, cwd=os.getcwd()
    )
    assert len(list((tmp_path / "frames").iterdir())) == 4, done.stderr
    assert ends(int(done.stdout))


@pytest.mark.parametrize("body", ["fetch", "husky_panda"])
def test_a_robot_that_has_reached_for_things_can_be_filmed_beside(tmp_path: Path, body: str) -> None:
    with World(flat(), frame_size=(96, 72), renderer="gl", robot=body) as world:
        assert world.perform(ROBOT, bring("mug"), record=True).ok
        world.frames(1, tmp_path, "help", wait=False)
        wait_for(world)
        assert [path.name for path in tmp_path.iterdir()] == ["help-0.webp"]
