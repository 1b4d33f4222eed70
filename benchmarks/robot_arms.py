"""Solvers of inverse kinematics on the robots' arms: how many points each gets to, and in what time.

    python -m benchmarks.robot_arms [--points 200] [--robots fetch,stretch] [--solvers ours,pybullet]

The points are where the gripper is in random postures, between floor and 1.8 m and within the robot's reach: all can
be got to. Every solver starts at the robot's resting posture, turned and raised towards the point as `Chain.reach` does
it, and then from eleven random postures, the same for all. It has got there when its posture, by our forward
kinematics, has the gripper within 5 mm of the point and no joint beyond its limits. Times are processor time of this
process.

Solvers that are not installed are left out. `pinocchio` (pip install pin) is the damped loop of its documentation on
its Jacobians; `mink` is its frame task with limits as quadratic programs of daqp, on the same URDF in MuJoCo. The size
is what its packages take that this project does not need anyway.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, distribution
from importlib.util import find_spec
from typing import Any, TypeAlias
from xml.etree import ElementTree

import numpy as np

from coopera.core.randomness import rng_at
from coopera.simulation.bodies.manipulator import MobileManipulator
from coopera.simulation.bodies.robot import load_robot, usable_robots
from coopera.simulation.bodies.urdf import Urdf
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.sight.engine import load_urdf, pybullet, quiet

Solve: TypeAlias = Callable[[Array, Array], Array]
"""From a starting posture of the arm and a point to a posture, good or bad."""
STARTS = 12
NEAR = 0.005
STEPS = 60
_LINK = "link_of_"
PACKAGES = {
    "ours": (),
    "pybullet": (),
    "pinocchio": (
        *("pin", "libpinocchio", "libcoal", "coal", "eigenpy", "cmeel", "cmeel-boost", "cmeel-eigen", "cmeel-assimp"),
        *("cmeel-octomap", "cmeel-qhull", "cmeel-tinyxml2", "cmeel-urdfdom", "cmeel-console-bridge", "cmeel-zlib"),
    ),
    "mink": ("mink", "mujoco", "mujoco-core", "mujoco-studio", "PyOpenGL", "glfw", "daqp", "qpsolvers"),
}


def ours(body: MobileManipulator) -> Solve:
    """The damped steps of `Chain.servo`, drawn towards the resting posture."""
    rest = body.reaching[: len(body.chain.joints)]

    def solve(start: Array, point: Array) -> Array:
        way = body.chain.servo(start, point, rest)
        return start if way is None else way[-1]

    return solve


def of_pybullet(body: MobileManipulator) -> Solve:
    """`calculateInverseKinematics` with limits and the resting posture, three times on from what it found."""
    client = pybullet.connect(pybullet.DIRECT)
    loaded = load_urdf(_with_tip(body), client, drawn=False)
    count = pybullet.getNumJoints(loaded, physicsClientId=client)
    infos = [pybullet.getJointInfo(loaded, i, physicsClientId=client) for i in range(count)]
    number = {info[1].decode(): info[0] for info in infos}
    moving = [info[1].decode() for info in infos if info[3] > -1]
    names = [joint.name for joint in body.chain.joints]
    low, high = (
        np.array([dict(zip(names, values, strict=True)).get(name, other) for name in moving])
        for values, other in ((body.chain.low, -1.0), (body.chain.high, 1.0))  # without a range pybullet hangs
    )
    rest = np.array([dict(zip(body.joints, body.reaching, strict=True)).get(name, 0.0) for name in moving])
    bounds = {"lowerLimits": low.tolist(), "upperLimits": high.tolist(), "jointRanges": (high - low).tolist()}
    given = {**bounds, "restPoses": rest.tolist(), "maxNumIterations": 2 * STEPS, "residualThreshold": NEAR / 10}

    def solve(start: Array, point: Array) -> Array:
        posture = start
        for _ in range(3):
            for name, value in zip(names, posture, strict=True):
                pybullet.resetJointState(loaded, number[name], float(value), physicsClientId=client)
            found = pybullet.calculateInverseKinematics(
                loaded, number["tip"], point.tolist(), physicsClientId=client, **given
            )
            every = dict(zip(moving, found, strict=True))
            posture = np.array([every[name] for name in names])
            if np.linalg.norm(body.chain.forward(posture).place - point) < NEAR:
                break
        return posture

    return solve


def _with_tip(body: MobileManipulator) -> Urdf:
    """The description with a link at the point between the fingers."""
    root = deepcopy(body.urdf.root)
    last = body.urdf.hinges[body.chain.joints[-1].name].child
    place = " ".join(map(str, body.chain.tip.tolist()))
    root.append(ElementTree.fromstring('<link name="tip"/>'))
    root.append(
        ElementTree.fromstring(
            f'<joint name="tip" type="fixed"><parent link="{last}"/><child link="tip"/><origin xyz="{place}"/></joint>'
        )
    )
    return replace(body.urdf, root=root)


def pinocchio(body: MobileManipulator) -> Solve:
    """Damped steps on its Jacobian, kept within the limits, as its examples do it."""
    import pinocchio as pin  # noqa: PLC0415 - only where it is installed

    model = pin.buildModelFromXML(_bare(body))
    joints = [joint.name for joint in body.chain.joints]
    model = pin.buildReducedModel(
        model, [model.getJointId(name) for name in model.names[1:] if name not in joints], pin.neutral(model)
    )
    data, last = model.createData(), model.getJointId(joints[-1])
    frame = model.addFrame(pin.Frame("tip", last, 0, pin.SE3(np.eye(3), body.chain.tip), pin.FrameType.OP_FRAME))
    data = model.createData()
    at = [(model.joints[model.getJointId(name)].idx_q, model.joints[model.getJointId(name)].nq) for name in joints]
    speeds = [model.joints[model.getJointId(name)].idx_v for name in joints]

    def solve(start: Array, point: Array) -> Array:
        posture, q = start.copy(), pin.neutral(model)
        for _ in range(STEPS):
            for (i, width), value in zip(at, posture, strict=True):
                q[i : i + width] = value if width == 1 else (np.cos(value), np.sin(value))
            pin.computeJointJacobians(model, data, q)
            pin.updateFramePlacement(model, data, frame)
            error = point - data.oMf[frame].translation
            if np.linalg.norm(error) < NEAR / 2:
                break
            jacobian = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)[:3][:, speeds]
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-3 * np.eye(3), error)
            posture = np.clip(posture + np.clip(step, -0.35, 0.35), body.chain.low, body.chain.high)
        return posture

    return solve


def mink(body: MobileManipulator) -> Solve:
    """A frame task, a resting posture and the joints' limits as quadratic programs."""
    import mink as ik  # noqa: PLC0415 - only where it is installed
    import mujoco  # noqa: PLC0415 - only where it is installed

    spec = mujoco.MjSpec.from_string(_bare(body))
    names = [joint.name for joint in body.chain.joints]
    for joint in spec.joints:
        if joint.name not in names:
            spec.delete(joint)
    end = _LINK + body.urdf.hinges[names[-1]].child
    spec.body(end).add_site(name="tip", pos=body.chain.tip.tolist())
    model = spec.compile()
    task = ik.FrameTask("tip", "site", position_cost=1.0, orientation_cost=0.0, lm_damping=1e-3)
    still, limits = ik.PostureTask(model, cost=1e-3), [ik.ConfigurationLimit(model)]
    at = [model.jnt_qposadr[model.joint(name).id] for name in names]
    round_and_round = [body.urdf.hinges[name].kind == "continuous" for name in names]
    still.set_target(_spread(model.nq, at, body.reaching[: len(at)]))

    def solve(start: Array, point: Array) -> Array:
        now = ik.Configuration(model, _spread(model.nq, at, start))
        task.set_target(ik.SE3.from_translation(point))
        for _ in range(STEPS):
            try:
                now.integrate_inplace(ik.solve_ik(now, [task, still], 1.0, "daqp", limits=limits), 1.0)
            except ik.exceptions.NoSolutionFound:
                break
            if np.linalg.norm(now.get_transform_frame_to_world("tip", "site").translation() - point) < NEAR / 2:
                break
        turned = np.where(round_and_round, np.remainder(now.q[at] + np.pi, 2 * np.pi) - np.pi, now.q[at])
        within: Array = np.clip(turned, body.chain.low, body.chain.high)
        return within

    return solve


