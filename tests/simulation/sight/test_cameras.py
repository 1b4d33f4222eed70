from __future__ import annotations

import hashlib
import math
import subprocess
import sys
from ctypes.util import find_library
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from coopera.core.errors import ConfigError, SimulationError
from coopera.simulation.bodies.robot import load_robot
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.scene import load_scene
from coopera.simulation.sight import cameras
from coopera.simulation.sight.stage import Stage
from coopera.simulation.sight.video import need_video
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put


@pytest.fixture(scope="module")
def home():
    with World(flat(), frame_size=(96, 72)) as world:
        yield world


def persons_share(world: World, tick: int) -> tuple[float, float]:
    """Share of the pixels of the robot's and of the third-person picture that show the person."""
    watcher, recording = world._watcher, world._recording
    index, within = recording.find(tick)
    camera = watcher._view(recording, recording.shots[index])
    moment = recording.shots[index].at(within)
    stage = watcher.drawn
    stage.show(recording.state, moment)
    masks = [stage.picture(one, (64, 48))[1] for one in (watcher._eyes(recording, moment), camera)]
    robot, third = (float((mask == stage.bodies[recording.person]).mean()) for mask in masks)
    return robot, third


@pytest.mark.parametrize(
    "act",
    [
        move("sofa_1", "book", "sit and read"),
        move("dining_table_1", "bowl", "eat a meal"),
        move("bed_1", "blanket", "lie down"),
        move("washbasin_1", "toothbrush", "brush teeth"),
        move("sofa_1", "dumbbell", "do push-ups"),
        put("book_1", "dining_table_1"),
    ],
    ids=lambda act: act.describe(),
)
def test_both_views_show_the_person_at_the_deed(home, act) -> None:
    assert home.perform("human", act, record=True).ok
    start = 0
    for shot in home._recording.shots:
        robot, third = persons_share(home, start + shot.deed)
        assert robot > 0.008
        assert third > 0.015
        start += shot.ticks


def test_a_pane_of_the_shower_does_not_hide_the_person_from_the_third_person_view() -> None:
    with World(load_scene("oak")) as world:
        assert world.perform("human", move("shower_1", "sponge", "take a shower", world.layout), record=True).ok
        assert persons_share(world, world._recording.shots[-1].deed)[1] > 0.015


@pytest.mark.parametrize("target", ["kitchen_sink_1", "stove_1", "fridge_1"])
def test_where_the_persons_way_fills_the_room_the_robot_still_finds_a_place_to_see_from(target) -> None:
    with World(load_scene("maple")) as world:
        put_down = move("sofa_1", "book", "sit and read", world.layout)
        cook = move(target, "sponge", "wipe the surface", world.layout)
        for act in (put_down, cook):
            assert world.perform("human", act, record=True).ok
        last = world._recording.ticks - 1
        assert persons_share(world, last)[0] > 0.01


def test_the_robot_goes_to_where_it_sees_the_person_and_keeps_out_of_the_way(home) -> None:
    home.perform("human", move("sofa_1", "book", "sit and read"), record=True)
    state = home.state
    assert home.at("robot", "living room")
    assert 0.9 <= math.dist(state.robot().spot, state.person().place) <= 5.0
    (x, y), (to_x, to_y) = state.robot().spot, state.person().place
    towards = math.atan2(to_y - y, to_x - x)
    assert state.robot().yaw == pytest.approx(towards)


def test_a_robot_that_had_to_let_the_person_pass_comes_back_to_see_the_deed() -> None:
    with World(load_scene("maple"), frame_size=(96, 72)) as world:
        state = world.state.with_agent("human", spot=(8.7, 2.1), place=(8.7, 2.1), yaw=0.8)
        world.state = state.with_agent("robot", spot=(7.95, 2.5))
        act = move("dining_table_1", "tea bag", "pour a drink", world.layout)
        assert world.perform("human", act, record=True).ok
        assert min(persons_share(world, world._recording.shots[0].deed)) > 0.01
        person, robot = world.state.person(), world.state.robot()
        assert math.dist(person.spot, robot.spot) >= 0.55


