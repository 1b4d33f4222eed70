from __future__ import annotations

import inspect

import numpy as np
import pytest

from coopera.core.household import PerceptErrors
from coopera.simulation.motions.library import Library, load_library
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.shapes.rotations import about_z
from coopera.simulation.sight.percept import INSTANTS, seen_joints
from coopera.simulation.sight.pose_matching import FEWEST, PARTS, PoseMatcher, distances, matcher, skeleton
from coopera.simulation.sight.walks import walking
from coopera.simulation.world import World
from tests.simulation.flat import flat, move

LIBRARY = load_library()
TIMES = np.linspace(2.0, 10.0, 6)
SUPPORT = {"sit": 0.47, "lie": 0.45}


def seen(caption: str, noise: float = 0.03, seed: int = 0):
    motion = LIBRARY[caption]
    setting = Setting(SUPPORT.get(motion.posture, 0.0), 0.85 if motion.posture == "stand" else None, motion.posture)
    joints = np.array([skeleton(pose_at(motion, float(t), setting)) for t in TIMES])
    return joints + np.random.default_rng(seed).normal(0, noise, joints.shape)


def test_nearly_all_motions_are_recognised_at_heights_that_are_not_the_librarys() -> None:
    right = [matcher(LIBRARY).match(seen(caption), TIMES) is LIBRARY[caption] for caption in LIBRARY.captions]
    assert np.mean(right) > 0.9


def test_what_is_recognised_depends_on_the_joints_and_their_times_alone() -> None:
    assert list(inspect.signature(PoseMatcher.match).parameters) == ["self", "joints", "seconds"]
    assert "library" not in inspect.signature(seen_joints).parameters
    with World(flat()) as world:
        world.perform("human", move("sofa_1", "book", "sit and read"), record=True)
        played = world._recording
        joints, times = seen_joints(world._watching().stage, world.layout, played, INSTANTS)
        before = world.percept(np.random.default_rng(0))
        world.perform("human", move("bed_1", "book", "take a nap"))
        world.state = world.state.with_agent("human", motion="dance wildly")
        assert world.percept(np.random.default_rng(0)) == before
    assert matcher(LIBRARY).match(joints, times) is LIBRARY["sit and read"]
    assert not {"motion", "caption", "cls"} & {name for name in dir(played) if not name.startswith("_")}


def test_the_same_joints_under_another_name_are_recognised_as_what_the_library_calls_them() -> None:
    names = {"eat a meal": "box and punch", "box and punch": "eat a meal"}
    swapped = [LIBRARY[caption].model_copy(update={"caption": other}) for caption, other in names.items()]
    found = PoseMatcher(Library(swapped)).match(seen("eat a meal"), TIMES)
    assert found is not None
    assert found.caption == "box and punch"


@pytest.mark.parametrize("angle", [0.7, 2.0, -1.4])
def test_where_the_body_stands_and_which_way_it_faces_does_not_count(angle) -> None:
    joints = seen("stir a pot")
    moved = joints @ about_z(angle).T + np.array((3.0, -7.0, 0.0))
    assert np.allclose(distances(joints, joints), distances(moved, joints), atol=1e-9)
    assert matcher(LIBRARY).match(moved, TIMES) == matcher(LIBRARY).match(joints, TIMES)


def test_a_distance_is_the_mean_square_of_what_is_seen_and_zero_for_a_turned_pose() -> None:
    joints = seen("dance", noise=0.0)
    assert np.allclose(np.diag(distances(joints @ about_z(1.0).T, joints)), 0.0, atol=1e-12)
    higher = joints + np.array((0.0, 0.0, 0.1))
    assert np.allclose(np.diag(distances(higher, joints)), 0.01)
    hidden = higher.copy()
    hidden[:, PARTS.index("right_hand") :] = np.nan
    assert np.allclose(np.diag(distances(hidden, joints)), 0.01)


def test_hidden_joints_cost_accuracy_and_too_few_tell_nothing() -> None:
    joints = seen("wash dishes")
    joints[:, PARTS.index("right_hip") :] = np.nan
    found = matcher(LIBRARY).match(joints, TIMES)
    assert found is not None
    assert found.cls == "work with the hands at a surface"
    joints[:, FEWEST - 1 :] = np.nan
    assert matcher(LIBRARY).match(joints, TIMES) is None


@pytest.mark.parametrize("carries", [False, True])
def test_who_is_only_seen_walking_does_nothing_yet(carries) -> None:
    joints = np.array([skeleton(walking(1.1 * float(t), carries)) for t in TIMES])
    joints += np.random.default_rng(0).normal(0, 0.03, joints.shape)
    assert matcher(LIBRARY).match(joints, TIMES) is None


def test_the_way_to_a_deed_does_not_hide_the_deed() -> None:
    joints, times = seen("comb the hair"), TIMES.copy()
    joints[:2] = [skeleton(walking(0.4 * i, carries=True)) for i in range(2)]
    assert matcher(LIBRARY).match(joints, times) is LIBRARY["comb the hair"]


def test_motions_that_share_their_poses_are_told_apart_by_their_order_in_time() -> None:
    squats = LIBRARY["do squats"]
    slow = squats.model_copy(
        update={"caption": "do slow squats", "keys": squats.keys.model_copy(update={"period": 4.1})}
    )
    for first, second in ((squats, slow), (slow, squats)):
        two = PoseMatcher(Library([first, second]))
        for motion in (first, second):
            joints = np.array([skeleton(pose_at(motion, float(t), Setting())) for t in TIMES])
            assert two.match(joints, TIMES) is motion


def test_a_blinder_estimator_errs_more() -> None:
    def right(noise: float) -> float:
        found = [matcher(LIBRARY).match(seen(caption, noise), TIMES) for caption in LIBRARY.captions]
        return float(np.mean([f is not None and f.caption == c for f, c in zip(found, LIBRARY.captions, strict=True)]))

    assert right(0.15) < right(0.03) - 0.1


def test_a_person_whom_the_robot_does_not_see_is_not_recognised() -> None:
    with World(flat(), errors=PerceptErrors(in_hand_missed=0.0)) as world:
        world.perform("human", move("sofa_1", "book", "sit and read"), record=True)
        shot = world._recording.shots[0]
        seeing = shot.at

        def from_the_kitchen(tick):
            bodies = seeing(tick).bodies
            return seeing(tick)._replace(bodies={**bodies, "robot": bodies["robot"]._replace(x=8.0, y=1.0)})

        shot.at = from_the_kitchen
        said = world.percept(np.random.default_rng(0))
    assert (said.motion, said.in_hand) == ("", None)
    assert said.caption() == "In the living room, the person is at the sofa."
