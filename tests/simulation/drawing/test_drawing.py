from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.simulation import PersonAgent, RobotAgent, World
from coopera.simulation.drawing import context
from coopera.simulation.drawing.context import chosen, problem
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.renderer import Renderer
from coopera.simulation.drawing.scenery import shape_mesh
from coopera.simulation.drawing.view import NOTHING
from coopera.simulation.people.appearance import Appearance
from tests.simulation.drawing.rays import agreement
from tests.simulation.flat import flat, put

needs_gl = pytest.mark.skipif(bool(problem()), reason=f"nothing can be drawn with OpenGL here: {problem()}")
SIZE = (160, 120)


@pytest.fixture
def home() -> Iterator[World]:
    with World(flat(), renderer="gl") as world:
        yield world


def over(world: World, name: str) -> Camera:
    """A camera that looks down at a piece of furniture from the front."""
    thing = world.layout.object(name)
    assert thing is not None
    x, y, z = thing.position
    return Camera((x + 0.4, y + 0.9, z + thing.size[2] + 1.0), (x, y, z + thing.size[2]))


@needs_gl
def test_the_same_home_gives_the_same_bytes(home: World) -> None:
    camera = over(home, "dining_table_1")
    first = home.view(camera, SIZE)
    again = home.view(camera, SIZE)
    with World(flat(), renderer="gl") as other:
        elsewhere = other.view(camera, SIZE)
    for one in (again, elsewhere):
        assert one.colour.tobytes() == first.colour.tobytes()
        assert one.depth.tobytes() == first.depth.tobytes()
        assert (one.instances == first.instances).all()
    assert first.colour.std() > 10


@needs_gl
def test_a_thing_is_seen_where_it_was_put_and_no_longer_where_it_was(home: World) -> None:
    camera = over(home, "dining_table_1")
    before = home.view(camera, SIZE)
    assert home.perform("human", put("book_1", "dining_table_1")).ok
    after = home.view(camera, SIZE)
    assert before.pixels_of("book_1") == 0
    assert after.pixels_of("book_1") > 5
    seen = np.array([after.names.get(body) for body in after.instances.ravel()]) == "book_1"
    middle = np.median(after.points.reshape(-1, 3)[seen], axis=0)
    where = home.state.thing(home.layout.object("book_1")).position
    assert np.abs(middle - np.array(where)).max() < 0.2
    book = after.class_names.index("book")
    assert (after.classes.ravel()[seen] == book).all()


@needs_gl
def test_what_is_held_goes_with_the_hand_and_people_and_robots_are_seen(home: World) -> None:
    assert home.pick("human", "book_1").ok
    person = home.state.person("human")
    x, y = person.place
    camera = Camera((x + 1.4, y + 1.0, 1.7), (x, y, 1.0))
    view = home.view(camera, SIZE)
    assert view.pixels_of("human") > 200
    assert view.pixels_of("book_1") > 3
    x, y = home.state.agents["robot"].spot
    assert home.view(Camera((x, y - 0.5, 4.0), (x, y, 0.5)), SIZE).pixels_of("robot") > 200