def test_frames_are_named_and_ordered_robot_first_and_change_nothing(home, tmp_path) -> None:
    home.perform("human", put("mug_1", "dining_table_1"), record=True)
    before = home.snapshot()
    paths = home.frames(3, tmp_path / "frames")
    assert [path.name for path in paths] == [f"{who}-{i}.webp" for who in ("robot", "human") for i in range(3)]
    assert home.snapshot() == before
    with Image.open(paths[0]) as image:
        assert image.size == (96, 72)
        assert len(np.unique(np.asarray(image).reshape(-1, 3), axis=0)) > 50
    again = home.frames(3, tmp_path / "again")
    assert [path.read_bytes() for path in paths] == [path.read_bytes() for path in again]


def test_another_world_takes_the_same_pictures(home, tmp_path) -> None:
    def film(world: World, folder: str) -> list[str]:
        world.restore(start)
        world.perform("human", move("kitchen_counter_1", "sponge", "wipe the surface"), record=True)
        return [hashlib.sha256(path.read_bytes()).hexdigest() for path in world.frames(2, tmp_path / folder)]

    with World(flat(), frame_size=(96, 72)) as other:
        start = other.snapshot()
        assert film(home, "one") == film(other, "two")


def test_the_thing_in_hand_moves_with_the_hand_and_is_gone_from_its_place(home) -> None:
    home.perform("human", put("apple_1", "coffee_table_1"), record=True)
    first, second = home._recording.shots
    assert "human" not in first.at(0).held
    assert first.at(first.ticks - 1).held["human"].name == "apple_1"
    assert "human" not in second.at(second.ticks - 1).held
    assert second.at(second.ticks - 1).moved["apple_1"].on == "coffee_table_1"


def test_the_body_moves_without_jumps_within_a_shot(home) -> None:
    for act in (put("book_1", "dining_table_1"), move("bed_1", "book", "lie and read")):
        home.perform("human", act, record=True)
        for shot in home._recording.shots:
            bodies = [shot.at(i).bodies["human"] for i in range(0, shot.ticks)]
            places = np.array([[*body[:2], body.pose[2]] for body in bodies])
            assert np.abs(np.diff(places, axis=0)).max() < 0.2  # metres in a 30th of a second


def test_a_robot_that_is_given_a_thing_is_seen_to_take_it(home) -> None:
    home.restore({})
    home.pick("human", "mug_1")
    home.perform("robot", put("mug_1", "sofa_1"), record=True)
    given = home._recording.shots[0]
    assert (given.at(0).held["human"].name, given.at(0).held.get("robot")) == ("mug_1", None)
    last = given.at(given.ticks - 1)
    assert (last.held.get("human"), last.held["robot"].name) == (None, "mug_1")


def test_a_hand_over_can_be_recorded_too(home, tmp_path) -> None:
    home.perform("human", move("sofa_1", "book", "sit and rest"))
    assert home.perform("robot", bring("mug"), record=True).ok
    (shot,) = home._recording.shots
    assert shot.at(0).held["robot"].name == "mug_2"
    assert shot.at(shot.ticks - 1).held["human"].name == "mug_2"
    assert len(home.frames(2, tmp_path)) == 4


def test_a_folder_that_cannot_be_written_is_named(home, tmp_path) -> None:
    home.perform("human", move("sofa_1", "book", "sit and rest"), record=True)
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(SimulationError, match="cannot be written"):
        home.frames(1, tmp_path / "file")


@pytest.mark.parametrize(
    ("text", "cls"),
    [
        ("mug_2", "mug"),
        ("a cup and two books", "book"),
        ("Frying Pan", "frying_pan"),
        ("grandma's harp", "grandma's_harp"),
    ],
)
def test_a_thing_from_the_magic_box_looks_like_the_class_that_its_text_names(text, cls) -> None:
    assert shape_of(text).cls == cls


