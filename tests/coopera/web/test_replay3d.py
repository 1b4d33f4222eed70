"""A day in 3D: everybody is where the trace has them, walks instead of jumping, and the page is one file that moves."""

from __future__ import annotations

import io
import math
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from coopera import Config, RunDir, run_study
from coopera.core.errors import ConfigError, RunError
from coopera.people.shipped import find
from coopera.simulation import load_scene
from coopera.simulation.bodies.robot import load_robot, usable_robots
from coopera.simulation.people.weights import PARTS
from coopera.web.replay3d import solids
from coopera.web.replay3d.film import write_film
from coopera.web.replay3d.installed import need_viser
from coopera.web.replay3d.page import _frames, write_page
from coopera.web.replay3d.poses import GONE, Frame, Pose, acts_of
from tests.coopera.conftest import Said
from tests.coopera.web.browser import Watched, browsing, needs_browser


def _viser_problem() -> str:
    try:
        need_viser()
    except ConfigError as err:
        return str(err)
    return ""


Picture: TypeAlias = NDArray[np.uint8]
needs_viser = pytest.mark.skipif(bool(_viser_problem()), reason=_viser_problem() or "it is there")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> RunDir:
    """One hour of one person."""
    root = tmp_path_factory.mktemp("replay3d") / "run"
    config = Config(humans=["amara"], scenes=["maple"], days=1, hours=1, pictures="none", out=root)
    run_study(config, resumable=False)
    return RunDir.open(root)


@pytest.fixture(scope="module")
def frames(run: RunDir) -> list[Frame]:
    return [frame for _, frame in _frames(run, 0)]


def test_the_acts_of_a_day_are_done_again_in_their_order(run: RunDir) -> None:
    (hour,) = run.hours()
    assert hour.robot is not None
    done = [act.act for _, act, _ in acts_of(run, 0)]
    own = [one["act"] for one in hour.world["outcomes"] if one["ok"]]
    assert len(done) >= len(own)
    assert [one.model_dump() for one in done if one.kind != "hand_over"] == own


def test_nobody_jumps_they_walk(frames: list[Frame]) -> None:
    for root in (f"human/{PARTS[0]}", "robot/-1"):
        places = [frame.poses[root].place for frame in frames]
        steps = [math.dist(a[:2], b[:2]) for a, b in zip(places, places[1:], strict=False)]
        assert max(steps) < 0.7
    person = np.array([frame.poses[f"human/{PARTS[0]}"].place[:2] for frame in frames])
    assert np.ptp(person, axis=0).max() > 1.0


def test_all_that_is_shown_is_in_the_home_and_turned_by_a_whole_turn(frames: list[Frame]) -> None:
    bounds = load_scene("maple").bounds
    for frame in frames[::5]:
        for name, pose in frame.poses.items():
            if pose == GONE:
                continue
            x, y, z = pose.place
            assert bounds.x0 - 0.6 <= x <= bounds.x1 + 0.6, name
            assert bounds.y0 - 0.6 <= y <= bounds.y1 + 0.6, name
            assert -0.6 <= z <= 3.0, name
            assert math.hypot(*pose.turn) == pytest.approx(1.0, abs=0.01), name


def test_a_thing_in_hand_goes_with_the_hand(frames: list[Frame]) -> None:
    moved = [name for name in frames[0].poses if name.startswith("things/")]
    moved = [name for name in moved if len({frame.poses.get(name) for frame in frames}) > 5]
    assert moved

    def near(frame: Frame, pose: Pose) -> float:
        hands = [frame.poses[f"human/{side}_hand"].place for side in ("left", "right")]
        return min(math.dist(pose.place, hand) for hand in hands)

    carried = [near(frame, frame.poses[name]) for frame in frames for name in moved if name in frame.poses]
    assert min(carried) < 1.3


def test_a_home_a_person_and_each_robot_are_whole_meshes_in_colour(tmp_path: Path) -> None:
    scene = load_scene("maple")
    meshes = {"home": solids.home_mesh(scene)}
    skin = solids.person_skin(find("amara", tmp_path))
    meshes |= {f"part {number}": mesh for number, mesh in solids.person_parts(skin)}
    assert len(meshes) > 12
    for robot in usable_robots():
        meshes |= {f"{robot} {link}": mesh for link, mesh in solids.robot_links(load_robot(robot)).items()}
    for name, mesh in meshes.items():
        assert len(mesh.faces) > 3, name
        assert np.isfinite(mesh.vertices).all(), name
        assert np.isfinite(mesh.vertex_normals).all(), name
        assert mesh.visual.vertex_colors.shape == (len(mesh.vertices), 4), name
    low, high = meshes["home"].bounds
    assert low[0] >= scene.bounds.x0 - 0.2
    assert high[1] <= scene.bounds.y1 + 0.2


def test_a_day_that_is_not_there_is_named_and_so_is_what_is_not_installed(
    run: RunDir, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coopera: Callable[..., Said]
) -> None:
    with pytest.raises(RunError, match="there is no day 7; there are 0"):
        next(acts_of(run, 7))
    monkeypatch.setitem(sys.modules, "viser", None)
    told = coopera("replay", run.root, "--html", tmp_path / "day.html")
    assert (told.code, "needs viser 1.0 or newer; install it with: pip install viser" in told.err) == (2, True)
    assert not (tmp_path / "day.html").exists()


@pytest.fixture(scope="module")
def page(run: RunDir, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("page") / "day.html"
    write_page(run, 0, file)
    return file


@needs_viser
def test_the_page_is_one_small_file_that_names_nothing_outside(page: Path) -> None:
    assert page.stat().st_size < 10e6
    text = page.read_text(encoding="utf-8")
    assert "<title>run, day 0</title>" in text
    assert 'src="http' not in text
    assert 'href="http' not in text


@pytest.mark.slow
def test_a_film_shows_the_same_acts(run: RunDir, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("av", reason="a film needs PyAV")
    monkeypatch.setattr(run, "config", run.config.model_copy(update={"frame_size": (32, 32)}))
    made = write_film(run, 0, tmp_path / "day.mp4")
    assert made.seconds > 20
    assert (tmp_path / "day.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.slow
@needs_viser
@needs_browser
def test_the_page_is_not_blank_moves_and_asks_for_nothing_in_a_browser(page: Path) -> None:
    drawn = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")  # no graphics card draws here
    with browsing(*drawn, bad=frozenset({"error"}), locale="en-US") as watched:
        watched.page.goto(page.resolve().as_uri())
        first = _until(lambda: _picture(watched), lambda seen: np.std(seen[100:500]) > 25)
        later = _until(lambda: _picture(watched), lambda seen: np.mean(seen[100:500] != first[100:500]) > 0.001)
        assert later.shape == first.shape


def _picture(watched: Watched) -> Picture:
    return np.asarray(Image.open(io.BytesIO(watched.page.screenshot())).convert("RGB"))


def _until(look: Callable[[], Picture], found: Callable[[Picture], bool], tries: int = 60) -> Picture:
    for _ in range(tries):
        seen = look()
        if found(seen):
            return seen
        threading.Event().wait(1.0)
    raise AssertionError("it was never to be seen")
