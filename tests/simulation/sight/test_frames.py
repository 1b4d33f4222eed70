from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from benchmarks.frames import looked_at
from coopera.core.household import HUMAN, ROBOT
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid_reach import standing
from coopera.simulation.bodies.robot import load_robot, usable_robots
from coopera.simulation.sight.cameras import robot_camera
from coopera.simulation.sight.hiding import behind_balls, behind_boxes, boxes_of, person_body
from coopera.simulation.sight.labels import Name, labelled
from coopera.simulation.sight.recording import Recording, Shot
from coopera.simulation.sight.sampling import telling_ticks
from coopera.simulation.sight.stances import watching
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put


@pytest.fixture(scope="module")
def home():
    with World(flat(), frame_size=(96, 72), renderer="tiny") as world:
        yield world


def seen_at_deed(world: World, view: str):
    """What a picture of the deed shows."""
    watcher, recording = world._watcher, world._recording
    ((moment, cameras),) = watcher._takes(recording, [deed_of(recording)], (view,))
    watcher.drawn.show(recording.state, moment)
    return looked_at(watcher.drawn, moment, cameras[view])


def deed_of(recording: Recording) -> int:
    return sum(shot.ticks for shot in recording.shots[:-1]) + recording.shots[-1].deed


def ticks_of(world: World, count: int) -> list[int]:
    return telling_ticks(world._recording, world._ground.robots, count)


@pytest.mark.parametrize(
    ("act", "view"),
    [
        (move("sofa_1", "book", "sit and read"), "robot"),
        (move("sofa_1", "book", "sit and read"), "human"),
        (move("dining_table_1", "bowl", "eat a meal"), "human"),
        (move("sofa_1", "dumbbell", "lift dumbbells"), "robot"),
        (move("kitchen_counter_1", "sponge", "wipe the surface"), "human"),
        (put("book_1", "dining_table_1"), "human"),
    ],
    ids=lambda value: value if isinstance(value, str) else value.describe(),
)
def test_the_hands_are_seen_in_the_deed(home, act, view) -> None:
    home.restore({})
    assert home.perform(HUMAN, act, record=True).ok
    seen = seen_at_deed(home, view)
    assert any(seen.hands)
    assert seen.angle < 120


@pytest.mark.parametrize("name", usable_robots())
def test_a_robots_own_arm_is_not_in_its_pictures_of_a_person(name) -> None:
    with World(flat(), robot=name, renderer="tiny") as world:
        assert world.perform(HUMAN, move("sofa_1", "book", "sit and read"), record=True).ok
        assert seen_at_deed(world, "robot").robot < 0.02


@pytest.mark.parametrize("name", usable_robots())
@pytest.mark.parametrize("away", [1.5, 2.5])
def test_what_a_robot_carries_its_arm_for_is_not_before_its_eyes_when_it_looks_at_somebody(name, away) -> None:
    body = load_robot(name)
    looks = watching(body, Placed(0.0, 0.0, 0.0, body.carrying), Placed(away, 0.0, math.pi, standing()))
    camera = robot_camera(body, looks)
    eye = np.array(camera.eye)
    ahead = (np.array(camera.target) - eye) / math.dist(camera.target, camera.eye)
    lines = body.arm(looks.pose) - eye
    angle = np.degrees(np.arccos(lines @ ahead / np.linalg.norm(lines, axis=1)))
    assert angle.min() > 25


def test_furniture_that_somebody_is_in_hides_them_by_its_parts() -> None:
    scene = flat()
    (sofa,) = [thing for thing in scene.fixed if thing.cls == "sofa"]
    seated = person_body(Placed(2.0, 0.55, math.pi / 2, standing() - [0, 0, 0.4, *[0] * (len(standing()) - 3)]))
    chest = seated.points[1]
    before, behind = np.array((2.0, 3.0, 1.2)), np.array((2.0, -1.5, 0.4))
    hidden = behind_boxes(np.array((before, behind)), np.array((chest, chest - (0, 0, 0.4))), boxes_of([sofa]))
    assert hidden.tolist() == [False, True]


def test_a_body_hides_the_hand_before_it_from_behind_and_not_from_the_front() -> None:
    balls, radii = np.array(((0.0, 0.0, 1.0),)), np.array((0.15,))
    hand = np.array((0.3, 0.0, 1.0))
    eyes = np.array(((2.0, 0.0, 1.2), (-2.0, 0.0, 1.2)))
    assert behind_balls(eyes, np.array((hand, hand)), balls, radii).tolist() == [False, True]
    inside = np.array((0.05, 0.0, 1.0))  # in the lap
    assert behind_balls(eyes, np.array((inside, inside)), balls, radii).tolist() == [False, True]


@pytest.mark.parametrize("count", [1, 5, 16])
def test_the_deed_is_among_the_frames_and_all_are_of_different_moments(home, count) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("dining_table_1", "apple_1", "eat a meal", home.layout), record=True).ok
    chosen = ticks_of(home, count)
    assert chosen == sorted(set(chosen))
    assert len(chosen) == count
    assert deed_of(home._recording) in chosen
    if count > 1:
        assert chosen[-1] >= home._recording.ticks - 30


@pytest.mark.parametrize(("count", "before"), [(4, 1), (5, 1), (8, 2)])
def test_most_frames_of_a_motion_are_of_the_motion(home, count, before) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("dining_table_1", "bowl", "eat a meal"), record=True).ok
    last = home._recording.shots[-1]
    begun = home._recording.ticks - last.ticks + last.begun
    assert 1 <= sum(tick < begun for tick in ticks_of(home, count)) <= before