def test_a_recording_becomes_a_video_of_both_views_that_is_the_same_each_time(home, tmp_path) -> None:
    home.perform("human", put("book_1", "dining_table_1"), record=True)
    first, second = home.film(tmp_path / "day-00" / "hour-09.mp4"), home.film(tmp_path / "again.mp4")
    assert first.read_bytes() == second.read_bytes()
    with av.open(str(first)) as container:
        stream = container.streams.video[0]
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)]
    assert stream.codec_context.name == "h264"
    assert len(frames) == math.ceil(home._recording.ticks / 3)
    assert frames[0].shape == (72, 2 * 96, 3)
    assert np.abs(frames[0].astype(int) - frames[-1]).mean() > 1  # something moves


def test_video_without_its_encoder_says_what_to_install(monkeypatch) -> None:
    monkeypatch.setattr("coopera.simulation.sight.video.find_spec", lambda name: None)
    with pytest.raises(ConfigError, match=r"pip install .* '.\[video\]'"):
        need_video()


def test_a_renderer_that_is_not_to_be_had_is_refused_in_a_sentence(monkeypatch, tmp_path) -> None:
    monkeypatch.setattr("coopera.simulation.sight.engine.find_library", lambda name: None)
    with World(flat(), renderer="egl") as world:
        world.perform("human", put("book_1", "dining_table_1"), record=True)
        with pytest.raises(ConfigError, match=r"egl is not to be had on this machine .* choose tiny"):
            world.frames(1, tmp_path)


def test_rays_hit_what_is_not_drawn_as_they_hit_what_is() -> None:
    scene, people, robots = flat(), ["human"], {"robot": load_robot("fetch")}
    drawn, bare = Stage(scene, people, robots), Stage(scene, people, robots, renderer=None)
    rng = np.random.default_rng(0)
    room = np.array((*scene.bounds[:2], 0.0)), np.array((*scene.bounds[2:], 2.0))
    starts, ends = (rng.uniform(*room, size=(2000, 3)) for _ in range(2))
    hits = drawn.rays(starts, ends)
    assert len(set(hits.tolist())) > 10
    assert bare.rays(starts, ends).tolist() == hits.tolist()
    drawn.close()
    bare.close()


_EGL = """
import sys
sys.path.insert(0, {root!r})
from pathlib import Path
from coopera.core.errors import ConfigError
from coopera.simulation.world import World
from tests.simulation.flat import flat, put
with World(flat(), frame_size=(96, 72), renderer="egl") as world:
    try:
        world.perform("human", put("book_1", "dining_table_1"), record=True)
        print(len(world.frames(2, Path({folder!r}))))
    except ConfigError:
        print("none here")
"""


def test_egl_draws_where_it_is_to_be_had(tmp_path) -> None:
    program = _EGL.format(root=str(Path(__file__).parents[3]), folder=str(tmp_path))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    if find_library("EGL") is None:
        assert done.stdout == "none here\n"
        return
    assert done.stdout == "4\n"  # the plugin itself writes nothing that one sees
    assert all(np.asarray(Image.open(path)).std() > 10 for path in tmp_path.glob("*.webp"))


def test_a_camera_is_chosen_as_if_rays_were_cast_for_every_place(home, monkeypatch) -> None:
    assert home.perform("human", move("sofa_1", "book", "sit and read"), record=True).ok
    recording, cast = home._recording, []
    rays = Stage.rays
    monkeypatch.setattr(Stage, "rays", lambda stage, a, b: cast.append(len(a)) or rays(stage, a, b))
    few = [home._watcher._view(recording, shot) for shot in recording.shots]
    some = sum(cast)
    monkeypatch.setattr(cameras, "_AT_ONCE", 10_000)
    assert [home._watcher._view(recording, shot) for shot in recording.shots] == few
    assert some < (sum(cast) - some) / 2