def _spread(count: int, at: list[int], values: Array) -> Array:
    found = np.zeros(count)
    found[at] = values
    return found


def _bare(body: MobileManipulator) -> str:
    """The description without shapes, which MuJoCo would look for, and with no link called as a joint is."""
    root = ElementTree.fromstring(body.urdf.text)
    for link in root.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
        link.set("name", _LINK + link.get("name", ""))
    for end in [*root.iterfind("joint/parent"), *root.iterfind("joint/child")]:
        end.set("link", _LINK + end.get("link", ""))
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", {"fusestatic": "false"})
    return ElementTree.tostring(root, encoding="unicode")


SOLVERS: dict[str, tuple[str, Callable[[MobileManipulator], Solve]]] = {
    "ours": ("numpy", ours),
    "pybullet": ("pybullet", of_pybullet),
    "pinocchio": ("pinocchio", pinocchio),
    "mink": ("mink", mink),
}


def points_of(body: MobileManipulator, count: int) -> list[Array]:
    """Points that the gripper can be at, the same for the same robot."""
    rng, found = rng_at(0, "robot_arms", body.name), list[Array]()
    while len(found) < count:
        point = body.chain.forward(rng.uniform(body.chain.low, body.chain.high)).place
        if 0.05 < point[2] < 1.8 and 0.3 < float(np.hypot(point[0], point[1])) < body.farthest:
            found.append(point)
    return found


