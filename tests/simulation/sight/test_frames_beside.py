from __future__ import annotations

import threading
from pathlib import Path

import pytest

from coopera.core.errors import SimulationError
from coopera.core.household import HUMAN, ROBOT
from coopera.simulation.drawing.context import problem
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move

needs_gl = pytest.mark.skipif(bool(problem()), reason=f"nothing can be drawn with OpenGL here: {problem()}")


def pictures_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def lived(world: World, folder: Path, wait: bool) -> dict[str, bytes]:
    """The pictures of an act of a person and one of the robot, the home going on at once."""
    assert world.perform(HUMAN, move("dining_table_1", "bowl", "eat a meal"), record=True).ok
    files = world.frames(3, folder, wait=wait)
    assert world.perform(ROBOT, bring("mug"), record=True).ok
    files += world.frames(2, folder, "help-0", wait=wait)
    assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
    if due := world.frames_due():
        due()
    assert sorted(folder.iterdir()) == sorted(files)
    return pictures_of(folder)


@needs_gl
def test_pictures_are_the_same_whether_the_home_waits_for_them_or_goes_on(tmp_path: Path) -> None:
    found = []
    for wait in (True, False):
        with World(flat(), frame_size=(96, 72), renderer="gl", labels=True) as world:
            found.append(lived(world, tmp_path / str(wait), wait))
    assert len(found[0]) == 8
    assert found[0] == found[1]


@needs_gl
def test_what_is_looked_at_now_is_not_mixed_up_with_pictures_that_are_being_drawn(tmp_path: Path) -> None:
    with World(flat(), frame_size=(96, 72), renderer="gl") as world:
        assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
        before = world.view(ROBOT).colour
        world.frames(4, tmp_path, wait=False)
        assert (world.view(ROBOT).colour == before).all()
        if due := world.frames_due():
            due()
        assert len(pictures_of(tmp_path)) == 8


@pytest.mark.parametrize("renderer", [pytest.param("gl", marks=needs_gl), "tiny"])
def test_pictures_that_cannot_be_written_are_a_sentence_for_who_waits(tmp_path: Path, renderer: str) -> None:
    (tmp_path / "file").write_text("no folder")
    with World(flat(), frame_size=(96, 72), renderer=renderer) as world:
        assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
        with pytest.raises(SimulationError, match="cannot be written"):
            world.frames(1, tmp_path / "file" / "frames")
        assert len(world.frames(1, tmp_path / "frames")) == 2


@needs_gl
def test_a_home_that_is_closed_leaves_no_picture_half_written(tmp_path: Path) -> None:
    with World(flat(), frame_size=(96, 72), renderer="gl") as world:
        assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
        whole = {path.name: path.read_bytes() for path in world.frames(3, tmp_path / "whole")}
        world.frames(3, tmp_path / "left", wait=False)
    written = pictures_of(tmp_path / "left") if (tmp_path / "left").exists() else {}
    assert written == {name: whole[name] for name in written}
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("pictures")]
