"""Where things are while something is done with them, for all motions and their usual things, from the poses alone."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import yaml

from coopera import models
from coopera.core.affordances import affordances
from coopera.simulation.bodies.humanoid import MOUTH, forward
from coopera.simulation.homes.catalogue import parts_of
from coopera.simulation.homes.magic_box import Shape, shape_of
from coopera.simulation.motions.holding import LAP, Grip, Worktop, grip, held_at, lies
from coopera.simulation.motions.library import Motion, load_library
from coopera.simulation.motions.poses import Setting, pose_at, working_height
from coopera.simulation.motions.worn import worn_at
from coopera.simulation.shapes.rotations import Array, matrix

LIBRARY = load_library()
HOUSEHOLD = Path(models.__path__[0]) / "offline" / "household.yaml"
SETTINGS = {
    "stand": Setting(0.0, 0.9, "stand"),
    "sit": Setting(0.45, 0.75, "sit"),
    "lie": Setting(0.5, None, "lie"),
    "floor": Setting(0.0, None, "floor"),
}
TABLE = Worktop(0.58, 0.0, 0.0, 0.3, 0.6)
AT_HAND = 0.0801  # eight centimetres, whichever processor works them out
"""The middle of a hand is at most this far from what it holds (metres)."""
OVER_A_POT = 0.12
"""Who stirs may have the length of a spoon between the hand and the bowl."""
ON_THE_KEYS = 0.04
TOUCHES = 0.03
SHARES = np.arange(12) / 12


def usual() -> list[tuple[str, str]]:
    activities = yaml.safe_load(HOUSEHOLD.read_text(encoding="utf-8"))["activities"]
    pairs = {(motion, thing) for row in activities for thing, motion in row["things"].items()}
    return sorted(pair for pair in pairs if pair[0] in LIBRARY)


class Scene:
    """A motion at a usual table or lap, with a thing: the grip, and where hands and thing are over a cycle."""

    def __init__(self, caption: str, thing: str, setting: Setting | None = None, top: Worktop | None = TABLE) -> None:
        self.motion: Motion = LIBRARY[caption]
        self.shape: Shape = shape_of(thing)
        start = setting or SETTINGS[self.motion.posture]
        top = None if setting is None and start.worktop is None else top
        self.setting, self.grip = grip(self.motion, start, [thing, self.shape.cls], self.shape.size, top)
        poses = [pose_at(self.motion, share * self.motion.keys.period, self.setting) for share in SHARES]
        self.frames = [forward(pose) for pose in poses]
        self.placed = [held_at(pose, self.shape.size, self.grip) for pose in poses]

    @property
    def height(self) -> float:
        return working_height(self.setting)

    def gaps(self, hand: str) -> list[float]:
        pairs = zip(self.frames, self.placed, strict=True)
        return [self._gap(frames.place[hand], *placed) for frames, placed in pairs]

    def _gap(self, point: Array, place: Array, turn: Array) -> float:
        local = turn.T @ (point - place)
        away = []
        for part in parts_of(self.shape.cls, self.shape.size, self.shape.rgb):
            inner = np.abs(matrix(part.orientation).T @ (local - np.array(part.position)))
            away.append(float(np.linalg.norm(np.maximum(inner - half_of(part), 0.0))))
        return min(away)

    def lowest(self) -> list[float]:
        corners = []
        for part in parts_of(self.shape.cls, self.shape.size, self.shape.rgb):
            signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            corners += list(np.array(part.position) + signs * half_of(part) @ matrix(part.orientation).T)
        return [float((np.array(corners) @ turn.T + place)[:, 2].min()) for place, turn in self.placed]


def half_of(part) -> Array:
    if part.kind == "box":
        return np.array(part.half)
    long = part.radius if part.kind == "sphere" else part.length / 2 + (part.kind == "capsule") * part.radius
    return np.array((part.radius, part.radius, long))


def test_there_are_usual_things_for_most_motions() -> None:
    assert len({caption for caption, _ in usual()}) > 60


@pytest.mark.parametrize(("caption", "thing"), usual())
def test_the_hands_are_at_the_thing_that_they_work_with(caption: str, thing: str) -> None:
    scene = Scene(caption, thing)
    if scene.grip.hold == "beside" and max(scene.shape.size) > 0.35:
        return  # a mat lies on the floor beside who exercises
    most = OVER_A_POT if caption == "stir a pot" else AT_HAND
    assert min(scene.gaps("left_hand" if scene.grip.hold == "left" else "right_hand")) < most
    if scene.grip.hold in ("both", "floor") or (scene.grip.laid and scene.motion.keys.hold == "surface"):
        assert min(scene.gaps("left_hand")) < most


@pytest.mark.parametrize(("caption", "thing"), usual())
def test_what_lies_on_the_surface_lies_exactly_on_it_and_stays_there(caption: str, thing: str) -> None:
    scene = Scene(caption, thing)
    if not lies(scene.motion, [thing, scene.shape.cls], scene.shape.size) or scene.setting.worktop is None:
        return
    assert scene.grip.laid is not None
    for place, turn in scene.placed:
        assert float(place[2]) == scene.height
        assert turn[2, 2] == pytest.approx(1.0)
    assert min(scene.lowest()) == pytest.approx(scene.height, abs=0.005)
    x, y = scene.grip.laid.x, scene.grip.laid.y
    assert abs(x - TABLE.x) <= TABLE.half_x
    assert abs(y - TABLE.y) <= TABLE.half_y


@pytest.mark.parametrize(("caption", "thing"), usual())
def test_nothing_in_the_hand_goes_through_the_surface(caption: str, thing: str) -> None:
    scene = Scene(caption, thing)
    if scene.grip.surface is not None and scene.grip.hold != "both":
        assert min(scene.lowest()) > scene.height - 0.01


@pytest.mark.parametrize(
    ("caption", "thing"),
    [
        ("wipe the surface", "sponge"),
        ("wipe the surface", "soft cloth"),
        ("chop vegetables", "kitchen knife"),
        ("write by hand", "pen"),
        ("fry in a pan", "spatula"),
        ("draw and paint", "pencil"),
        ("iron clothes", "iron"),
    ],
)
@pytest.mark.parametrize("worktop", [0.75, 0.9, 1.0])
def test_a_tool_touches_the_surface_that_it_works_on(caption: str, thing: str, worktop: float) -> None:
    start = SETTINGS[LIBRARY[caption].posture]
    scene = Scene(caption, thing, start._replace(worktop=worktop if start.posture == "stand" else 0.75))
    assert min(scene.lowest()) - scene.height < TOUCHES


@pytest.mark.parametrize(("caption", "thing"), [("sweep the floor", "broom"), ("mop the floor", "mop")])
def test_a_broom_goes_through_both_hands_and_its_end_is_on_the_floor_ahead(caption: str, thing: str) -> None:
    scene = Scene(caption, thing)
    assert scene.grip.hold == "floor"
    assert max(scene.gaps("right_hand")) < 0.03
    assert max(scene.gaps("left_hand")) < 0.03
    for low, (place, turn) in zip(scene.lowest(), scene.placed, strict=True):
        assert low == pytest.approx(0.0, abs=0.01)
        end = place - turn[:, 0] * scene.shape.size[0] / 2
        assert 0.4 < float(end[0]) < 1.0
        assert abs(float(end[1])) < 0.6


@pytest.mark.parametrize(
    ("setting", "top"),
    [
        (Setting(0.45, 0.75, "sit"), TABLE),
        (Setting(0.45, None, "sit"), LAP),
        (Setting(0.0, 0.9, "stand"), TABLE),
        (Setting(0.45, 0.75, "sit"), TABLE._replace(yaw=0.5)),
    ],
)
def test_typing_fingers_are_on_the_keys(setting: Setting, top: Worktop) -> None:
    scene = Scene("type on a keyboard", "laptop", setting, top)
    assert max(scene.gaps("right_hand")) < ON_THE_KEYS
    assert max(scene.gaps("left_hand")) < ON_THE_KEYS
    place, turn = scene.placed[0]
    assert float((turn @ np.array((0.0, 1.0, 0.0)))[0]) == pytest.approx(-1.0)  # the screen looks at the person


def test_food_and_forks_go_from_the_table_to_the_mouth() -> None:
    for thing in ("apple", "fork"):
        scene = Scene("eat a meal", thing)
        mouths = [frames.point("head", *MOUTH) for frames in scene.frames]
        pairs = zip(mouths, scene.placed, strict=True)
        assert min(scene._gap(mouth, *placed) for mouth, placed in pairs) < (0.08 if thing == "fork" else 0.12)
        assert min(scene.lowest()) - scene.height < TOUCHES


def test_a_pan_stands_on_the_burner_before_one_its_handle_in_the_right_hand() -> None:
    marks = ((0.45, -0.1), (0.45, 0.18), (0.72, -0.1), (0.72, 0.18))
    scene = Scene("fry in a pan", "frying pan", SETTINGS["stand"], TABLE._replace(marks=marks))
    place, turn = scene.placed[0]
    belly = place + turn @ np.array((-(scene.shape.size[0] - scene.shape.size[1]) / 2, 0.0, 0.0))
    assert tuple(belly[:2]) == pytest.approx(marks[0])
    assert max(scene.gaps("right_hand")) < AT_HAND


def test_a_thing_lies_beside_what_stands_there_already() -> None:
    glass = (0.42, 0.12, 0.04)
    free = Scene("eat a meal", "plate").grip.laid
    scene = Scene("eat a meal", "plate", SETTINGS["sit"], TABLE._replace(taken=(glass,)))
    beside = scene.grip.laid
    assert free is not None
    assert beside is not None
    assert math.dist((free.x, free.y), glass[:2]) < glass[2] + 0.12
    assert math.dist((beside.x, beside.y), glass[:2]) > glass[2] + 0.12
    assert min(scene.gaps("left_hand")) < AT_HAND


def test_where_there_is_no_surface_nothing_lies_in_the_air() -> None:
    scene = Scene("type on a keyboard", "laptop", Setting(0.0, None, "stand"), None)
    assert scene.grip.laid is None


def test_every_motion_with_a_thing_that_lies_is_done_with_the_hands_at_the_surface() -> None:
    for caption, said in affordances().motions.items():
        if said.lies and caption in LIBRARY:
            keys = LIBRARY[caption].keys
            assert any(path is not None and "surface" in path.frames for path in (keys.right, keys.left)), caption


def test_a_hat_sits_on_the_head_and_a_shirt_is_not_shown() -> None:
    pose = pose_at(LIBRARY["stand and wait"], 0.0, SETTINGS["stand"])
    hat = worn_at(pose, "hat", (0.32, 0.32, 0.15))
    assert hat is not None
    assert 0.0 < float(hat[0][2] - forward(pose).place["head"][2]) < 0.12
    assert worn_at(pose, "shirt", (0.42, 0.32, 0.05)) is None


def test_a_thing_that_is_carried_about_is_at_the_right_hand() -> None:
    pose = pose_at(LIBRARY["stand and wait"], 0.0, SETTINGS["stand"])
    place, _ = held_at(pose, (0.1, 0.1, 0.1), Grip())
    assert math.dist(place, forward(pose).place["right_hand"]) < 0.12


@pytest.mark.parametrize("worktop", [0.56, 0.75, 0.9, 1.15])
def test_hands_reach_surfaces_of_any_usual_height(worktop: float) -> None:
    scene = Scene("wipe the surface", "sponge", Setting(0.0, worktop, "stand"))
    assert min(scene.lowest()) - worktop < TOUCHES
