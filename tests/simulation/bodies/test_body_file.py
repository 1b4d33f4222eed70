"""A robot's body of one's own: two files, wherever they stand."""

from __future__ import annotations

import math
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from coopera.core.errors import ConfigError
from coopera.simulation.bodies import robot
from coopera.simulation.bodies.robot import known_robots, load_robot, usable_robots
from coopera.simulation.sight.engine import load_urdf, pybullet
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, put

BODIES = Path(robot.__file__).parent


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A Fetch by another name, in a folder of its own."""
    for name in ("fetch.yaml", "fetch.urdf", "ball.obj"):
        shutil.copy(BODIES / name, tmp_path / name.replace("fetch", "mine"))
    return tmp_path / "mine.yaml"


def change(path: Path, field: str, value: Any) -> None:
    """Set a field by its dotted name; None takes it out."""
    data = yaml.safe_load(path.read_text())
    *way, last = (int(step) if step.isdigit() else step for step in field.split("."))
    part = data
    for step in way:
        part = part[step]
    if value is None:
        del part[last]
    else:
        part[last] = value
    path.write_text(yaml.safe_dump(data))


def rewrite(path: Path, old: str, new: str) -> None:
    """Put other text into a file's place; the old text has to be there."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def refusal(path: Path) -> str:
    """The one sentence with which a body is refused, without its folder."""
    with pytest.raises(ConfigError) as err:
        load_robot(str(path))
    return str(err.value).replace(f"{path.parent}/", "")


def test_a_body_elsewhere_is_named_by_its_path_and_works(mine: Path) -> None:
    body = load_robot(str(mine))
    assert (body.name, body.urdf.path) == ("mine", mine.with_suffix(".urdf"))
    assert np.array_equal(body.tucked, load_robot("fetch").tucked)
    with World(flat(), robot=str(mine), frame_size=(64, 48)) as world:
        assert world.perform("robot", bring("mug"), record=True).ok
        assert len(world.frames(1, mine.parent)) == 2


def test_two_files_in_the_folder_are_a_body_of_their_name(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, "_FOLDER", mine.parent)
    assert known_robots() == ["mine"]
    assert load_robot("mine").joints[0] == "torso_lift"


def test_ten_lines_are_a_robot(mine: Path) -> None:
    mine.write_text(
        """
arm:
  joints: [torso_lift, shoulder_pan, shoulder_lift, upperarm_roll, elbow_flex, forearm_roll, wrist_flex, wrist_roll]
  reach: 1.1
gripper: {link: wrist_roll, offset: [0.166, 0, 0]}
camera: {link: head_tilt}
postures:
  reaching: {shoulder_lift: -0.35, elbow_flex: 1.25, wrist_flex: 0.75}
  tucked: {shoulder_pan: 1.32, shoulder_lift: 1.4, elbow_flex: 1.72, wrist_flex: 1.66}
"""
    )
    with World(flat(), robot=str(mine)) as world:
        assert world.perform("robot", put("book_1", "kitchen_counter_1")).ok
        assert world.on("book", "kitchen_counter")


def test_a_body_whose_frame_is_elsewhere_stands_with_its_middle_on_the_floor(mine: Path) -> None:
    plain = load_robot("fetch")
    change(mine, "base", {"middle": [0.2, 0.0, -0.1]})
    moved = load_robot(str(mine))
    shift = np.array((-0.2, 0.0, 0.1))
    assert np.allclose(moved.gripper(moved.tucked).place, plain.gripper(plain.tucked).place + shift)
    assert np.allclose(moved.camera(moved.tucked)[0], plain.camera(plain.tucked)[0] + shift)
    client = pybullet.connect(pybullet.DIRECT)
    loaded = load_urdf(moved.urdf, client)
    names = [pybullet.getJointInfo(loaded, i, physicsClientId=client)[12] for i in range(2)]
    places = [pybullet.getLinkState(loaded, i, physicsClientId=client)[4] for i in range(2)]
    pybullet.disconnect(client)
    assert np.allclose(dict(zip(names, places, strict=True))[b"base"], shift)


