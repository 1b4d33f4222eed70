"""Doors of open furniture in pictures: clear of who stands before them, of other furniture and of walls."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from coopera.core.household import HUMAN
from coopera.simulation import load_scene
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.bodies.humanoid_reach import standing
from coopera.simulation.homes.catalogue import solids
from coopera.simulation.homes.opened import opened
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.rotations import about_z, matrix
from coopera.simulation.sight.doors import free_ways
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stage import Stage
from coopera.simulation.state.home_state import HomeState, PersonState

OUT_OF_SIGHT = -10.0


def pieces(scene: Scene) -> Iterator[SceneObject]:
    return (thing for thing in scene.fixed if opened(thing).leaves)


@pytest.fixture(scope="module")
def stage() -> Iterator[Stage]:
    stage = Stage(load_scene("willow"), [HUMAN], {}, renderer=None)
    yield stage
    stage.close()


def standing_before(thing: SceneObject, across: float, away: float) -> Placed:
    x, y, _ = thing.to_world(across, thing.size[1] / 2 + away)
    return Placed(x, y, thing.yaw - math.pi / 2, standing())


def leaves_seen(stage: Stage, thing: SceneObject, person: Placed) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Where each leaf of an open piece is while somebody is there, of those that are in sight."""
    state = HomeState(
        scene="willow", agents={HUMAN: PersonState(place=(person.x, person.y), spot=(person.x, person.y))}
    )
    stage.show(state, Moment({HUMAN: person}, {}, {}, opened=frozenset((thing.name,))))
    found = {}
    for number in range(len(opened(thing).leaves)):
        body = stage.home.bodies[f"{thing.name}:open:{number}"]
        place, turn = pybullet.getBasePositionAndOrientation(body, physicsClientId=stage.client)
        if place[2] > OUT_OF_SIGHT:
            found[number] = (np.array(place), matrix(turn))
    return found


@pytest.mark.parametrize("across", [-0.3, 0.0, 0.3])
@pytest.mark.parametrize("away", [0.2, 0.35, 0.6])
def test_an_open_door_goes_through_nobody(stage, across: float, away: float) -> None:
    for thing in pieces(stage.scene):
        person = standing_before(thing, across, away)
        joints = np.array(list(forward(person.pose).place.values()))
        world = joints @ about_z(person.yaw).T + (person.x, person.y, 0.0)
        for number, (place, turn) in leaves_seen(stage, thing, person).items():
            local = (world - place) @ turn
            for part in opened(thing).leaves[number].parts:
                apart = np.linalg.norm(np.maximum(np.abs(local - part.position) - part.half, 0.0), axis=1)
                assert apart.min() > 0.04 or opened(thing).leaves[number].hollow, thing.name


def test_a_door_stands_wide_open_while_nobody_is_near(stage) -> None:
    fridge = next(thing for thing in stage.scene.fixed if thing.cls == "fridge")
    place, turn = leaves_seen(stage, fridge, Placed(0.5, 0.5, 0.0, standing()))[0]
    best = free_ways(stage.scene, fridge, opened(fridge).leaves[0])[0]
    assert place == pytest.approx(fridge.to_world(*best.place))
    assert turn == pytest.approx(about_z(fridge.yaw) @ best.turn, abs=1e-6)


@pytest.mark.parametrize("name", ["maple", "oak", "pine", "rowan", "willow"])
def test_no_door_leaves_its_room_or_ends_in_other_furniture(name: str) -> None:
    scene = load_scene(name)
    for thing in pieces(scene):
        room = scene.room(thing.room)
        assert room is not None
        for leaf in opened(thing).leaves:
            tips = [np.array(part.position) + (part.half[0], 0.0, 0.0) for part in leaf.parts]
            for place, turn in free_ways(scene, thing, leaf):
                for x, y, z in (thing.to_world(*(turn @ tip + place)) for tip in tips):
                    assert room.distance(x, y) == 0.0
                    assert not any(_is_in(other, x, y, z) for other in scene.fixed if other is not thing)


def _is_in(thing: SceneObject, x: float, y: float, z: float) -> bool:
    at = np.array((*thing.to_local(x, y), z - thing.position[2]))
    return any((np.abs(at - solid.middle) < np.array(solid.half) - 0.05).all() for solid in solids(thing))
