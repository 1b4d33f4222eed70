"""Hand, tool and surface meet in the motions that are told by it; in the studio and at furniture of odd heights."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from benchmarks.contact import CHECKS, contacts, gap, moments
from benchmarks.studio import studio, usual_act
from coopera.core.household import HUMAN, FreeMotion
from coopera.simulation import World
from coopera.simulation.acts.workplace import working
from coopera.simulation.bodies.humanoid import MOUTH, forward
from coopera.simulation.homes.magic_box import shape_of
from coopera.simulation.homes.scene import Scene
from coopera.simulation.motions.aids import aids, now
from coopera.simulation.motions.holding import Grip, grip, held_at
from coopera.simulation.motions.library import load_library
from coopera.simulation.motions.poses import Setting, pose_at
from coopera.simulation.motions.vessels import grasp, lip, tipped
from coopera.simulation.state.agents import PersonAgent

LIBRARY = load_library()


def done(caption: str, thing: str | None = None, scene: Scene | None = None) -> Iterator[World]:
    scene = scene or studio(LIBRARY[caption])
    with World(scene, agents=[PersonAgent()]) as world:
        act = usual_act(LIBRARY[caption], world)
        outcome = world.perform(HUMAN, act if thing is None else act.model_copy(update={"in_hand": thing}))
        assert outcome.ok, outcome.reason
        yield world


@pytest.mark.parametrize("caption", sorted(CHECKS))
def test_hand_tool_and_surface_meet(caption: str) -> None:
    for world in done(caption):
        assert list(contacts(world, LIBRARY[caption])) == []


@pytest.mark.parametrize("thing", ["wine bottle", "milk carton", "kettle", "teapot", "water jug"])
def test_what_is_poured_from_is_tipped_over_the_glass_and_upright_before_and_after(thing: str) -> None:
    caption = "pour a drink"
    for world in done(caption, thing):
        assert list(contacts(world, LIBRARY[caption])) == []
        _, seen = moments(world, LIBRARY[caption])
        tips = [one.grip.tip for one in seen]
        assert tips[0] == 0.0
        assert max(tips) > 0.95
        upright = seen[0].things[0][3][2, 2]
        assert upright == pytest.approx(1.0)


@pytest.mark.parametrize("size", [(0.085, 0.085, 0.31), (0.24, 0.16, 0.24)])
def test_the_lip_of_a_vessel_is_at_its_lower_side_when_it_is_tipped(size: tuple[float, float, float]) -> None:
    edge = lip(size)
    assert edge[1] > 0.0
    assert np.allclose(tipped(size, 0.0), np.eye(3))
    assert edge[2] < (np.array((0.0, 0.0, size[2])) - grasp(size))[2]


def test_a_plate_lies_while_the_fork_goes_to_the_mouth_and_back() -> None:
    for world in done("eat a meal", "plate"):
        _, seen = moments(world, LIBRARY["eat a meal"])
        plates = [one.things[0][2] for one in seen]
        assert np.ptp(plates, axis=0).max() == 0.0
        away = [
            float(np.linalg.norm(place - one.frames.point("head", *MOUTH)))
            for place, one in zip(plates, seen, strict=True)
        ]
        assert min(away) > 0.25


def test_where_there_is_no_table_a_plate_is_held_level_and_not_at_the_mouth() -> None:
    motion, shape = LIBRARY["eat a meal"], shape_of("plate")
    setting = Setting(0.0, None, "stand")
    setting, how = grip(motion, setting, ["plate", shape.cls], shape.size, None)
    assert how.hold == "left"
    for share in np.arange(8) / 8:
        pose = pose_at(motion, float(share) * motion.keys.period, setting)
        place, turn = held_at(pose, shape.size, how)
        assert turn[2, 2] == pytest.approx(1.0)
        assert float(np.linalg.norm(place - forward(pose).point("head", *MOUTH))) > 0.3


def test_a_table_is_set_with_a_plate_and_then_the_cutlery_beside_it() -> None:
    motion = LIBRARY["set the table"]
    for world in done("set the table", "plate"):
        person = world.state.person()
        setting, how = working(world.layout, world.state, person, motion)
        early, late = 0.05 * motion.keys.period, 0.95 * motion.keys.period
        assert now(motion, setting, how, early).laid is None
        assert now(motion, setting, how, late).laid is not None
        first = [aid.thing for aid in aids(motion, setting, how, early, "plate")]
        last = {aid.thing: aid.grip.laid for aid in aids(motion, setting, how, late, "plate")}
        assert "fork" not in first
        assert last["fork"] is not None
        assert last["table knife"] is not None
        assert last["fork"].y > last["table knife"].y


def test_what_cannot_wipe_is_in_the_left_hand_and_a_cloth_in_the_right() -> None:
    motion = LIBRARY["wipe the surface"]
    for world in done("wipe the surface", "cleaning spray"):
        setting, how = working(world.layout, world.state, world.state.person(), motion)
        assert how.hold == "left"
        assert [aid.thing for aid in aids(motion, setting, how, 0.0, "spray_bottle")] == ["cleaning cloth"]


def test_a_motion_needs_no_second_one_of_what_is_in_hand() -> None:
    held = Grip("surface", laid=None)
    assert aids(LIBRARY["eat a meal"], Setting(0.45, 0.75, "sit"), held, 0.0, "fork") == []


def test_hands_on_the_piano_are_on_its_keys() -> None:
    motion = LIBRARY["play the piano"]
    for world in done("play the piano"):
        piano = next(piece for piece in world.layout.fixed if piece.cls == "piano")
        _, seen = moments(world, motion)
        heights = [float(one.frames.place[hand][2]) for one in seen for hand in ("right_hand", "left_hand")]
        assert max(heights) < 0.75 * piano.size[2]
        assert min(heights) > 0.58 * piano.size[2]


def test_one_wipes_a_low_table_where_it_is() -> None:
    motion = LIBRARY["wipe the surface"]
    with World(studio(motion, "coffee_table"), agents=[PersonAgent()]) as world:
        target = next(piece for piece in world.layout.fixed if piece.cls == "coffee_table")
        act = FreeMotion(target_id=target.id, target=target.name, in_hand="sponge", motion=motion.caption)
        assert world.perform(HUMAN, act).ok
        assert world.state.person().worktop == pytest.approx(target.size[2], abs=0.02)
        assert list(contacts(world, motion)) == []


def test_a_broom_sweeps_free_floor_between_furniture() -> None:
    motion = LIBRARY["sweep the floor"]
    scene = studio(motion, "sofa")
    sofa = next(piece for piece in scene.fixed if piece.cls == "sofa")
    aside = [
        sofa.model_copy(update={"id": 9 + k, "name": f"sofa_{9 + k}", "position": (x, y, 0.0)})
        for k, (x, y) in enumerate(((0.0, 2.0), (2.4, 0.9), (-2.4, 0.9)))
    ]
    crowded = scene.model_copy(update={"objects": [*scene.objects, *aside]})
    for world in done(motion.caption, "broom", crowded):
        assert list(contacts(world, motion)) == []


def test_how_far_a_point_is_from_a_thing_follows_its_parts() -> None:
    shape = shape_of("plate")
    beside = gap(np.array((0.5, 0.0, 0.01)), shape.cls, shape.size, np.zeros(3), np.eye(3))
    assert math.isclose(beside, 0.5 - shape.size[0] / 2, abs_tol=0.02)


def test_who_plays_the_guitar_with_a_pick_is_seen_with_a_guitar_and_with_one_only() -> None:
    motion, setting, held = LIBRARY["play the guitar"], Setting(0.45, 0.75, "sit"), Grip("both")
    assert [(aid.thing, aid.grip.hold) for aid in aids(motion, setting, held, 0.3, "cookie")] == [("guitar", "both")]
    assert aids(motion, setting, held, 0.3, "guitar") == []
