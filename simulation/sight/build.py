"""Put a home into pybullet as bodies that are seen and hit by rays; nothing moves by itself.

Every room is one body (its floor and the painted inner faces of its walls), every object is one body. There is no
ceiling, so that a camera may look in from above. No dynamics: a thing is moved by setting its pose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from coopera.simulation.drawing.house import WALL_HEIGHT, faces_of
from coopera.simulation.drawing.scenery import Scenery, parts_mesh, shape_mesh, thing_mesh
from coopera.simulation.homes.catalogue import catalogue, parts_of
from coopera.simulation.homes.floorplan import Block, Point, Wall
from coopera.simulation.homes.meshes import part_file
from coopera.simulation.homes.scene import Room, Scene, SceneObject, rgb_of
from coopera.simulation.shapes.kit import MOST_PARTS, WHITE, Colour, Kit, Part, Size, shade
from coopera.simulation.shapes.rotations import about_z, matrix
from coopera.simulation.sight.engine import pybullet

_UNSEEN = -1
_KIND = {
    "box": pybullet.GEOM_BOX,
    "cylinder": pybullet.GEOM_CYLINDER,
    "sphere": pybullet.GEOM_SPHERE,
    "capsule": pybullet.GEOM_CAPSULE,
}


@dataclass(slots=True)
class BuiltHome:
    """A home's bodies in one pybullet client."""

    client: int
    drawn: bool = True
    """Whether bodies can be seen; rays hit them in any case."""
    rooms: dict[str, int] = field(default_factory=dict)
    """Body of each room, by its name."""
    bodies: dict[str, int] = field(default_factory=dict)
    """Body of each object, by its name."""
    names: dict[int, str] = field(default_factory=dict)
    """Name of each object, by its body."""
    scenery: Scenery | None = None
    """What another renderer draws of it, kept up to date."""
    hulls: dict[Size, int] = field(default_factory=dict)
    """Shape for rays of things of a size: pybullet keeps a shape when its body is removed, so each is made once."""

    def move(self, name: str, position: tuple[float, float, float], yaw: float) -> None:
        """Set an object's base centre and yaw; nothing else is touched."""
        turn = (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
        pybullet.resetBasePositionAndOrientation(self.bodies[name], position, turn, physicsClientId=self.client)
        if self.scenery is not None and name in self.scenery:
            self.scenery.put(name, position, about_z(yaw))

    def move_to(
        self, name: str, position: tuple[float, float, float], orientation: tuple[float, float, float, float]
    ) -> None:
        """Set an object's base centre and full orientation (quaternion x, y, z, w), as while it is carried."""
        pybullet.resetBasePositionAndOrientation(self.bodies[name], position, orientation, physicsClientId=self.client)
        if self.scenery is not None and name in self.scenery:
            self.scenery.put(name, position, matrix(orientation))

    def add(self, name: str, cls: str, size: Size, colour: Colour) -> int:
        """Add one more thing (out of the magic box) far below the floor, to be moved into sight; returns its body."""
        body = self.body(self.visual(parts_of(cls, size, colour)), size)
        self.bodies[name], self.names[body] = body, name
        if self.scenery is not None:
            self.scenery.add(name, shape_mesh(cls, size, colour), body, cls)
        self.move(name, (0.0, 0.0, -50.0), 0.0)
        return body

    def show_only(self, name: str, parts: list[Part], cls: str) -> int:
        """Add a body that is seen and stops no ray, such as an open door, to be moved into sight; returns it."""
        body = int(
            pybullet.createMultiBody(
                baseMass=0,
                baseCollisionShapeIndex=-1,
                baseVisualShapeIndex=self.visual(parts),
                basePosition=[0.0, 0.0, -50.0],
                physicsClientId=self.client,
            )
        )
        self.bodies[name] = body
        if self.scenery is not None:
            self.scenery.add(name, parts_mesh(parts, cls, parts[0].rgba[:3]), body, cls)
        return body

    def body(self, visual: int, size: Size) -> int:
        """Make a body that looks like something, with a box around it for rays."""
        if size not in self.hulls:
            half = [size[0] / 2, size[1] / 2, size[2] / 2]
            self.hulls[size] = pybullet.createCollisionShape(
                pybullet.GEOM_BOX,
                halfExtents=half,
                collisionFramePosition=[0, 0, half[2]],
                physicsClientId=self.client,
            )
        return int(
            pybullet.createMultiBody(
                baseMass=0,
                baseCollisionShapeIndex=self.hulls[size],
                baseVisualShapeIndex=visual,
                physicsClientId=self.client,
            )
        )

    def visual(self, parts: list[Part]) -> int:
        """What a body of some parts looks like, for pybullet."""
        return _visual(self.client, parts) if self.drawn else _UNSEEN

    def remove(self, name: str) -> None:
        """Take a thing that was added out of the world again."""
        body = self.bodies.pop(name)
        del self.names[body]
        if self.scenery is not None:
            self.scenery.remove(name)
        pybullet.removeBody(body, physicsClientId=self.client)


def build(scene: Scene, client: int, *, drawn: bool = True) -> BuiltHome:
    """Create all bodies of a home in a connected pybullet client, rooms first, then objects in the scene's order.

    What they look like takes most of the time; where only rays are wanted, they need not be `drawn`.
    """
    home = BuiltHome(client, drawn)
    walls = scene.walls()
    for room in scene.rooms:
        home.rooms[room.name] = _room_body(home, room, walls if scene.stage is None else [])
    for start in range(0, len(scene.stage or []), MOST_PARTS):
        _stage_body(home, walls[start : start + MOST_PARTS])
    for thing in scene.objects:
        if drawn and thing.mesh and scene.meshes is not None:
            visual = _mesh_visual(client, thing, scene.meshes)
        else:
            visual = home.visual(parts_of(thing.cls, thing.size, thing.rgb))
        body = home.body(visual, thing.size)
        home.bodies[thing.name], home.names[body] = body, thing.name
        home.move(thing.name, thing.position, thing.yaw)
    return home


def _visual(client: int, parts: list[Part]) -> int:
    if len(parts) > MOST_PARTS:
        raise ValueError(f"a body takes at most {MOST_PARTS} parts, not {len(parts)}")
    return int(
        pybullet.createVisualShapeArray(
            shapeTypes=[_KIND[part.kind] for part in parts],
            halfExtents=[list(part.half) for part in parts],
            radii=[part.radius for part in parts],
            lengths=[part.length for part in parts],
            rgbaColors=[list(part.rgba) for part in parts],
            visualFramePositions=[list(part.position) for part in parts],
            visualFrameOrientations=[list(part.orientation) for part in parts],
            physicsClientId=client,
        )
    )


def _mesh_visual(client: int, thing: SceneObject, folder: Path) -> int:
    """What an imported thing looks like."""
    count = len(thing.mesh)
    return int(
        pybullet.createVisualShapeArray(
            shapeTypes=[pybullet.GEOM_MESH] * count,
            fileNames=[str(part_file(folder, part)) for part in thing.mesh],
            meshScales=[[1.0, 1.0, 1.0]] * count,
            halfExtents=[[0.0, 0.0, 0.0]] * count,
            radii=[0.0] * count,
            lengths=[0.0] * count,
            rgbaColors=[[*rgb_of(part.colour), 1.0] for part in thing.mesh],
            visualFramePositions=[[0.0, 0.0, 0.0]] * count,
            physicsClientId=client,
        )
    )


def _room_body(home: BuiltHome, room: Room, walls: list[Wall]) -> int:
    """Floor and walls of a room, in the colours of its kind; each wall is half of what two rooms share."""
    kind = catalogue().rooms.get(room.kind)
    floor = rgb_of(kind.floor) if kind else (0.7, 0.66, 0.6)
    paint = rgb_of(kind.wall) if kind else WHITE
    kit = Kit((room.x1 - room.x0, room.y1 - room.y0, WALL_HEIGHT), paint)
    cx, cy = room.bounds.middle
    for b in room.rectangles():
        x, y = b.middle
        kit.box((x - cx, y - cy, -0.05), (b.x1 - b.x0, b.y1 - b.y0, 0.05), floor)
    for wall in walls:
        for face in faces_of(room, wall):
            _upright(kit, face._replace(x=face.x - cx, y=face.y - cy), shade(paint, 0.94 if wall.axis == "x" else 1.0))
    for start in range(MOST_PARTS, len(kit.parts), MOST_PARTS):  # a room of many corners is more than one body
        _boxes(home, kit.parts[start : start + MOST_PARTS], (cx, cy))
    return _boxes(home, kit.parts[:MOST_PARTS], (cx, cy))


def _stage_body(home: BuiltHome, walls: list[Wall]) -> int:
    """Some walls of an imported home, as they stand."""
    kit = Kit((1.0, 1.0, WALL_HEIGHT), WHITE)
    for wall in walls:
        _upright(kit, wall.block, shade(WHITE, 0.88 if wall.axis == "x" else 0.94))
    return _boxes(home, kit.parts, (0.0, 0.0))


def _upright(kit: Kit, block: Block, paint: Colour) -> None:
    """A piece of wall from the floor to the ceiling."""
    size = (2 * block.half_x, 2 * block.half_y, WALL_HEIGHT)
    kit.box((block.x, block.y, 0), size, paint, yaw=block.yaw)


def _boxes(home: BuiltHome, parts: list[Part], at: Point) -> int:
    """One body of boxes that are seen and hit as they are."""
    visual = home.visual(parts)
    solid = pybullet.createCollisionShapeArray(
        shapeTypes=[pybullet.GEOM_BOX for _ in parts],
        halfExtents=[list(part.half) for part in parts],
        collisionFramePositions=[list(part.position) for part in parts],
        collisionFrameOrientations=[list(part.orientation) for part in parts],
        physicsClientId=home.client,
    )
    return int(
        pybullet.createMultiBody(
            baseMass=0,
            baseCollisionShapeIndex=solid,
            baseVisualShapeIndex=visual,
            basePosition=[*at, 0],
            physicsClientId=home.client,
        )
    )


def staged(home: BuiltHome, scene: Scene) -> Scenery:
    """What another renderer draws of a home that was built, kept up to date from now on."""
    home.scenery = Scenery(scene, {**home.rooms, **home.bodies})
    for thing in scene.movable:
        mesh, closed = thing_mesh(scene, thing), not thing.mesh
        home.scenery.add(thing.name, mesh, home.bodies[thing.name], thing.cls, closed=closed)
        home.move(thing.name, thing.position, thing.yaw)
    return home.scenery
