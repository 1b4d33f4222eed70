"""Doors, flaps and drawers of open furniture as pictures show them: clear of bodies, of other furniture and of walls.

Which way a door stands open is no truth of the home: it follows from who stands where at the moment of a picture.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coopera.core.household import AgentId
from coopera.simulation.acts.plans import Placed
from coopera.simulation.bodies.humanoid import SIDES, forward
from coopera.simulation.bodies.robot import RobotBody
from coopera.simulation.homes.opened import Leaf, Way, opened
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.kit import Part
from coopera.simulation.shapes.rotations import Array, about_z, quaternion
from coopera.simulation.sight.build import BuiltHome
from coopera.simulation.sight.hiding import Boxes, boxes_of, robot_body

OPEN = ":open"
_AWAY = (0.0, 0.0, -50.0)
_REACH = 2.0
"""Furniture farther than this from a piece is in no way of its doors (metres)."""
_RASTER, _PLAY = 0.05, 0.02
_BESIDE = 4
"""Between two joints a limb is tried at so many points."""
_LIMBS = [
    ("pelvis", "chest", 0.14),
    ("chest", "head", 0.11),
    *((f"{side}_{one}", f"{side}_{other}", wide) for side in SIDES for one, other, wide in (
        ("shoulder", "elbow", 0.06), ("elbow", "hand", 0.05), ("hip", "knee", 0.09), ("knee", "ankle", 0.07)
    )),
]  # fmt: skip
"""From which joint to which a body goes, and how thick it is there (radius in metres)."""
_ARM = 0.07


class Volume(NamedTuple):
    """Balls that fill bodies: middles, shape (n, 3), and radii, shape (n,), in the world; `hands` are of forearms."""

    middles: Array
    radii: Array
    hands: NDArray[np.bool_]


class Doors:
    """The doors of one home's stage."""

    def __init__(self, scene: Scene, home: BuiltHome, robots: Mapping[AgentId, RobotBody]) -> None:
        """Nothing is open at first."""
        self._scene, self._home, self._robots = scene, home, robots
        self._leaves: dict[str, list[Leaf]] = {}
        self._shown: frozenset[str] = frozenset()

    def show(self, names: Iterable[str], bodies: Mapping[AgentId, Placed]) -> None:
        """Show what is open, and nothing else, with doors that cut nobody.

        A leaf for which there is no such way is left out. Open things that are carried look as ever.
        """
        wanted = frozenset(names)
        for name in sorted(self._shown - wanted):
            self._put_away(name)
        self._shown = wanted
        if not wanted:
            return
        volume = volume_of(bodies, self._robots)
        for name in sorted(wanted):
            thing = self._scene.object(name)
            if thing is None:
                continue
            for number, leaf in enumerate(self._made(thing)):
                way = next((way for way in leaf.ways if not cuts(leaf, way, thing, volume)), None)
                door = _leaf(name, number)
                if way is None:
                    self._home.move(door, _AWAY, 0.0)
                    continue
                place = thing.to_world(*way.place.tolist())
                self._home.move_to(door, place, quaternion(about_z(thing.yaw) @ way.turn))

    def _made(self, thing: SceneObject) -> list[Leaf]:
        """The leaves of a piece of furniture with the ways that its surroundings leave; its inside is shown."""
        name = thing.name
        if name not in self._leaves:
            inside, leaves = opened(thing)
            if inside:
                self._home.show_only(name + OPEN, inside, thing.cls)
            for number, leaf in enumerate(leaves):
                self._home.show_only(_leaf(name, number), leaf.parts, thing.cls)
            self._leaves[name] = [leaf._replace(ways=free_ways(self._scene, thing, leaf)) for leaf in leaves]
        if name + OPEN in self._home.bodies:
            self._home.move(name + OPEN, thing.position, thing.yaw)
        return self._leaves[name]

    def _put_away(self, name: str) -> None:
        doors = [name + OPEN, *(_leaf(name, number) for number in range(len(self._leaves.get(name, []))))]
        for door in doors:
            if door in self._home.bodies:
                self._home.move(door, _AWAY, 0.0)


