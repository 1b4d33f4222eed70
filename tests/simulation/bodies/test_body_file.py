"""A robot's body of one's own: two files, wherever they stand."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from coopera.core.errors import ConfigError
from coopera.simulation.bodies import robot
from coopera.simulation.bodies.robot import known_robots, load_robot
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat

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


def test_a_body_elsewhere_is_named_by_its_path_and_works(mine: Path) -> None:
    body = load_robot(str(mine))
    assert (body.name, body.urdf) == ("mine", mine.with_suffix(".urdf"))
    assert np.array_equal(body.tucked, load_robot("fetch").tucked)
    with World(flat(), robot=str(mine), frame_size=(64, 48)) as world:
        assert world.perform("robot", bring("mug"), record=True).ok
        assert len(world.frames(1, mine.parent)) == 2


def test_two_files_in_the_folder_are_a_body_of_their_name(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot, "_FOLDER", mine.parent)
    assert known_robots() == ["mine"]
    assert load_robot("mine").joints[0] == "torso_lift"


@pytest.mark.parametrize(
    ("field", "value", "sentence"),
    [
        ("farthest", "far", "mine.yaml, field farthest: Input should be a valid number."),
        ("farthest", float("nan"), "mine.yaml, field farthest: Input should be a finite number."),
        ("tip", [1, 2], r"mine.yaml, field tip.2: Field required."),
        ("head", None, "mine.yaml, field head: Field required."),
        ("colour", "red", "mine.yaml, field colour: Extra inputs are not permitted."),
        ("joints.2.axis", "w", "mine.yaml, field joints.2.axis: Input should be 'x', 'y' or 'z'."),
        ("joints.1.low", 9.0, "mine.yaml, field joints.1: low must be below high, and 9 is not below 1.6056."),
        ("joints.1.name", "elbow_flex", "mine.yaml: pan.joint must be one of the joints, not 'shoulder_pan'."),
        ("fingers", ["elbow_flex", "right_finger"], "mine.yaml: two joints are called 'elbow_flex'."),
        ("joints.0.slides", False, "mine.yaml: head.lifted needs a first joint that slides."),
        ("postures.tucked.joints", [0.0], "mine.yaml: postures.tucked.joints must have 8 numbers, not 1."),
        ("postures.carrying.joints.4", 7.0, "mine.yaml: postures.carrying has elbow_flex at 7, beyond its limits."),
        ("joints.7.name", "wrist", "mine.urdf: the joint 'wrist', which mine.yaml names, is missing."),
    ],
)
def test_a_wrong_field_is_named_with_its_file(mine: Path, field: str, value: Any, sentence: str) -> None:
    change(mine, field, value)
    with pytest.raises(ConfigError) as err:
        load_robot(str(mine))
    assert str(err.value) == f"{mine.parent}/{sentence}"


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        (
            "mine.yaml",
            "lift: 0\nlift: 1",
            "mine.yaml, line 2: this is not valid YAML ('lift' stands twice).",
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
    (mine.parent / "ball.obj").unlink()
    with pytest.raises(ConfigError, match=r"mine.urdf: the mesh 'ball.obj' is missing"):
        load_robot(str(mine))
    mine.with_suffix(".urdf").unlink()
    with pytest.raises(ConfigError, match=r"mine.urdf: there is no such file"):
        load_robot(str(mine))
    with pytest.raises(ConfigError, match=r"yours.yaml: there is no such file"):
        load_robot("yours.yaml")
    with pytest.raises(ConfigError, match=r"no robot 'husky' \(did you mean husky_panda\? known are fetch"):
        load_robot("husky")


def test_shapes_that_the_engine_cannot_load_are_refused(mine: Path) -> None:
    urdf = mine.with_suffix(".urdf")
    urdf.write_text(urdf.read_text().replace('<parent link="base"/>', '<parent link="nowhere"/>'))
    with (
        World(flat(), robot=str(mine)) as world,
        pytest.raises(ConfigError, match=r"mine.urdf: pybullet cannot load this URDF"),
    ):
        world.perform("robot", bring("mug"), record=True)