def test_a_body_that_works_to_its_right_turns_its_right_to_the_thing(mine: Path) -> None:
    rewrite(
        mine.with_suffix(".urdf"), 'xyz="0.119525 0 0.34858" rpy="0 0 0"', 'xyz="0.0 -0.1 0.34858" rpy="0 0 -1.5707963"'
    )
    change(mine, "arm.pan", {"joint": "shoulder_pan"})
    change(mine, "base", {"works_at": -90})
    with World(flat(), robot=str(mine)) as world:
        assert world.perform("robot", put("book_1", "kitchen_counter_1")).ok
        body, counter = world.state.agents["robot"], world.layout.object("kitchen_counter_1")
        towards = math.atan2(counter.position[1] - body.spot[1], counter.position[0] - body.spot[0])
        assert math.cos(body.yaw - math.pi / 2 - towards) > 0.7


def test_joints_that_go_with_another_one_follow_it_in_every_posture(mine: Path) -> None:
    rewrite(
        mine.with_suffix(".urdf"),
        '<child link="right_finger"/>',
        '<child link="right_finger"/><mimic joint="left_finger" multiplier="2"/>',
    )
    change(mine, "gripper.joints", ["left_finger"])
    for posture in ("reaching", "tucked", "carrying"):
        data = yaml.safe_load(mine.read_text())
        change(mine, f"postures.{posture}.right_finger", None) if "right_finger" in data["postures"][posture] else None
    body = load_robot(str(mine))
    assert body.joints[-2:] == ("left_finger", "right_finger")
    assert body.tucked[-1] == pytest.approx(2 * body.tucked[-2])


@pytest.mark.parametrize(
    ("field", "value", "sentence"),
    [
        ("arm.reach", "far", "mine.yaml, field arm.reach: Input should be a valid number."),
        ("arm.reach", float("nan"), "mine.yaml, field arm.reach: Input should be a finite number."),
        ("gripper.offset", [1, 2], "mine.yaml, field gripper.offset.2: Field required."),
        ("gripper", None, "mine.yaml, field gripper: Field required."),
        ("camera", None, "mine.yaml, field camera: Field required."),
        ("colour", "red", "mine.yaml, field colour: Extra inputs are not permitted."),
        ("base", {"footprint": 0.5}, "mine.yaml, field base.footprint: Input should be less than or equal to 0.3."),
        ("arm.pan", {"joint": "neck"}, "mine.yaml: arm.pan.joint must be one of arm.joints, not 'neck'."),
        ("gripper.joints", ["elbow_flex"], "mine.yaml: the joint 'elbow_flex' is named twice."),
        (
            "postures.tucked.nose",
            1.0,
            "mine.yaml: postures.tucked names 'nose', which is none of the joints named above.",
        ),
        ("postures.carrying.elbow_flex", 7.0, "mine.yaml: postures.carrying has elbow_flex at 7, beyond its limits."),
        (
            "gripper.joints",
            ["left_finger", "right_finger", "wrist_rol"],
            "mine.yaml: the URDF has no joint 'wrist_rol' (did you mean wrist_roll?).",
        ),
        ("gripper.link", "hand", "mine.yaml, field gripper.link: the URDF has no link 'hand'."),
        (
            "camera.link",
            "head_tild",
            "mine.yaml, field camera.link: the URDF has no link 'head_tild' (did you mean head_tilt?).",
        ),
        (
            "gripper.link",
            "head_tilt",
            "mine.yaml, field arm.joints: the joint 'shoulder_pan' is not between the base and 'head_tilt'.",
        ),
        (
            "camera",
            {"link": "base", "pan": "head_pan", "tilt": "head_tilt"},
            "mine.yaml, field camera.pan: the joint 'head_pan' is not between the base and 'base'.",
        ),
        ("urdf", "yours.urdf", "yours.urdf: there is no such URDF."),
        (
            "urdf",
            {"package": "no-such-robot", "file": "a.urdf"},
            "mine.yaml: this robot's description is in the package no-such-robot, which is not installed "
            "(pip install --no-deps no-such-robot).",
        ),
        (
            "urdf",
            {"package": "numpy", "file": "../a.urdf"},
            "mine.yaml, field urdf.file: the path must lead down from site-packages.",
        ),
        (
            "urdf",
            {"package": "numpy", "file": "a.urdf"},
            "mine.yaml, field urdf.file: the package numpy has no file a.urdf.",
        ),
    ],
)
def test_a_wrong_field_is_named_with_its_file(mine: Path, field: str, value: Any, sentence: str) -> None:
    change(mine, field, value)
    assert refusal(mine) == sentence