def _leaf(name: str, number: int) -> str:
    return f"{name}{OPEN}:{number}"


def free_ways(scene: Scene, thing: SceneObject, leaf: Leaf) -> list[Way]:
    """The ways in which a leaf of furniture neither cuts other furniture nor leaves the room."""
    room = scene.room(thing.room)
    x, y, _ = thing.position
    near = [other for other in scene.fixed if other.name != thing.name and other.bounds.distance(x, y) < _REACH]
    boxes, found = boxes_of(near, opaque=False), []
    for way in leaf.ways:
        points = (_raster(leaf.parts) @ way.turn.T + way.place) @ about_z(thing.yaw).T + np.array(thing.position)
        if (room is None or room.covers(points[:, 0], points[:, 1]).all()) and not _inside(points, boxes):
            found.append(way)
    return found


def _raster(parts: Sequence[Part]) -> Array:
    """Points throughout boxes, in the frame of the leaf that they make; shape (n, 3)."""
    found = []
    for part in parts:
        axes = [np.linspace(-half, half, max(2, round(2 * half / _RASTER) + 1)) for half in part.half]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        found.append(grid + part.position)
    return np.concatenate(found)


def _inside(points: Array, boxes: Boxes) -> bool:
    """Whether one of some points is well within one of some boxes."""
    for middle, half, yaw in zip(boxes.middles, boxes.halves, boxes.yaws, strict=True):
        local = np.abs((points - middle) @ about_z(float(yaw)))
        if (local < half - _PLAY).all(axis=1).any():
            return True
    return False


def cuts(leaf: Leaf, way: Way, thing: SceneObject, volume: Volume) -> bool:
    """Whether a leaf that stands open in a way goes through a body."""
    if leaf.hollow:
        free = ~volume.hands
        volume = Volume(volume.middles[free], volume.radii[free], volume.hands[free])
    local = (volume.middles - np.array(thing.position)) @ about_z(thing.yaw)
    local = (local - way.place) @ way.turn
    for part in leaf.parts:
        away = np.linalg.norm(np.maximum(np.abs(local - part.position) - part.half, 0.0), axis=1)
        if (away < volume.radii).any():
            return True
    return False


def volume_of(bodies: Mapping[AgentId, Placed], robots: Mapping[AgentId, RobotBody]) -> Volume:
    """What all bodies fill, roughly."""
    found = [Volume(np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.bool_))]
    for agent, placed in bodies.items():
        if agent in robots:
            trunk, arm = robot_body(robots[agent], placed), robots[agent].arm(placed.pose)
            links = _along([(one, other, _ARM, True) for one, other in zip(arm, arm[1:], strict=False)])
            still = np.zeros(len(trunk.radii), dtype=np.bool_)
            found += [Volume(trunk.balls, trunk.radii, still), _in_world(placed, links)]
        else:
            at = forward(placed.pose).place
            limbs = [(at[one], at[other], wide, other.endswith("hand")) for one, other, wide in _LIMBS]
            found.append(_in_world(placed, _along(limbs)))
    middles, radii, hands = zip(*found, strict=True)
    return Volume(np.concatenate(middles), np.concatenate(radii), np.concatenate(hands))


def _along(limbs: Sequence[tuple[Array, Array, float, bool]]) -> Volume:
    """Balls along limbs, each given by its ends, its radius and whether it is a forearm."""
    shares = np.linspace(0.0, 1.0, _BESIDE + 2)[:, None]
    middles = [one + shares * (np.asarray(other) - one) for one, other, *_ in limbs]
    wide = np.repeat([limb[2] for limb in limbs], len(shares))
    return Volume(np.concatenate(middles), wide, np.repeat([limb[3] for limb in limbs], len(shares)))


def _in_world(placed: Placed, volume: Volume) -> Volume:
    middles = volume.middles @ about_z(placed.yaw).T + np.array((placed.x, placed.y, 0.0))
    return volume._replace(middles=middles)
