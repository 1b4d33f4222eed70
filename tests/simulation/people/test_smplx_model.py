"""Body models that the user has: an .npz of the published layout in our skeleton, or one sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.core.people import Looks
from coopera.simulation.bodies.humanoid import Aim, forward, solve
from coopera.simulation.people.appearance import BODIES, appearance_of
from coopera.simulation.people.figure import Measures
from coopera.simulation.people.skin import MATERIALS, PARTS, posed, skinned
from coopera.simulation.people.smplx_model import fitted, read_model, rest_upright
from tests.simulation.people.smplx_file import arrays, write_model


def test_the_models_joints_come_to_those_of_our_skeleton(tmp_path: Path) -> None:
    vertices, _, rest = fitted(read_model(write_model(tmp_path)), Measures())
    joints = arrays()["J_regressor"] @ vertices
    for joint, part in ((16, "left_shoulder"), (19, "right_elbow"), (4, "left_knee"), (8, "right_ankle"), (12, "neck")):
        assert joints[joint] == pytest.approx(rest.place[part], abs=0.002)
    assert rest.place["left_elbow"][1] > 0.4, "the arms are out at rest"


def test_a_hand_of_the_model_follows_the_hand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_model(tmp_path)
    monkeypatch.setenv(BODIES, str(tmp_path))
    skin = skinned(appearance_of("", "somebody-with-a-model"), "day")
    aim = Aim(hands={"right": np.array((0.45, -0.2, 1.1))})
    frames = forward(solve(aim)[0])
    vertices, _ = posed(skin, frames)
    hand = vertices[6 * 21 : 6 * 22]
    wrist = frames.point("right_elbow", 0.0, 0.0, -0.258947)
    assert hand.mean(axis=0) == pytest.approx(wrist, abs=0.005)


def test_a_model_is_painted_with_clothes_and_its_weights_sum_to_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_model(tmp_path)
    monkeypatch.setenv(BODIES, str(tmp_path))
    looks = appearance_of("", "painted", Looks(figure="man"))
    day, bath = skinned(looks, "day"), skinned(looks, "bath")
    chest = PARTS.index("chest")
    on_chest = (day.parts[:, 0] == chest) & (day.weights[:, 0] > 0.9)
    assert (day.material[on_chest] == MATERIALS.index("cloth")).any()
    assert (bath.material[on_chest] == MATERIALS.index("skin")).all()
    assert day.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-6)


def test_the_figures_own_model_is_taken_before_the_neutral_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_model(tmp_path)
    female = write_model(tmp_path, "SMPLX_FEMALE.npz")
    monkeypatch.setenv(BODIES, str(tmp_path))
    assert appearance_of("", "a", Looks(figure="woman")).model == female
    man = appearance_of("", "a", Looks(figure="man")).model
    assert man is not None
    assert man.name == "SMPLX_NEUTRAL.npz"


def test_a_folder_without_a_model_is_refused_in_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(BODIES, str(tmp_path / "nowhere"))
    with pytest.raises(ConfigError, match=r"^COOPERA_BODIES: .*nowhere must be a folder with SMPLX_FEMALE\.npz.*\.$"):
        appearance_of("", "nobody-here")


_WRONG = {
    "weights": (np.ones((330, 24)), r"weights must have shape \(vertices, 55\), not \(330, 24\)"),
    "v_template": (np.zeros((330, 2)), r"v_template must have shape \(vertices, 3\)"),
    "J_regressor": (np.zeros((24, 330)), r"J_regressor must have shape \(55, vertices\)"),
    "shapedirs": (np.zeros((330, 3)), r"shapedirs must have shape \(vertices, 3, 10\)"),
    "kintree_table": (np.zeros((2, 24)), r"kintree_table must have shape \(2, 55\)"),
    "f": (np.full((3, 3), 9999), r"f must count its 330 vertices, but goes to 9999"),
}


@pytest.mark.parametrize("name", _WRONG)
def test_an_array_of_the_wrong_shape_is_refused_in_a_sentence(tmp_path: Path, name: str) -> None:
    wrong, said = _WRONG[name]
    with pytest.raises(ConfigError, match=rf"^The body model .*SMPLX_NEUTRAL\.npz: {said}.*\.$"):
        read_model(write_model(tmp_path, **{name: wrong}))


def test_a_missing_array_and_a_number_that_is_none_are_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="has no shapedirs"):
        read_model(write_model(tmp_path, shapedirs=None))
    bad = arrays()["v_template"]
    bad[0, 0] = np.nan
    (tmp_path / "other").mkdir()
    with pytest.raises(ConfigError, match="v_template must hold finite numbers"):
        read_model(write_model(tmp_path / "other", v_template=bad))


def test_pickled_objects_in_a_model_are_not_opened(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"The body model .* cannot be read: it must hold numbers"):
        read_model(write_model(tmp_path, f=np.array([object()], dtype=object)))


def test_the_model_rests_as_our_body_with_its_arms_out() -> None:
    rest = rest_upright()
    left, right = rest.place["left_hand"], rest.place["right_hand"]
    assert left[1] == pytest.approx(-right[1])
    assert left[2] == pytest.approx(rest.place["left_shoulder"][2])
