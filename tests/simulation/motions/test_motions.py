from __future__ import annotations

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.simulation.bodies.humanoid import SIDES, forward
from coopera.simulation.motions.library import FALLBACK, FOLDER, along, load_library
from coopera.simulation.motions.poses import Setting, pose_at

LIBRARY = load_library()
SETTINGS = {
    "stand": Setting(0.0, 0.9, "stand"),
    "sit": Setting(0.45, 0.75, "sit"),
    "lie": Setting(0.5, None, "lie"),
    "floor": Setting(0.0, None, "floor"),
}
CAPTIONS = LIBRARY.captions


def moments(caption: str):
    motion = LIBRARY[caption]
    return [forward(pose_at(motion, share * motion.keys.period, SETTINGS[motion.posture])) for share in (0, 0.3, 0.6)]


def test_the_library_is_about_as_rich_as_promised_and_no_class_gives_a_caption_away() -> None:
    assert len(CAPTIONS) >= 40
    assert 10 <= len(LIBRARY.classes) <= 15
    assert not set(LIBRARY.classes) & set(CAPTIONS)


@pytest.mark.parametrize("caption", CAPTIONS)
def test_no_part_of_the_body_sinks_into_the_floor(caption) -> None:
    for frames in moments(caption):
        assert min(float(place[2]) for place in frames.place.values()) > -0.03


@pytest.mark.parametrize("caption", [c for c in CAPTIONS if LIBRARY[c].posture == "sit"])
@pytest.mark.parametrize("seat", [0.4, 0.5])
def test_who_sits_has_the_pelvis_just_above_the_seat_and_the_knees_in_front(caption, seat) -> None:
    frames = forward(pose_at(LIBRARY[caption], 0.4, Setting(seat, None, "sit")))
    assert seat + 0.05 < float(frames.place["pelvis"][2]) < seat + 0.2
    assert all(frames.place[f"{side}_knee"][0] > frames.place["pelvis"][0] + 0.3 for side in SIDES)


@pytest.mark.parametrize("caption", [c for c in CAPTIONS if LIBRARY[c].posture == "lie"])
def test_who_lies_has_the_feet_ahead_of_the_head_and_the_back_on_the_bed(caption) -> None:
    for frames in moments(caption):
        assert frames.place["left_ankle"][0] - frames.place["head"][0] > 1.0
        assert 0.5 < float(frames.place["pelvis"][2]) < 0.75


@pytest.mark.parametrize("caption", [c for c in CAPTIONS if LIBRARY[c].cls == "groom the face or hair"])
def test_grooming_brings_a_hand_to_the_head(caption) -> None:
    gaps = [np.linalg.norm(f.place["right_hand"] - f.place["head"]) for f in moments(caption)]
    assert min(gaps) < 0.26


@pytest.mark.parametrize("caption", [c for c in CAPTIONS if LIBRARY[c].cls == "work with the hands at a surface"])
def test_work_at_a_surface_happens_just_above_it_unless_it_is_done_in_the_air(caption) -> None:
    if caption == "knit and sew":
        return
    top = SETTINGS[LIBRARY[caption].posture].worktop
    lowest = min(float(f.place[f"{side}_hand"][2]) for f in moments(caption) for side in SIDES)
    assert top is not None
    assert top < lowest < top + 0.3


def test_every_motion_moves() -> None:
    for motion in LIBRARY.motions:
        setting = SETTINGS[motion.posture]
        first = pose_at(motion, 0.0, setting)
        later = [pose_at(motion, share * motion.keys.period, setting) for share in (0.2, 0.5, 0.7)]
        assert max(float(np.abs(pose - first).max()) for pose in later) > 5e-3, motion.caption


def test_who_wants_to_sit_where_there_is_no_seat_stands() -> None:
    frames = forward(pose_at(LIBRARY["eat a meal"], 0.0, Setting(0.0, 0.9, "stand")))
    assert float(frames.place["pelvis"][2]) > 0.8


@pytest.mark.parametrize(
    ("text", "caption"),
    [
        ("Sit and read ", "sit and read"),
        ("reading a novel while sitting", "sit and read"),
        ("brushes her teeth thoroughly", "brush teeth"),
        ("stirring the pot", "stir a pot"),
        ("types on the keyboard", "type on a keyboard"),
        ("sweeps the floor", "sweep the floor"),
        ("fly to the moon", FALLBACK),
        ("", FALLBACK),
    ],
)
def test_a_free_text_means_the_motion_that_shares_its_words(text, caption) -> None:
    assert LIBRARY.match(text).caption == caption


def test_who_ranks_captions_by_meaning_decides_unless_the_text_is_one_of_them() -> None:
    def nearest(_: str) -> list[tuple[str, float]]:
        return [("levitate", 0.9), ("eat a meal", 0.8), ("dance", 0.1)]

    assert [meant[:2] for meant in LIBRARY.ranked("have a bite", nearest)] == [("eat a meal", 0.8), ("dance", 0.1)]
    assert [meant[:2] for meant in LIBRARY.ranked("dance", nearest)] == [("dance", 1.0)]


def test_a_class_is_only_confused_with_classes_that_look_possible_in_that_posture() -> None:
    others = LIBRARY.confusable(LIBRARY["lie down"])
    assert others == ["look at something held"]
    for motion in LIBRARY.motions:
        assert motion.cls not in LIBRARY.confusable(motion)


def test_a_closed_path_passes_through_its_points_and_one_point_stands_still() -> None:
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 2.0), (0.0, 3.0, 0.0)]
    for i, point in enumerate(points):
        assert np.allclose(along(points, i / 3), point)
    assert np.allclose(along(points, 1.0), points[0])
    assert np.allclose(along((1.0, 2.0, 3.0), 0.37), (1, 2, 3))


@pytest.mark.parametrize(
    ("keys", "complaint"),
    [
        ("bounce: {period: 1}", "bounce"),
        ("sit and rest: {period: -1}", "sit and rest.*period"),
        ("sit and rest: {right: [nose, [0, 0, 0]]}", "sit and rest.*right"),
        ("- a list", "mapping"),
        ("sit and rest: {period: [", "cannot be read"),
    ],
)
def test_an_unusable_motion_file_is_refused_with_its_field(tmp_path, keys, complaint) -> None:
    listing = "motions:\n  - {caption: sit and rest, class: sit quietly, posture: sit}\n"
    (tmp_path / "motions.yaml").write_text(listing)
    (tmp_path / "motion_keys.yaml").write_text(keys)
    with pytest.raises(ConfigError, match=f"(?s){complaint}"):
        load_library(tmp_path)


def test_the_shipped_files_name_every_motion_once() -> None:
    assert len({motion.caption for motion in LIBRARY.motions}) == len(LIBRARY.motions)
    assert (FOLDER / "motions.yaml").read_text().count("caption:") == len(LIBRARY.motions)
