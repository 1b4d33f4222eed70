"""The mesh of a person: whole, carried by the body's parts, dressed, and the same each time."""

from __future__ import annotations

import numpy as np
import pytest

from coopera.simulation.bodies.humanoid import Aim, Frames, forward, solve
from coopera.simulation.people.appearance import Appearance, appearance_of
from coopera.simulation.people.clothes import Clothes
from coopera.simulation.people.skin import MATERIALS, PARTS, Skin, posed, skinned

JUMPER = (0.5, 0.1, 0.1)
TRUNKS = (0.1, 0.2, 0.4)
LOOKS = Appearance(
    day=Clothes("jumper", "trousers", "shoes", JUMPER, (0.2, 0.2, 0.3)),
    bath=Clothes(bottom="trunks", bottom_colour=TRUNKS),
)


def frames(**aim: object) -> Frames:
    return forward(solve(Aim(**aim))[0])  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def skin() -> Skin:
    return skinned(LOOKS, "day")


def test_all_that_a_skin_holds_fits_together(skin: Skin) -> None:
    count = len(skin.vertices)
    assert 3000 < count < 15000
    assert 5000 < len(skin.faces) < 20000
    assert skin.faces.max() == count - 1
    assert skin.normals.shape == skin.colours.shape == (count, 3)
    assert skin.parts.shape == skin.weights.shape == (count, 4)
    assert np.isfinite(skin.vertices).all()
    assert (skin.colours >= 0).all()
    assert (skin.colours <= 1).all()
    assert np.linalg.norm(skin.normals, axis=1) == pytest.approx(1.0, abs=1e-3)


def test_weights_sum_to_one(skin: Skin) -> None:
    assert skin.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-6)
    assert (skin.weights >= 0).all()
    assert skin.parts.max() < len(PARTS)


def test_in_the_rest_pose_nothing_moves(skin: Skin) -> None:
    vertices, normals = posed(skin, skin.rest)
    assert vertices == pytest.approx(skin.vertices, abs=1e-5)
    assert normals == pytest.approx(skin.normals, abs=1e-3)


def test_a_vertex_of_the_hand_follows_the_hand(skin: Skin) -> None:
    own = (skin.parts[:, 0] == PARTS.index("right_hand")) & (skin.weights[:, 0] == 1)
    assert own.sum() > 100
    now = frames(hands={"right": np.array((0.5, -0.15, 1.2))})
    vertices, _ = posed(skin, now)
    away = np.linalg.norm(vertices[own] - now.place["right_hand"], axis=1)
    assert away.max() < 0.13
    assert away.min() < 0.03


def test_a_person_is_as_tall_as_the_skeleton_and_stands_on_the_floor(skin: Skin) -> None:
    vertices, _ = posed(skin, frames())
    assert float(vertices[:, 2].min()) == pytest.approx(0.0, abs=0.02)
    assert 1.58 < float(vertices[:, 2].max()) < 1.70


def test_a_face_is_before_and_hair_is_above_and_behind(skin: Skin) -> None:
    head = skin.rest.place["head"]
    eyes = skin.vertices[skin.material == MATERIALS.index("eye")] - head
    assert (eyes[:, 0] > 0.04).all()
    hair = skin.vertices[skin.material == MATERIALS.index("hair")] - head
    assert hair[:, 0].min() < -0.09
    assert hair[:, 2].max() > 0.1


def test_faces_look_outwards(skin: Skin) -> None:
    corners = skin.vertices[skin.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    outwards = (across * skin.normals[skin.faces].mean(axis=1)).sum(axis=1) > 0
    assert np.average(outwards, weights=size) > 0.99


def test_the_elbow_and_the_knee_keep_their_thickness_when_bent(skin: Skin) -> None:
    """Seen along the hinge, a joint bent by a right angle is still at least two thirds as thick as at rest."""
    bent = frames(
        pelvis=(0.0, 0.0, 0.55), feet={"left": np.array((0.4, 0.1, 0.05)), "right": np.array((0.4, -0.1, 0.05))}
    )
    knee = (skin.weights[:, :2].max(axis=1) < 0.75) & np.isin(
        skin.parts[:, 0], [PARTS.index("left_knee"), PARTS.index("left_hip")]
    )
    knee &= np.linalg.norm(skin.vertices - skin.rest.place["left_knee"], axis=1) < 0.1
    assert knee.sum() > 10

    def thickness(vertices: np.ndarray, at: Frames) -> float:
        return float(np.linalg.norm(vertices[knee] - at.place["left_knee"], axis=1).mean())

    vertices, _ = posed(skin, bent)
    assert thickness(vertices, bent) > 0.67 * thickness(skin.vertices, skin.rest)


def test_the_bath_outfit_shows_no_jumper(skin: Skin) -> None:
    bath = skinned(LOOKS, "bath")

    def share(which: Skin, colour: tuple[float, float, float]) -> float:
        return float(np.isclose(which.colours, colour, atol=0.01).all(axis=1).mean())

    assert share(skin, JUMPER) > 0.1
    assert share(bath, JUMPER) == 0
    assert share(bath, TRUNKS) > 0.02
    assert share(bath, LOOKS.skin) > 2 * share(skin, LOOKS.skin)
    assert not (bath.material == MATERIALS.index("shoe")).any()


def test_the_same_looks_give_the_same_mesh_and_are_made_once() -> None:
    first = skinned(LOOKS, "day")
    assert skinned(LOOKS, "day") is first
    skinned.cache_clear()
    again = skinned(LOOKS, "day")
    assert again is not first
    assert np.array_equal(again.vertices, first.vertices)
    assert np.array_equal(again.faces, first.faces)
    assert np.array_equal(again.weights, first.weights)


@pytest.mark.parametrize("person", ["ada", "ben", "cleo"])
def test_nobody_has_holes_of_numbers(person: str) -> None:
    for outfit in ("day", "sleep"):
        made = skinned(appearance_of("", person), outfit)
        assert np.isfinite(made.vertices).all()
        assert np.isfinite(made.normals).all()
        assert made.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-6)
