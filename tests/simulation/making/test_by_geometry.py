"""Furniture that we know by its mesh alone carries things and persons where the mesh is, measured in pybullet.

Heights are those of rays that fall onto the mesh as it was written, not onto what the import made of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from coopera.core.household import HUMAN, FreeMotion
from coopera.homes.stored import bring_in
from coopera.simulation import World
from coopera.simulation.acts.plans import Placed
from coopera.simulation.acts.workplace import working
from coopera.simulation.homes.catalogue import interiors, lying_place, seat, surfaces
from coopera.simulation.homes.scene import Scene, SceneObject, load_scene
from coopera.simulation.motions.library import load_library
from coopera.simulation.motions.poses import pose_at
from coopera.simulation.sight.engine import pybullet
from coopera.simulation.sight.recording import Moment
from coopera.simulation.sight.stage import Stage
from coopera.simulation.state.agents import PersonAgent
from tests.simulation.synthetic_habitat import FURNITURE, MATTRESS, Solid, write_habitat

LIBRARY = load_library()
TWO_CENTIMETRES = 0.02
OF = {"bed_1": "bed", "sofa_1": "sofa", "bookshelf_1": "bookshelf", "dresser_1": "drawers", "desk_1": "desk"}


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    folder = tmp_path_factory.mktemp("habitat")
    (arrival,) = bring_in(write_habitat(folder / "flat"), folder / "scenes")
    assert arrival.told.problems == []
    return load_scene(arrival.file)


@pytest.fixture(scope="module")
def world(home: Scene) -> Iterator[World]:
    with World(home) as world:
        yield world


@pytest.fixture(scope="module")
def meshes(home: Scene) -> Iterator[dict[str, int]]:
    """The meshes as they were made, each a body of triangles where the home has it, in a pybullet client of its own."""
    client = pybullet.connect(pybullet.DIRECT)
    found = {"client": client}
    for name, kind in OF.items():
        thing = home.object(name)
        assert thing is not None
        found[name] = _body(client, FURNITURE[kind](), thing)
    yield found
    pybullet.disconnect(client)


def _body(client: int, solid: Solid, thing: SceneObject) -> int:
    corners, faces = solid
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = np.array([*(low + high)[:2] / 2, low[2]])
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_MESH,
        vertices=(corners - middle).tolist(),
        indices=np.concatenate([faces, faces[:, ::-1]]).ravel().tolist(),
        flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
        physicsClientId=client,
    )
    turn = pybullet.getQuaternionFromEuler([0, 0, thing.yaw])
    return int(pybullet.createMultiBody(0, shape, -1, thing.position, turn, physicsClientId=client))


def under(meshes: dict[str, int], place: Any, z: float) -> float:
    """Where the highest of five near rays lands that fall from a little above: a seam of cushions is bridged."""
    starts = [
        (place[0] + dx, place[1] + dy, z + 0.05) for dx, dy in ((0, 0), (0.05, 0), (-0.05, 0), (0, 0.05), (0, -0.05))
    ]
    ends = [(x, y, z - 1.0) for x, y, _ in starts]
    return max(float(ray[3][2]) for ray in pybullet.rayTestBatch(starts, ends, physicsClientId=meshes["client"]))


@pytest.mark.parametrize("name", ["bed_1", "sofa_1", "bookshelf_1", "dresser_1", "desk_1"])
def test_a_thing_that_is_put_on_furniture_lies_on_its_mesh(world: World, meshes: dict[str, int], name: str) -> None:
    start = world.snapshot()
    assert world.pick(HUMAN, "mug_1").ok
    placed = world.place(HUMAN, name)
    assert placed.ok, placed.reason
    where = world.state.moved["mug_1"]
    assert where.on == name
    assert where.position[2] == pytest.approx(under(meshes, where.position[:2], where.position[2]), abs=TWO_CENTIMETRES)
    world.restore(start)


def test_a_thing_that_is_put_inside_a_drawer_lies_on_its_bottom(world: World, meshes: dict[str, int]) -> None:
    start = world.snapshot()
    assert world.pick(HUMAN, "mug_1").ok
    placed = world.place(HUMAN, "dresser_1", "inside")
    assert placed.ok, placed.reason
    where = world.state.moved["mug_1"]
    assert where.inside == "dresser_1"
    assert where.position[2] == pytest.approx(under(meshes, where.position[:2], where.position[2]), abs=TWO_CENTIMETRES)
    world.restore(start)


def test_every_place_for_a_thing_is_on_the_mesh_and_has_the_room_above_it_that_it_claims(
    home: Scene, meshes: dict[str, int]
) -> None:
    for name in OF:
        thing = home.object(name)
        assert thing is not None
        for surface in (*surfaces(thing), *interiors(thing)):
            for share_x, share_y in ((0.5, 0.5), (0.05, 0.05), (0.95, 0.05), (0.05, 0.95), (0.95, 0.95)):
                x = surface.x0 + share_x * (surface.x1 - surface.x0)
                y = surface.y0 + share_y * (surface.y1 - surface.y0)
                at = thing.to_world(x, y, surface.z)
                assert under(meshes, at[:2], at[2]) == pytest.approx(
                    at[2], abs=TWO_CENTIMETRES + 0.01 * (name == "bed_1")
                )
                top = [*at[:2], at[2] + min(surface.clear, 0.5) - 0.02]
                up = pybullet.rayTest([*at[:2], at[2] + 0.04], top, physicsClientId=meshes["client"])[0]
                assert up[0] == -1, f"{name} has something {up[3][2] - at[2]:.2f} m above its place at {surface}"


def rests(home: Scene, caption: str, name: str) -> tuple[float, tuple[float, float]]:
    """How high the trunk of somebody ends below, who does a motion at some furniture, and where the body is."""
    thing = home.object(name)
    assert thing is not None
    with World(home, agents=[PersonAgent()]) as world:
        act = FreeMotion(target_id=thing.id, target=name, in_hand="nothing", motion=caption)
        done = world.perform(HUMAN, act)
        assert done.ok, done.reason
        person = world.state.person()
        motion = LIBRARY[caption]
        setting, _ = working(world.layout, world.state, person, motion)
        stage = Stage(home, [HUMAN], {}, renderer=None)
        try:
            pose = pose_at(motion, motion.keys.period / 2, setting)
            stage.show(world.state, Moment({HUMAN: Placed(*person.place, person.yaw, pose)}, {}, {}))
            body = stage.bodies[HUMAN]
            names = [pybullet.getJointInfo(body, i, physicsClientId=stage.client)[12].decode() for i in range(2)]
            trunk = [-1, *(i for i, link in enumerate(names) if link in ("pelvis", "chest"))]
            return min(pybullet.getAABB(body, link, stage.client)[0][2] for link in trunk), person.place
        finally:
            stage.close()


@pytest.mark.parametrize(
    ("caption", "ours", "there"),
    [("lie down", "bed_1", "bed_1"), ("sit and rest", "sofa_1", "sofa_1"), ("sit and rest", "bed_1", "bed_1")],
)
def test_a_person_lies_and_sits_as_deep_in_a_foreign_mesh_as_in_our_own_furniture(
    home: Scene, meshes: dict[str, int], caption: str, ours: str, there: str
) -> None:
    maple = load_scene("maple")
    known = maple.object(ours)
    assert known is not None
    rest = lying_place(known) if caption == "lie down" else seat(known)
    assert rest is not None
    body, _ = rests(maple, caption, ours)
    depth = body - rest.z
    body, place = rests(home, caption, there)
    assert body - under(meshes, place, MATTRESS + 0.1) == pytest.approx(depth, abs=TWO_CENTIMETRES)


def test_who_sits_on_a_foreign_chair_has_its_back_behind(home: Scene) -> None:
    """Whatever the files take for its front."""
    chair = home.object("dining_chair_1")
    assert chair is not None
    assert chair.measured is not None
    tall = np.array([one for one in chair.measured.solids if one[5] > 0.8])
    rest = seat(chair)
    assert rest is not None
    back = chair.to_world(tall[:, (0, 2)].mean(), tall[:, (1, 3)].mean())
    assert math.cos(math.atan2(back[1] - rest.y, back[0] - rest.x) - rest.heading) < -0.9
