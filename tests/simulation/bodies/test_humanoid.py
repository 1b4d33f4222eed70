from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.simulation.bodies.humanoid import (
    JOINTS,
    REACH,
    SIDES,
    SIZE,
    SLICES,
    STANDING,
    Aim,
    blend,
    forward,
    solve,
)
from coopera.simulation.bodies.humanoid_reach import carrying, reaching, standing
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.stage import BODIES

NEAR = st.tuples(st.floats(0.15, 0.45), st.floats(-0.4, 0.2), st.floats(0.95, 1.5))


@pytest.fixture(scope="module")
def body():
    client = pybullet.connect(pybullet.DIRECT)
    person = pybullet.loadURDF(str(BODIES / "person.urdf"), useFixedBase=True, physicsClientId=client)
    yield client, person
    pybullet.disconnect(client)


@pytest.mark.parametrize("bend", [0.0, 25.0, -40.0])
def test_our_forward_kinematics_places_every_joint_where_the_engine_does(body, bend) -> None:
    client, person = body
    aim = Aim(pelvis=(0.1, -0.05, 0.6), hips=(bend, 30.0, 10.0), chest=(bend / 2, -20.0, 5.0), neck=(10.0, 15.0, 0.0))
    aim.hands = {"right": np.array((0.4, -0.2, 1.1)), "left": np.array((0.2, 0.4, 0.7))}
    pose, _ = solve(aim)
    joints = {
        pybullet.getJointInfo(person, i, physicsClientId=client)[1].decode(): i
        for i in range(pybullet.getNumJoints(person, physicsClientId=client))
    }
    turn = pose[SLICES["turn"]].tolist()
    pybullet.resetBasePositionAndOrientation(person, pose[:3].tolist(), turn, physicsClientId=client)
    values = [pose[SLICES[name]].tolist() for name, _ in JOINTS]
    order = [joints[name] for name, _ in JOINTS]
    pybullet.resetJointStatesMultiDof(person, order, values, physicsClientId=client)
    frames = forward(pose)
    for name, _ in JOINTS:
        state = pybullet.getLinkState(person, joints[name], computeForwardKinematics=True, physicsClientId=client)
        assert np.allclose(frames.place[name], state[4], atol=1e-5), name


@given(right=NEAR, left=NEAR)
@settings(max_examples=40)
def test_hands_get_to_points_within_an_arms_length(right, left) -> None:
    aim = Aim(hands={"right": np.array(right), "left": np.array(left) * (1, -1, 1)})
    shoulders = aim.frames().place
    pose, missed = solve(aim)
    hands = forward(pose).place
    for side in SIDES:
        target = aim.hands[side]
        if math.dist(target, shoulders[f"{side}_shoulder"]) < REACH - 0.01:
            assert np.allclose(hands[f"{side}_hand"], target, atol=2e-3)
            continue
        assert missed > 0 or math.dist(hands[f"{side}_hand"], target) < 0.02


def test_a_hand_points_at_what_it_cannot_reach_and_says_by_how_much() -> None:
    far = np.array((2.0, -0.18, 1.3))
    pose, missed = solve(Aim(hands={"right": far}))
    frames = forward(pose)
    shoulder, hand = frames.place["right_shoulder"], frames.place["right_hand"]
    assert missed == pytest.approx(math.dist(shoulder, far) - REACH, abs=1e-3)
    along = (far - shoulder) / np.linalg.norm(far - shoulder)
    assert float((hand - shoulder) @ along) == pytest.approx(REACH, abs=1e-3)


def test_knees_bend_backward_and_elbows_forward() -> None:
    crouching, _ = solve(Aim(pelvis=(0.0, 0.0, 0.55)))
    frames = forward(crouching)
    for side in SIDES:
        assert frames.place[f"{side}_knee"][0] > frames.place[f"{side}_ankle"][0] + 0.2
        assert float(crouching[SLICES[f"{side}_knee"]][0]) < 0
        assert float(crouching[SLICES[f"{side}_elbow"]][0]) >= 0


def test_who_stands_has_both_soles_on_the_floor_and_hanging_hands() -> None:
    frames = forward(standing())
    for side in SIDES:
        assert frames.place[f"{side}_ankle"][2] == pytest.approx(0.05, abs=1e-3)
        assert frames.place[f"{side}_hand"][2] < STANDING
    assert frames.place["head"][2] == pytest.approx(1.506, abs=0.02)


def test_a_blend_begins_and_ends_in_its_two_poses_and_keeps_quaternions_unit() -> None:
    first, second = standing(), carrying()
    assert np.allclose(blend(first, second, 0.0), first)
    assert np.allclose(blend(first, second, 1.0), second, atol=1e-9)
    half = blend(first, second, 0.5)
    assert half.shape == (SIZE,)
    assert np.linalg.norm(half[SLICES["right_shoulder"]]) == pytest.approx(1.0)


@pytest.mark.parametrize("target", [(0.5, -0.1, 0.9), (0.75, 0.0, 0.75), (0.45, -0.1, 0.05), (0.4, -0.2, 1.75)])
def test_the_person_stoops_as_far_as_needed_to_take_a_thing(target) -> None:
    pose = reaching(np.array(target))
    assert pose is not None
    assert math.dist(forward(pose).place["right_hand"], target) < 0.035


def test_the_person_cannot_take_what_is_across_the_room_or_under_the_ceiling() -> None:
    assert reaching(np.array((1.6, 0.0, 0.9))) is None
    assert reaching(np.array((0.3, 0.0, 2.3))) is None