def test_of_a_motion_with_two_phases_frames_show_them_by_turns(home) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("dining_table_1", "bowl", "eat a meal"), record=True).ok
    recording = home._recording
    shot = recording.shots[-1]
    up, down = (shot.at(shot.begun + round(share * (shot.ticks - shot.begun))) for share in (0.0, 0.25))
    phases = [tick // 20 % 2 == 1 for tick in range(240)]
    twofold = replace(recording, shots=[Shot(240, lambda tick: up if phases[tick] else down, 120, 0, 0)])
    assert not np.allclose(up.bodies[HUMAN].pose, down.bodies[HUMAN].pose)
    shown = [phases[tick] for tick in telling_ticks(twofold, home._ground.robots, 5)]
    assert all(one is not other for one, other in zip(shown, shown[1:], strict=False))


def test_few_frames_show_the_taking_the_carrying_and_the_putting_down(home) -> None:
    home.restore({})
    assert home.perform(HUMAN, put("mug_1", "dining_table_1"), record=True).ok
    recording = home._recording
    moments = [recording.shots[i].at(within) for i, within in map(recording.find, ticks_of(home, 4))]
    assert {"human" in moment.held for moment in moments} == {True, False}
    assert {"mug_1" in moment.moved for moment in moments} == {True, False}


def test_frames_that_follow_each_other_differ_more_than_those_at_equal_times(home, tmp_path) -> None:
    home.restore({})
    assert home.perform(HUMAN, move("dining_table_1", "bowl", "eat a meal"), record=True).ok
    recording, watcher = home._recording, home._watcher

    def least(ticks) -> float:
        images = []
        for moment, cameras in watcher._takes(recording, ticks, ("human",)):
            watcher.drawn.show(recording.state, moment)
            images.append(watcher.drawn.picture(cameras["human"], (96, 72))[0].astype(int))
        return min(float(np.abs(a - b).mean()) for a, b in zip(images, images[1:], strict=False))

    evenly = np.linspace(0, recording.ticks - 1, 5).round().astype(int).tolist()
    assert least(ticks_of(home, 5)) > 1.5 * least(evenly)


def test_where_more_frames_are_asked_for_than_there_are_moments_each_moment_is_one(home) -> None:
    home.restore({})
    assert home.perform(HUMAN, put("mug_1", "dining_table_1"), record=True).ok
    whole = home._recording
    last = whole.shots[-1]
    short = Recording(whole.state, ROBOT, HUMAN, HUMAN, [Shot(5, last.at, 2)])
    assert telling_ticks(short, home._ground.robots, 9) == [0, 1, 2, 3, 4]
    assert telling_ticks(short, home._ground.robots, 4)[0] >= 0
    assert telling_ticks(short, home._ground.robots, 1) == [2]


@pytest.mark.parametrize("name", usable_robots())
@pytest.mark.parametrize("act", [put("book_1", "dining_table_1"), bring("mug")], ids=lambda act: act.kind)
def test_pictures_of_a_robots_act_show_the_robot_at_it(name, act) -> None:
    with World(flat(), robot=name, renderer="tiny") as world:
        assert world.perform(ROBOT, act, record=True).ok
        assert seen_at_deed(world, "human").robot > 0.015


def test_a_robots_act_is_kept_under_a_name_of_its_own_from_across_the_room(home, tmp_path) -> None:
    home.restore({})
    assert home.perform(ROBOT, put("book_1", "dining_table_1"), record=True).ok
    paths = home.frames(2, tmp_path, "help-0")
    assert [path.name for path in paths] == ["help-0-0.webp", "help-0-1.webp"]
    assert sorted(tmp_path.iterdir()) == paths


def test_recording_a_robots_act_changes_nothing_of_what_comes_of_it(home) -> None:
    states = []
    for record in (False, True):
        home.restore({})
        for act in (put("book_1", "dining_table_1"), put("mug_1", "mug_1"), bring("mug")):
            home.perform(ROBOT, act, record=record)
        states.append(home.snapshot())
    assert states[0] == states[1]


def test_labels_are_written_where_asked_for_and_change_nothing_else(tmp_path) -> None:
    said, images = [], []
    for labels in (False, True):
        with World(flat(), frame_size=(320, 240), labels=labels) as world:
            assert world.perform(HUMAN, move("sofa_1", "book_1", "sit and read", world.layout), record=True).ok
            said.append(world.snapshot())
            images.append([np.asarray(Image.open(p)).astype(int) for p in world.frames(2, tmp_path / str(labels))])
    assert said[0] == said[1]
    changed = [(np.abs(a - b).max(axis=2) > 100).mean() for a, b in zip(*images, strict=True)]
    assert all(0.005 < share < 0.2 for share in changed)


def test_a_name_stands_at_what_is_seen_and_nowhere_else() -> None:
    image = np.full((120, 160, 3), 200, dtype=np.uint8)
    mask = np.full((120, 160), -1, dtype=np.int64)
    mask[60:80, 100:120] = 7
    written = labelled(image, mask, [Name(7, "mug", small=True), Name(8, "hidden behind the sofa")])
    rows, columns = np.nonzero((written != image).any(axis=2))
    assert 30 <= rows.min() <= rows.max() < 60  # above the mug, which stays in sight
    assert 90 <= columns.min() <= columns.max() <= 130
    assert (labelled(image, mask, [Name(8, "hidden behind the sofa")]) == image).all()


def test_names_do_not_cover_each_other() -> None:
    image = np.full((120, 160, 3), 200, dtype=np.uint8)
    mask = np.zeros((120, 160), dtype=np.int64)
    mask[50:70, 60:100] = 1
    one = labelled(image, mask, [Name(1, "bowl", small=True)])
    both = labelled(image, mask, [Name(1, "bowl", small=True), Name(0, "table")])
    first = (one != image).any(axis=2)
    assert (both[first] == one[first]).all()
    assert (both != one).any()
