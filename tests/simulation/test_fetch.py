from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from simulation import fetch
from simulation.engine import pybullet
from simulation.stage import BODIES

TABLE = st.tuples(st.floats(0.5, 0.9), st.floats(-0.3, 0.3), st.floats(0.1, 1.2))


@pytest.fixture(scope="module")
def body():
    client = pybullet.connect(pybullet.DIRECT)
    robot = pybullet.loadURDF(str(BODIES / "fetch.urdf"), useFixedBase=True, physicsClientId=client)
    count = pybullet.getNumJoints(robot, physicsClientId=client)
    joints = {pybullet.getJointInfo(robot, i, physicsClientId=client)[1].decode(): i for i in range(count)}
    yield client, robot, joints
    pybullet.disconnect(client)


@pytest.mark.parametrize("posture", [fetch.TUCKED, fetch.CARRYING, fetch.READY], ids=["tucked", "carrying", "ready"])
def test_our_forward_kinematics_places_gripper_and_head_where_the_engine_does(body, posture) -> None:
    client, robot, joints = body
    for name, value in zip(fetch.JOINTS, posture, strict=True):
        pybullet.resetJointState(robot, joints[name], float(value), physicsClientId=client)
    wrist, head = (
        pybullet.getLinkState(robot, joints[name], computeForwardKinematics=True, physicsClientId=client)
        for name in ("wrist_roll", "head_tilt")
    )
    tip, _ = pybullet.multiplyTransforms(wrist[4], wrist[5], (0.16645, 0, 0), (0, 0, 0, 1))
    eye, _ = pybullet.multiplyTransforms(head[4], head[5], (0.07, 0, 0.0225), (0, 0, 0, 1))
    assert np.allclose(fetch.gripper(posture).place, tip, atol=1e-5)
    assert np.allclose(fetch.camera(posture)[0], eye, atol=1e-5)


def test_the_jacobian_is_the_slope_of_the_forward_kinematics() -> None:
    posture = fetch.READY.copy()
    at = fetch.gripper(posture)
    for i in range(8):
        moved = posture.copy()
        moved[i] += 1e-6
        slope = (fetch.gripper(moved).place - at.place) / 1e-6
        assert np.allclose(at.jacobian[:, i], slope, atol=1e-4)


@given(target=TABLE)
@settings(max_examples=60)
def test_the_gripper_gets_to_every_point_before_the_robot_within_the_joints_limits(target) -> None:
    posture = fetch.reach(np.array(target))
    if target[2] < 0.25 and math.hypot(*target[:2]) > 0.75:  # the arm does not reach far over the floor
        return
    assert posture is not None
    assert math.dist(fetch.gripper(posture).place, target) <= 0.0051
    low = [0, -1.6056, -1.221, -math.pi, -2.251, -math.pi, -2.16, -math.pi]
    high = [0.38615, 1.6056, 1.518, math.pi, 2.251, math.pi, 2.16, math.pi]
    assert (posture[:8] >= np.array(low) - 1e-9).all()
    assert (posture[:8] <= np.array(high) + 1e-9).all()


def test_the_same_point_always_gives_the_same_posture() -> None:
    point = np.array((0.35, 0.5, 1.15))
    assert np.array_equal(fetch.reach(point), fetch.reach(point.copy()))


@pytest.mark.parametrize("point", [(2.0, 0.0, 0.8), (0.5, 0.0, -0.1), (1.1, 0.0, 1.8)])
def test_a_point_out_of_reach_gives_no_posture(point) -> None:
    assert fetch.reach(np.array(point)) is None


@given(target=st.tuples(st.floats(1.0, 4.0), st.floats(-1.0, 1.0), st.floats(0.1, 1.8)))
@settings(max_examples=30)
def test_the_head_turns_so_that_the_camera_faces_a_point(target) -> None:
    place, direction = fetch.camera(fetch.look_at(fetch.TUCKED, np.array(target)))
    line = np.array(target) - place
    angle = math.acos(min(float(line @ direction) / float(np.linalg.norm(line)), 1.0))
    assert math.degrees(angle) < 8
