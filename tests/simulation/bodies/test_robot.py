"""What holds for every robot's body: each test runs for all that ship."""

from __future__ import annotations

import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.errors import ConfigError
from coopera.simulation.bodies.robot import RobotBody, known_robots, load_robot, usable_robots
from coopera.simulation.shapes.rotations import about_z
from coopera.simulation.sight.engine import load_urdf, pybullet
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, put


def before(body: RobotBody, *point: float) -> np.ndarray:
    """A point as seen from where the body works, in its own frame."""
    return about_z(body.side) @ np.array(point)


TABLE = st.tuples(st.floats(0.45, 0.75), st.floats(-0.3, 0.3), st.floats(0.15, 1.2))
every_robot = pytest.mark.parametrize("body", [load_robot(name) for name in usable_robots()], ids=usable_robots())


class Loaded:
    """A body in the engine, to compare with."""

    def __init__(self, body: RobotBody) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        self.robot = load_urdf(body.urdf, self.client)
        count = pybullet.getNumJoints(self.robot, physicsClientId=self.client)
        infos = [pybullet.getJointInfo(self.robot, i, physicsClientId=self.client) for i in range(count)]
        self.joints = {info[1].decode(): i for i, info in enumerate(infos)}
        self.limits = {info[1].decode(): (info[8], info[9]) for info in infos}

    def place(self, joint: str, offset) -> tuple[float, float, float]:
        link = pybullet.getLinkState(
            self.robot, self.joints[joint], computeForwardKinematics=True, physicsClientId=self.client
        )
        return pybullet.multiplyTransforms(link[4], link[5], offset, (0, 0, 0, 1))[0]

    def take(self, body: RobotBody, posture) -> None:
        for name, value in zip(body.joints, posture, strict=True):
            pybullet.resetJointState(self.robot, self.joints[name], float(value), physicsClientId=self.client)


@every_robot
def test_our_forward_kinematics_places_gripper_and_camera_where_the_engine_does(body) -> None:
    loaded = Loaded(body)
    for posture in (body.tucked, body.carrying, *islice(body.reach(before(body, 0.6, 0.2, 0.8)), 2)):
        loaded.take(body, posture)
        tip = loaded.place(body.chain.joints[-1].name, body.chain.tip)
        assert np.allclose(body.gripper(posture).place, tip, atol=1e-4)
        eye = body.eye.chain
        assert np.allclose(body.camera(posture)[0], loaded.place(eye.joints[-1].name, eye.tip), atol=1e-4)
    for joint in body.chain.joints:
        low, high = loaded.limits[joint.name]
        assert low > high or (low, high) == pytest.approx((joint.low, joint.high), abs=1e-3)  # a roll has no limits
    pybullet.disconnect(loaded.client)


@every_robot
def test_the_jacobian_is_the_slope_of_the_forward_kinematics(body) -> None:
    posture = body.carrying.copy()
    at = body.gripper(posture)
    for i in range(len(body.chain.joints)):
        moved = posture.copy()
        moved[i] += 1e-6
        assert np.allclose(at.jacobian[:, i], (body.gripper(moved).place - at.place) / 1e-6, atol=1e-4)


@every_robot
@given(target=TABLE)
@settings(max_examples=30, deadline=None)
def test_the_gripper_gets_to_every_point_before_the_robot_within_the_joints_limits(body, target) -> None:
    if target[2] < 0.3 and math.hypot(*target[:2]) > 0.65:  # no arm reaches far over the floor
        return
    aside = 1.0 if body.chain.pan[0] is not None else 0.25  # where no joint turns the arm, the base does
    target = before(body, target[0], aside * target[1], target[2])
    posture = next(body.reach(target), None)
    assert posture is not None
    assert math.dist(body.gripper(posture).place, target) <= 0.0051
    count = len(body.chain.joints)
    assert (posture[:count] >= body.chain.low - 1e-9).all()
    assert (posture[:count] <= body.chain.high + 1e-9).all()


@every_robot
def test_the_gripper_is_moved_in_cartesian_steps_of_the_length_asked_for(body) -> None:
    start, rest = next(body.reach(before(body, 0.5, 0.0, 0.9))), body.reaching
    count = len(body.chain.joints)
    way = body.chain.servo(start[:count], before(body, 0.6, 0.2, 0.7), rest[:count], stride=0.03)
    assert way is not None
    places = [body.gripper(posture).place for posture in way]
    assert max(math.dist(a, b) for a, b in zip(places, places[1:], strict=False)) <= 0.035
    assert math.dist(places[-1], before(body, 0.6, 0.2, 0.7)) <= 0.0051


@every_robot
def test_the_same_point_always_gives_the_same_postures(body) -> None:
    point = before(body, 0.6, 0.05, 1.0)
    first, second = list(islice(body.reach(point), 3)), list(islice(body.reach(point.copy()), 3))
    assert first
    assert np.array_equal(first, second)


@every_robot
@pytest.mark.parametrize("point", [(2.0, 0.0, 0.8), (0.5, 0.0, -0.1), (1.1, 0.0, 1.9)])
def test_a_point_out_of_reach_gives_no_posture(body, point) -> None:
    assert next(body.reach(np.array(point)), None) is None


@every_robot
def test_points_along_the_arm_end_at_the_gripper_and_leave_no_gap(body) -> None:
    posture = next(body.reach(before(body, 0.6, 0.1, 0.8)))
    points = body.arm(posture)
    assert np.allclose(points[-1], body.gripper(posture).place)
    assert np.linalg.norm(np.diff(points, axis=0), axis=1).max() <= 0.151


@every_robot
@given(target=st.tuples(st.floats(1.0, 4.0), st.floats(-1.0, 1.0), st.floats(0.1, 1.8)))
@settings(max_examples=20, deadline=None)
def test_the_head_turns_so_that_the_camera_faces_a_point(body, target) -> None:
    place, direction = body.camera(body.look_at(body.tucked, np.array(target)))
    line = np.array(target) - place
    angle = math.acos(min(float(line @ direction) / float(np.linalg.norm(line)), 1.0))
    assert math.degrees(angle) < 8


@pytest.mark.parametrize("name", usable_robots())
def test_each_robot_carries_and_hands_over_and_is_seen(name, tmp_path) -> None:
    with World(flat(), robot=name, frame_size=(64, 48)) as world:
        assert world.perform("robot", put("book_1", "kitchen_counter_1"), record=True).ok
        assert world.on("book", "kitchen_counter")
        assert len(world.frames(2, tmp_path)) == 4
        assert world.perform("robot", bring("mug")).ok
        assert world.holding("human", "mug")


def test_a_robot_that_does_not_exist_is_refused_with_those_that_do() -> None:
    with pytest.raises(ConfigError, match=f"robot: there is no robot 'tank' .known are {', '.join(known_robots())}"):
        World(flat(), robot="tank")
