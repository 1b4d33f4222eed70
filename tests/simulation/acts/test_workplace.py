from __future__ import annotations

import math

import pytest

from coopera.simulation.acts.workplace import at_work, thing_of, working, worktop_before
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.motions.library import load_library
from coopera.simulation.motions.poses import pose_at
from coopera.simulation.shapes.fixtures import BURNERS
from coopera.simulation.state.home_state import HomeState, PersonState, ThingState

LIBRARY = load_library()


def home(cls: str, *, yaw: float = 0.0) -> Scene:
    kind = catalogue().fixed[cls]
    piece = {"cls": cls, "category": kind.category, "fixed": True, "room": "r", "size": kind.size, "colour": "#808080"}
    mug = {"cls": "mug", "category": "dining ware", "fixed": False, "room": "r", "size": (0.1, 0.1, 0.1)}
    objects = [
        {"id": 1, "name": f"{cls}_1", "position": (3.0, 3.0, 0.0), "yaw": yaw, **piece},
        {"id": 2, "name": "mug_1", "position": (1.0, 1.0, 0.0), "colour": "#ff0000", **mug},
    ]
    room = {"name": "r", "kind": "kitchen", "x0": 0, "y0": 0, "x1": 6, "y1": 6}
    return Scene.model_validate({"id": "k", "rooms": [room], "objects": objects})


def person(scene: Scene, gap: float, *, worktop: float | None, aside: float = 0.0, turned: float = 0.0) -> PersonState:
    """Somebody who stands this far before the front of the furniture and looks at it."""
    at: SceneObject = scene.fixed[0]
    x, y, _ = at.to_world(aside, at.size[1] / 2 + gap, 0.0)
    return PersonState(spot=(x, y), place=(x, y), yaw=at.facing + math.pi + turned, worktop=worktop, at=at.name)


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2, 0.7])
def test_the_surface_before_one_begins_where_the_furniture_does(yaw: float) -> None:
    scene = home("stove", yaw=yaw)
    found = worktop_before(scene, person(scene, 0.4, worktop=0.9))
    assert found is not None
    wide, deep, high = scene.fixed[0].size
    assert found.height == high
    assert found.edge == pytest.approx(0.4 + deep * 0.04, abs=0.02)
    assert found.top.x == pytest.approx(0.4 + deep / 2, abs=0.02)
    assert min(y for _, y in found.top.marks) == pytest.approx(wide * BURNERS[0][0])


def test_who_looks_away_has_no_surface_before_them() -> None:
    scene = home("dining_table")
    assert worktop_before(scene, person(scene, 0.4, worktop=0.75, turned=math.pi)) is None
    assert worktop_before(scene, person(scene, 3.0, worktop=0.75)) is None
    assert worktop_before(scene, person(scene, 0.4, worktop=None)) is None


def test_before_the_plain_part_of_a_sink_one_works_there_and_not_in_the_basin() -> None:
    scene = home("kitchen_sink")
    found = worktop_before(scene, person(scene, 0.35, worktop=0.81, aside=-0.3))
    assert found is not None
    assert found.height == pytest.approx(0.9)


def test_who_stands_too_far_off_steps_up() -> None:
    scene = home("kitchen_counter")
    near, _ = at_work(scene, person(scene, 0.25, worktop=0.9), LIBRARY["wipe the surface"])
    far, _ = at_work(scene, person(scene, 0.45, worktop=0.9), LIBRARY["wipe the surface"])
    assert near.step == 0.0
    assert 0.1 < far.step < 0.3


def test_who_sits_beside_a_table_without_looking_at_it_works_on_the_lap() -> None:
    scene = home("coffee_table")
    beside = person(scene, 0.4, worktop=0.44, turned=math.pi / 2)
    sits = beside.model_copy(update={"posture": "sit", "support": 0.42})
    setting, grip = at_work(scene, sits, LIBRARY["type on a keyboard"], thing_of(scene, empty(sits), "laptop"))
    assert setting.worktop is None
    assert grip.laid is not None
    assert grip.laid.z == pytest.approx(0.42 + 0.19)


def empty(body: PersonState) -> HomeState:
    return HomeState(scene="k", agents={"human": body})


def test_a_pan_in_hand_stands_on_a_burner_and_keeps_clear_of_what_stands_on_the_stove() -> None:
    scene = home("stove")
    body = person(scene, 0.4, worktop=0.9).model_copy(update={"thing": "frying pan"})
    _, free = working(scene, empty(body), body, LIBRARY["fry in a pan"])
    assert free.laid is not None
    assert free.laid.z == pytest.approx(scene.fixed[0].top)
    stove = scene.fixed[0]
    x, y = BURNERS[1][0] * stove.size[0], BURNERS[1][1] * stove.size[1]
    full = ThingState(position=stove.to_world(x, y, stove.size[2]), yaw=0.0, on=stove.name)
    _, beside = working(scene, empty(body), body, LIBRARY["fry in a pan"], {"mug_1": full})
    other = full.model_copy(update={"position": stove.to_world(-x, y, stove.size[2])})
    _, opposite = working(scene, empty(body), body, LIBRARY["fry in a pan"], {"mug_1": other})
    assert beside.laid is not None
    assert opposite.laid is not None
    assert free.laid in (beside.laid, opposite.laid)
    assert beside.laid != opposite.laid


@pytest.mark.parametrize("aside", [-0.12, 0.0, 0.12])
def test_the_hands_go_to_the_cup_that_stands_there_when_one_pours(aside: float) -> None:
    scene = home("dining_table")
    table = scene.fixed[0]
    body = person(scene, 0.3, worktop=0.75)
    x, y, z = table.to_world(aside, table.size[1] / 2 - 0.16, table.size[2])
    there = ThingState(position=(x, y, z), yaw=0.0, on=table.name)
    motion = LIBRARY["pour a drink"]
    setting, _ = working(scene, empty(body), body, motion, {"mug_1": there})
    hands = [forward(pose_at(motion, k * 0.25, setting)).place["left_hand"] for k in range(12)]
    gaps = [math.dist(hand[:2], (0.3 + 0.16, aside)) for hand in hands]
    assert max(gaps) < 0.08


def test_what_stands_far_off_on_the_table_is_left_alone() -> None:
    scene = home("dining_table")
    table = scene.fixed[0]
    body = person(scene, 0.25, worktop=0.75, aside=-0.5)
    there = ThingState(position=table.to_world(0.6, -0.3, table.size[2]), yaw=0.0, on=table.name)
    setting, _ = working(scene, empty(body), body, LIBRARY["pour a drink"], {"mug_1": there})
    assert setting.reach == (0.0, 0.0)


def test_a_thing_is_known_by_what_it_is_called_before_it_is_out_of_the_magic_box() -> None:
    scene = home("stove")
    state = empty(person(scene, 0.4, worktop=0.9))
    assert thing_of(scene, state, "mug_1") is scene.object("mug_1")
    assert thing_of(scene, state, "frying_pan_2").cls == "frying_pan"
    assert thing_of(scene, state, "Grandma's harp").size == (0.12, 0.10, 0.12)