def starts_of(body: MobileManipulator, point: Array) -> Iterator[Array]:
    """Where each solver starts."""
    yield body.chain.start(point, body.reaching[: len(body.chain.joints)])
    rng = rng_at(0, "robot_arms", body.name, *point.round(3).tolist())
    for _ in range(STARTS - 1):
        yield rng.uniform(body.chain.low, body.chain.high)


def measure(body: MobileManipulator, solve: Solve, points: list[Array]) -> tuple[float, float, float]:
    """Shares of points got to at the first start and at any, and milliseconds of processor time for a point."""
    first = ever = 0
    before = time.process_time()
    for point in points:
        for number, start in enumerate(starts_of(body, point)):
            posture = solve(start, point)
            within = (posture >= body.chain.low - 1e-6).all() and (posture <= body.chain.high + 1e-6).all()
            if within and np.linalg.norm(body.chain.forward(posture).place - point) <= NEAR + 1e-6:
                first, ever = first + (number == 0), ever + 1
                break
    spent = time.process_time() - before
    return first / len(points), ever / len(points), 1000 * spent / len(points)


def size_of(solver: str) -> float:
    """MB that its packages take; 0 where they are this project's anyway."""
    whole = 0.0
    for package in PACKAGES[solver]:
        try:
            files: Any = distribution(package).files or []
        except PackageNotFoundError:
            continue
        whole += sum(path.stat().st_size for file in files if (path := file.locate()).is_file())
    return whole / 1e6


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--robots", default=",".join(usable_robots()))
    parser.add_argument("--solvers", default=",".join(SOLVERS))
    args = parser.parse_args()
    print(f"{'robot':12} {'solver':10} {'first start':>11} {'all starts':>10} {'ms a point':>10} {'MB':>6}")
    for robot in args.robots.split(","):
        body: Any = load_robot(robot)
        points = points_of(body, args.points)
        for solver in args.solvers.split(","):
            package, make = SOLVERS[solver]
            if find_spec(package) is None:
                continue
            with quiet():
                solve = make(body)
            first, ever, spent = measure(body, solve, points)
            print(f"{robot:12} {solver:10} {first:11.1%} {ever:10.1%} {spent:10.2f} {size_of(solver):6.0f}", flush=True)


if __name__ == "__main__":
    main()
