from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from coopera.core.errors import ConfigError
from coopera.simulation.bodies.humanoid import ANKLE, forward
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.motions.smplx import COLUMNS, Capture, read_capture, retarget
from coopera.simulation.motions.user_folder import load_motions
from coopera.simulation.world import World
from tests.simulation.flat import flat, move

JOINTS = {"l_hip": 1, "l_knee": 4, "r_knee": 5, "l_shoulder": 16, "r_shoulder": 17, "l_elbow": 18, "r_elbow": 19}


def capture(frames: int = 4, root=(0.0, 0.0, 0.0), up="y", **turns) -> Capture:
    """A body that stands in the T-pose but for the given rotation vectors (in SMPL's axes: left, up, forward)."""
    data = np.zeros((frames, 22, 3))
    data[:, 0] = root
    for joint, turn in turns.items():
        data[:, JOINTS[joint]] = turn
    return Capture(data, np.zeros((frames, 3)), 30.0, up)


def body(**turns):
    return forward(retarget(capture(**turns))[0])


def direction(frames, start: str, end: str) -> np.ndarray:
    line = frames.place[end] - frames.place[start]
    return line / np.linalg.norm(line)


def test_the_t_pose_stands_on_the_floor_with_arms_sideways_facing_forward() -> None:
    frames = body()
    assert np.allclose(direction(frames, "left_shoulder", "left_hand"), (0, 1, 0), atol=1e-6)
    assert np.allclose(direction(frames, "right_shoulder", "right_hand"), (0, -1, 0), atol=1e-6)
    assert frames.place["left_ankle"][2] == pytest.approx(ANKLE, abs=1e-6)
    assert frames.place["head"][2] > 1.4
    assert np.allclose(frames.turn["pelvis"], np.eye(3), atol=1e-9)


@pytest.mark.parametrize(
    ("turns", "line", "expected"),
    [
        ({"l_shoulder": (0, 0, -math.pi / 2)}, ("left_shoulder", "left_elbow"), (0, 0, -1)),
        ({"r_shoulder": (0, 0, math.pi / 2)}, ("right_shoulder", "right_elbow"), (0, 0, -1)),
        ({"l_elbow": (0, -math.pi / 2, 0)}, ("left_elbow", "left_hand"), (1, 0, 0)),
        ({"r_elbow": (0, math.pi / 2, 0)}, ("right_elbow", "right_hand"), (1, 0, 0)),
        ({"l_hip": (-math.pi / 2, 0, 0)}, ("left_hip", "left_knee"), (1, 0, 0)),
        ({"l_knee": (math.pi / 2, 0, 0)}, ("left_knee", "left_ankle"), (-1, 0, 0)),
    ],
)
def test_each_limb_points_where_the_models_does(turns, line, expected) -> None:
    assert np.allclose(direction(body(**turns), *line), expected, atol=1e-6)


def test_random_poses_keep_the_direction_of_every_bone() -> None:
    rng = np.random.default_rng(3)
    turns = rng.normal(0.0, 0.5, size=(30, 22, 3))
    turns[:, 0] = 0
    poses = retarget(Capture(turns, np.zeros((30, 3)), 30.0, "y"))
    parents = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
    axes = np.array(((0.0, 0, 1), (1, 0, 0), (0, 1, 0)))
    for pose, row in zip(poses, turns, strict=True):
        whole: list[np.ndarray] = []
        for joint, parent in enumerate(parents):
            own = Rotation.from_rotvec(row[joint]).as_matrix()
            whole.append(own if parent < 0 else whole[parent] @ own)
        first = axes @ whole[0] @ axes.T
        level = math.atan2(first[1, 0], first[0, 0])
        turn = Rotation.from_euler("z", -level).as_matrix() @ axes
        frames = forward(pose)
        for side, out, arm, leg in (("left", 1, (16, 18), (1, 4)), ("right", -1, (17, 19), (2, 5))):
            for joint, part in zip(arm, ("shoulder", "elbow"), strict=True):
                end = "elbow" if part == "shoulder" else "hand"
                wanted = turn @ whole[joint] @ np.array((out, 0, 0))
                assert float(direction(frames, f"{side}_{part}", f"{side}_{end}") @ wanted) > 0.997
            for joint, part in zip(leg, ("hip", "knee"), strict=True):
                end = "knee" if part == "hip" else "ankle"
                wanted = turn @ whole[joint] @ np.array((0, -1, 0))
                assert float(direction(frames, f"{side}_{part}", f"{side}_{end}") @ wanted) > 0.997


def test_a_clip_in_a_world_whose_z_is_up_stands_too_and_its_heading_is_forgotten() -> None:
    upright = np.array((math.pi / 2, 0.0, 0.0))  # AMASS: the root turns SMPL's y up to the world's z
    frames = forward(retarget(capture(root=upright, up="z"))[0])
    assert frames.place["head"][2] > 1.4
    assert np.allclose(direction(frames, "left_shoulder", "left_hand"), (0, 1, 0), atol=1e-6)