def test_the_arms_joints_are_named_from_the_base_on(mine: Path) -> None:
    joints = yaml.safe_load(mine.read_text())["arm"]["joints"]
    change(mine, "arm.joints", joints[::-1])
    assert refusal(mine) == f"mine.yaml, field arm.joints: from the base on they are {', '.join(joints)}."


@pytest.mark.parametrize(
    "name",
    ["../of_another.obj", "{elsewhere}", "file://{elsewhere}", "package://{above}/of_another.obj", "link.obj"],
)
def test_a_mesh_elsewhere_on_the_disk_is_refused(mine: Path, name: str) -> None:
    folder = mine.parent / "robot"
    folder.mkdir()
    for file in (mine, mine.with_suffix(".urdf"), mine.with_name("ball.obj")):
        shutil.move(file, folder / file.name)
    elsewhere = mine.with_name("of_another.obj")
    shutil.copy(folder / "ball.obj", elsewhere)
    (folder / "link.obj").symlink_to(elsewhere)
    given = name.format(elsewhere=elsewhere, above=mine.parent.name)
    rewrite(folder / "mine.urdf", 'filename="ball.obj"', f'filename="{given}"')
    said = f"mine.urdf: the mesh {given!r} must lie in {folder}, the folder of this robot (or of its package.xml)."
    assert refusal(folder / "mine.yaml") == said


def test_a_mesh_beside_the_folder_is_of_the_package_that_holds_both(mine: Path) -> None:
    """As ROS has it: package.xml, urdf/ and meshes/ in one folder."""
    folder = mine.parent / "robot" / "urdf"
    folder.mkdir(parents=True)
    for file in (mine, mine.with_suffix(".urdf")):
        shutil.move(file, folder / file.name)
    (folder.parent / "meshes").mkdir()
    shutil.move(mine.with_name("ball.obj"), folder.parent / "meshes" / "ball.obj")
    (folder.parent / "package.xml").write_text("<package/>")
    for name in ("../meshes/ball.obj", "package://robot/meshes/ball.obj"):
        text = (folder / "mine.urdf").read_text()
        (folder / "mine.urdf").write_text(re.sub(r'filename="[^"]*ball.obj"', f'filename="{name}"', text))
        assert load_robot(str(folder / "mine.yaml")).urdf.links


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<robot name", "<mujoco name", "mine.urdf, line 96: this is not valid XML."),
        (
            'lower="-1.221"',
            'lower="nan"',
            "mine.urdf: limit lower of the joint 'shoulder_lift' must be a finite number, not 'nan'.",
        ),
        (
            'lower="-1.221"',
            'lower="2"',
            "mine.urdf: the joint 'shoulder_lift' cannot move: its limits are 2 and 1.518.",
        ),
        (
            'xyz="0.117 0 0.06"',
            'xyz="0.117 0"',
            "mine.urdf: origin xyz of the joint 'shoulder_lift' must be 3 finite numbers, not '0.117 0'.",
        ),
        (
            '<parent link="shoulder_pan"/>',
            '<parent link="nowhere"/>',
            "mine.urdf: the parent of the joint 'shoulder_lift' is the link 'nowhere', which is missing.",
        ),
        (
            '<child link="elbow_flex"/>',
            '<child link="head_pan"/>',
            "mine.urdf: the link 'head_pan' is the child of two joints.",
        ),
        (
            '<parent link="base"/>',
            '<parent link="elbow_flex"/>',
            "mine.urdf: the link 'elbow_flex' does not hang on the base 'base'.",
        ),
        (
            'name="shoulder_lift" type="revolute"',
            'name="shoulder_lift" type="floating"',
            "mine.yaml: the joint 'shoulder_lift' is of the type 'floating', which does not move.",
        ),
        (
            'filename="ball.obj"',
            'filename="ears.stl"',
            "mine.urdf: the mesh 'ears.stl' is missing; it must be in this file's folder.",
        ),
        (
            'filename="ball.obj"',
            'filename="package://fetch/ears.stl"',
            "mine.urdf: the mesh 'package://fetch/ears.stl' is missing; no folder above this file is called 'fetch'.",
        ),
        (
            'size="0.11 0.16 0.05"',
            'size="wide"',
            "mine.urdf: size of a box in the link 'head_pan' must be 3 finite numbers, not 'wide'.",
        ),
        (
            'radius="0.075"',
            'radius="inf"',
            "mine.urdf: radius of a cylinder in the link 'shoulder_pan' must be a finite number, not 'inf'.",
        ),
        (
            'scale="0.008 0.02 0.02"',
            'scale="0.008"',
            "mine.urdf: scale of a mesh in the link 'head_tilt' must be 3 finite numbers, not '0.008'.",
        ),
        ('rgba="0.', 'rgba="x 0.', "mine.urdf: the colour of the material 'white' must be 4 finite numbers."),
        ('<link name="elbow_flex">', '<link name="head_pan">', "mine.urdf: two links are called 'head_pan'."),
    ],
)
def test_what_is_wrong_in_a_description_is_named_with_its_place(mine: Path, old: str, new: str, sentence: str) -> None:
    rewrite(mine.with_suffix(".urdf"), old, new)
    assert refusal(mine) == sentence


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<mujoco model='x'><worldbody/></mujoco>", "mine.urdf: this is MJCF; only URDF is read."),
        ("<sdf version='1.7'/>", "mine.urdf: this is SDF; only URDF is read."),
        ("<html/>", "mine.urdf: a URDF begins with <robot>, not <html>."),
        (
            '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="a"/></robot>',
            "mine.urdf: this is xacro; make a URDF of it first (xacro FILE > robot.urdf).",
        ),
        ("<robot/>", "mine.urdf: exactly one link must be no joint's child, the base; here it is none."),
        ("<robot>" + "<link/>" * 2000 + "</robot>", "mine.urdf: it has 2000 links, and at most 1000 are read."),
        (
            "<robot>" + "<a>" * 99 + "</a>" * 99 + "</robot>",
            "mine.urdf: its elements lie more than 20 deep within each other.",
        ),
        (" " * (17 << 20), "mine.urdf: the URDF has more than 16 MiB, and at most that many are read."),
    ],
)
def test_what_is_no_urdf_is_refused(mine: Path, text: str, sentence: str) -> None:
    mine.with_suffix(".urdf").write_text(text)
    assert refusal(mine) == sentence