@needs_gl
def test_six_people_are_drawn_and_look_as_they_are_said_to() -> None:
    people = [PersonAgent(id=f"person{i}") for i in range(6)]
    same, other = Appearance(skin=(0.2, 0.5, 0.2)), Appearance(skin=(0.9, 0.1, 0.9), hair_style="bald")
    with World(flat(), agents=[*people, RobotAgent()], renderer="gl") as world:
        world.looks |= {one.id: same for one in people}
        b = world.layout.bounds
        camera = Camera(((b.x0 + b.x1) / 2, b.y0, 9.0), ((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, 0.0))
        view = world.view(camera, (320, 240))
        assert all(view.pixels_of(one.id) > 10 for one in people)
        world.looks[people[0].id] = other
        changed = (world.view(camera, (320, 240)).colour != view.colour).any(axis=2)
        first = np.array([view.names.get(body) == people[0].id for body in view.instances.ravel()])
        assert changed.ravel()[first].mean() > 0.1
        assert changed.ravel()[~first].mean() < 0.02


@needs_gl
def test_depth_classes_and_bodies_agree_with_rays_at_what_is_drawn(home: World) -> None:
    first = home.layout.rooms[0].centre
    for camera in (
        "robot",
        Camera((*first, 1.6), (first[0] + 2, first[1] + 1, 0.8)),
        Camera((*first, 8.0), (*first, 0.0)),
    ):
        view = home.view(camera, SIZE)
        drawer = home._watching().drawn.drawer
        assert drawer is not None
        off, classes, bodies = agreement(view, drawer.scenery, 150)
        assert (off < 0.01).mean() > 0.98
        assert classes.mean() > 0.98
        assert bodies.mean() > 0.98


@needs_gl
def test_points_and_matrices_tell_of_the_same_pixels(home: World) -> None:
    view = home.view("robot", SIZE)
    points, colours, bodies = view.point_cloud()
    assert len(points) == len(colours) == len(bodies) == np.isfinite(view.depth).sum()
    inside = view.extrinsics @ np.concatenate((points, np.ones((len(points), 1))), axis=1).T
    pixels = view.intrinsics @ inside[:3]
    y, x = np.nonzero(np.isfinite(view.depth))
    assert np.abs(pixels[0] / pixels[2] - (x + 0.5)).max() < 1e-3
    assert np.abs(pixels[1] / pixels[2] - (y + 0.5)).max() < 1e-3
    assert np.abs(inside[2] - view.depth[np.isfinite(view.depth)]).max() < 1e-4


@needs_gl
def test_a_camera_above_looks_in_and_one_inside_sees_the_ceiling(home: World) -> None:
    x, y = home.layout.rooms[0].centre
    above = home.view(Camera((x, y, 8.0), (x, y + 0.1, 0.0)), SIZE)
    below = home.view(Camera((x, y, 0.5), (x, y + 0.1, 2.4)), SIZE)
    ceiling = below.class_names.index("ceiling")
    assert not (above.classes == ceiling).any()
    assert (below.classes == ceiling).mean() > 0.9
    assert below.colour.mean() > 120  # a ceiling is bright


@needs_gl
@pytest.mark.parametrize("size", [(1, 1), (3, 2), (2500, 9)])
def test_odd_sizes_are_pictures(home: World, size: tuple[int, int]) -> None:
    view = home.view("robot", size)
    assert view.colour.shape == (size[1], size[0], 3)
    assert (view.instances != NOTHING).any()


@needs_gl
def test_what_comes_and_goes_is_drawn_as_by_a_renderer_that_sees_it_first(home: World) -> None:
    camera = over(home, "dining_table_1")
    before = home.view(camera, SIZE).colour
    drawer = home._watching().drawn.drawer
    scenery, spot = drawer.scenery, np.array(camera.target)
    mug = shape_mesh("mug", (0.3, 0.3, 0.3), (0.9, 0.1, 0.1))
    for number in range(120):  # more than there is room for at first
        scenery.add(f"mug {number}", mug, 0, "mug")
        scenery.put(f"mug {number}", spot + (0.0, 0.0, 0.01 * (number % 7)), np.eye(3))
        if number % 2:
            scenery.remove(f"mug {number - 1}")
        if number % 10 == 5:
            seen = drawer.draw(camera, SIZE).colour
            scenery.stirred = None
            fresh = Renderer(scenery)
            assert (seen == fresh.draw(camera, SIZE).colour).all()
            fresh.close()
            assert (seen != before).any()
    for number in range(1, 120, 2):
        scenery.remove(f"mug {number}")
    assert (drawer.draw(camera, SIZE).colour == before).all()


@needs_gl
def test_a_tiled_picture_is_the_whole_picture(home: World, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = home.view("robot", SIZE)
    monkeypatch.setattr("coopera.simulation.drawing.renderer._TILE", 64)
    tiled = home.view("robot", SIZE)
    assert (whole.instances == tiled.instances).mean() > 0.999
    assert np.abs(whole.colour.astype(int) - tiled.colour).mean() < 0.5


@needs_gl
def test_frames_and_depth_come_with_our_renderer_alone() -> None:
    with World(flat(), renderer="tiny") as world, pytest.raises(ConfigError, match="drawn by gl alone"):
        world.view("robot", SIZE)


def test_without_opengl_tiny_draws_and_a_sentence_says_what_would_help(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(context, "_drawers", [])
    monkeypatch.setattr(context, "_context", lambda: (None, "EGL does not start (no libEGL); " + context._PACKAGES))
    assert chosen("auto") == "tiny"
    assert [chosen(name) for name in ("tiny", "egl")] == ["tiny", "egl"]
    with pytest.raises(
        ConfigError, match=r"gl is not to be had .* apt-get install libegl1 libgl1-mesa-dri; or choose tiny"
    ):
        chosen("gl")
    with World(flat(), renderer="auto", frame_size=(64, 48)) as world:
        assert world.perform("human", put("book_1", "dining_table_1"), record=True).ok
        assert world._watching().drawn.drawer is None


def test_a_machine_without_mesa_gives_a_sentence(tmp_path: Path) -> None:
    program = "from coopera.simulation.drawing.context import problem; print(problem())"
    lost = {"EGL_PLATFORM": "surfaceless", "__EGL_VENDOR_LIBRARY_DIRS": str(tmp_path)}
    env = {**os.environ, **lost, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, env=env)
    assert done.stdout.count("\n") == 1
    assert done.stdout == "\n" or "libegl1" in done.stdout or "moderngl" in done.stdout