def test_a_clip_that_is_upside_down_is_refused() -> None:
    with pytest.raises(ConfigError, match="upside down"):
        retarget(capture(root=(math.pi, 0.0, 0.0)))
    lying = capture(root=(-math.pi / 2, 0.0, 0.0))
    assert float(forward(retarget(lying)[0]).place["pelvis"][2]) < 0.3


def save_motion_x(path, frames: int = 30) -> None:
    rows = np.zeros((frames, COLUMNS), dtype=np.float32)
    rows[:, 3 + 3 * 15 + 2] = -1.2  # the left arm hangs
    rows[:, 3 + 3 * 16 + 2] = np.linspace(1.2, -1.2, frames)  # the right one is raised
    rows[:, 310] = 0.9
    np.save(path, rows)


def test_a_folder_of_clips_becomes_motions_that_a_text_finds_and_the_body_does(tmp_path) -> None:
    save_motion_x(tmp_path / "raise_the_right_hand.npy")
    save_motion_x(tmp_path / "b.npy")
    (tmp_path / "b.txt").write_text("Salute like a sailor.\nA second line.\n")
    turns = np.zeros((120, 156))
    turns[:, 0] = math.pi / 2
    np.savez(tmp_path / "c.npz", poses=turns, trans=np.zeros((120, 3)), mocap_framerate=120.0)
    (tmp_path / "motions.yaml").write_text(
        "c.npz: {caption: scare the birds away, class: stand about, posture: stand}\n"
    )
    library = load_motions(tmp_path)
    assert {"raise the right hand", "salute like a sailor", "scare the birds away"} <= set(library.captions)
    assert library.match("raise your right hand").caption == "raise the right hand"
    motion = library["raise the right hand"]
    early, late = (forward(pose_at(motion, t, Setting(0.0, 0.9, "stand"))) for t in (0.0, 0.95))
    assert late.place["right_hand"][2] > early.place["right_hand"][2] + 0.8
    assert motion.posture == "stand"
    with World(flat(), motions=library) as world:
        assert world.perform("human", move("sofa_1", "hat", "salute like a sailor"), record=True).ok
        assert world.state.person().motion == "salute like a sailor"


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda folder: None, "must be a folder with .npy or .npz clips"),
        (
            lambda folder: np.save(folder / "a.npy", np.zeros((5, 100))),
            r"a.npy must hold numbers of shape \(frames, 322\)",
        ),
        (lambda folder: np.save(folder / "a.npy", np.full((5, COLUMNS), np.nan)), "not finite"),
        (lambda folder: np.save(folder / "a.npy", np.zeros((1, COLUMNS))), "from 2 to 30000 frames"),
        (lambda folder: np.save(folder / "a.npy", np.array([{"x": 1}]), allow_pickle=True), "cannot be read"),
        (lambda folder: (folder / "a.npy").write_text("no array"), "cannot be read"),
        (lambda folder: (folder / "a.npz").write_text("no archive"), "cannot be read"),
        (lambda folder: np.savez(folder / "a.npz", poses=np.zeros((9, 156))), "must be an AMASS file"),
    ],
)
def test_a_folder_that_cannot_be_used_is_refused_with_the_file_and_the_reason(tmp_path, make, complaint) -> None:
    make(tmp_path)
    with pytest.raises(ConfigError, match=complaint):
        load_motions(tmp_path)


def test_an_upside_down_clip_names_its_file(tmp_path) -> None:
    rows = np.zeros((5, COLUMNS))
    rows[:, 0] = math.pi
    np.save(tmp_path / "upside_down.npy", rows)
    with pytest.raises(ConfigError, match=r"upside_down.npy cannot be used: the body is upside down"):
        load_motions(tmp_path)


def test_a_list_that_names_no_clip_or_a_wrong_posture_is_refused(tmp_path) -> None:
    save_motion_x(tmp_path / "a.npy")
    (tmp_path / "motions.yaml").write_text("b.npy: {caption: x}\n")
    with pytest.raises(ConfigError, match="'b.npy', which is no clip"):
        load_motions(tmp_path)
    (tmp_path / "motions.yaml").write_text("a.npy: {posture: fly}\n")
    with pytest.raises(ConfigError, match=r"field a.npy.posture"):
        load_motions(tmp_path)


def test_a_capture_is_read_with_its_rate(tmp_path) -> None:
    np.savez(
        tmp_path / "x.npz",
        root_orient=np.zeros((60, 3)),
        pose_body=np.zeros((60, 63)),
        trans=np.zeros((60, 3)),
        mocap_frame_rate=60.0,
    )
    found = read_capture(tmp_path / "x.npz")
    assert (found.fps, found.up, len(found.turns)) == (30.0, "z", 30)