@pytest.mark.parametrize("name", sorted(set(known_robots()) - set(usable_robots())))
def test_a_robot_whose_package_is_not_installed_is_refused_with_the_package_to_install(name: str) -> None:
    with pytest.raises(ConfigError, match=r"which is not installed \(pip install --no-deps [\w-]+\)"):
        load_robot(name)


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        (
            "mine.yaml",
            "about: a\nabout: b",
            "mine.yaml, line 2: this is not valid YAML ('about' stands twice).",
        ),
        ("mine.yaml", "!!python/object:os.system {}", "mine.yaml, line 1: this is not valid YAML (a tag"),
        ("mine.yaml", "a robot", "mine.yaml: Input should be a valid dictionary"),
        ("mine.yaml", "[" * 9999, "mine.yaml, line 1: this is not valid YAML (it is nested more than 64 deep)."),
        ("mine.urdf", "<robot>", "mine.urdf, line 1: this is not valid XML."),
    ],
)
def test_a_file_that_is_none_is_refused(mine: Path, name: str, text: str, sentence: str) -> None:
    (mine.parent / name).write_text(text)
    with pytest.raises(ConfigError) as err:
        load_robot(str(mine))
    assert str(err.value).startswith(f"{mine.parent}/{sentence}")


def test_a_body_without_shapes_and_one_that_is_not_there_are_refused(mine: Path) -> None:
    mine.with_suffix(".urdf").unlink()
    assert refusal(mine) == "mine.urdf: there is no such URDF."
    with pytest.raises(ConfigError, match=r"yours.yaml: there is no such file"):
        load_robot("yours.yaml")
    with pytest.raises(ConfigError, match=r"no robot 'husky' \(did you mean husky_panda\? known are fetch"):
        load_robot("husky")


def test_shapes_that_the_engine_cannot_load_are_refused(mine: Path) -> None:
    rewrite(mine.with_suffix(".urdf"), 'cylinder radius="0.28" length="0.36"', 'blob size="1"')
    with World(flat(), robot=str(mine)) as world:
        world.perform("robot", bring("mug"), record=True)
        with pytest.raises(ConfigError, match=r"mine.urdf: pybullet cannot load this URDF"):
            world.percept(np.random.default_rng(0))
