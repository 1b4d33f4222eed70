"""Pictures of a home in its initial state: the whole from above, as of a doll's house, and one room from a corner."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coopera.core.errors import ConfigError
from coopera.simulation.drawing.context import Renderer, chosen
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.renderer import Renderer as Drawer
from coopera.simulation.drawing.scenery import Scenery, thing_mesh
from coopera.simulation.homes.floorplan import Point
from coopera.simulation.homes.scene import Room, Scene
from coopera.simulation.shapes.rotations import about_z
from coopera.simulation.sight.build import build
from coopera.simulation.sight.engine import pybullet

Image = NDArray[np.uint8]
Point3 = tuple[float, float, float]
_FOV = 46.0
_WIDE = 78.0
_LEAN = 0.34
"""How far the camera stands to the south, as a share of its height."""
_EYES = 2.0
_CORNER = 0.35


def overview(scene: Scene, width: int = 960, height: int = 720, renderer: Renderer = "auto") -> Image:
    """Render a home in its initial state from above, leaning to the south; colours (height, width, 3)."""
    b = scene.bounds
    wide, deep = b.x1 - b.x0, b.y1 - b.y0
    middle = ((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, 0.0)
    half = math.tan(math.radians(_FOV / 2))
    high = 2.4 + max((deep + 1.0) / 2 / half, (wide + 1.0) / 2 / half * height / width)
    eye = (middle[0], middle[1] - _LEAN * high, high)
    return _pictured(scene, Camera(eye, middle, _FOV, (0.0, 1.0, 0.0)), (width, height), renderer)


def inside(scene: Scene, room: str, width: int = 960, height: int = 720, renderer: Renderer = "auto") -> Image:
    """Render one room from the corner from which most of it is seen; colours (height, width, 3).

    Raises:
        ConfigError: If the home has no such room.
    """
    found = scene.room(room)
    if found is None:
        known = ", ".join(room.name for room in scene.rooms)
        raise ConfigError(f"room: the home {scene.id!r} has no room {room!r} (it has {known}).")
    x, y = max(_corners(found), key=lambda corner: _outlook(scene, found, corner))
    cx, cy = found.centre
    camera = Camera((x, y, _EYES), (cx + (cx - x) * 0.2, cy + (cy - y) * 0.2, 0.55), _WIDE)
    return _pictured(scene, camera, (width, height), renderer)


def _pictured(scene: Scene, camera: Camera, size: tuple[int, int], renderer: Renderer) -> Image:
    """A picture of a home in its initial state."""
    if chosen(renderer) == "gl":
        scenery = Scenery(scene, {})
        for number, thing in enumerate(scene.movable):
            scenery.add(thing.name, thing_mesh(scene, thing), number, thing.cls)
            scenery.put(thing.name, thing.position, about_z(thing.yaw))
        drawer = Drawer(scenery)
        try:
            return drawer.draw(camera, size).colour
        finally:
            drawer.close()
    client = pybullet.connect(pybullet.DIRECT)
    try:
        build(scene, client)
        return picture(client, camera.eye, camera.target, camera.fov, size, camera.up)
    finally:
        pybullet.disconnect(client)


def _corners(room: Room) -> list[Point]:
    return room.corners(_CORNER) or [room.centre]


def _outlook(scene: Scene, room: Room, corner: Point) -> float:
    """How free the view from a corner is: the distance to the nearest tall piece of furniture."""
    tall = [thing for thing in scene.fixed if thing.room == room.name and thing.top > 1.4]
    return min((thing.bounds.distance(*corner) for thing in tall), default=math.inf)


def picture(
    client: int, eye: Point3, target: Point3, fov: float, size: tuple[int, int], up: Point3 = (0.0, 0.0, 1.0)
) -> Image:
    """Take a picture of whatever stands in a client; `fov` is vertical in degrees; colours (height, width, 3)."""
    away = math.dist(eye, target)
    view = pybullet.computeViewMatrix(eye, target, up)
    lens = pybullet.computeProjectionMatrixFOV(fov, size[0] / size[1], min(1.0, away / 25), max(4 * away, 30.0))
    _, _, colours, _, _ = pybullet.getCameraImage(
        *size,
        view,
        lens,
        shadow=0,
        lightDirection=(3.0, -4.0, 10.0),
        renderer=pybullet.ER_TINY_RENDERER,
        physicsClientId=client,
    )
    return np.asarray(colours, dtype=np.uint8).reshape(size[1], size[0], 4)[:, :, :3]
