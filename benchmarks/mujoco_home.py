"""A home as MuJoCo draws it, to be compared with ours: rooms, furniture and things, without people and robots."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np

from coopera.simulation.drawing.house import WALL_HEIGHT
from coopera.simulation.homes.catalogue import parts_of
from coopera.simulation.homes.scene import Scene
from coopera.simulation.shapes.rotations import about_z, matrix, quaternion
from coopera.simulation.sight.stage import Camera

_KINDS = {"box": "box", "cylinder": "cylinder", "sphere": "sphere", "capsule": "capsule"}


def _geoms(scene: Scene) -> Iterator[str]:
    for room in scene.rooms:
        for b in room.rectangles():
            (x, y), w, d = b.middle, b.x1 - b.x0, b.y1 - b.y0
            yield f'<geom type="box" pos="{x} {y} -0.025" size="{w / 2} {d / 2} 0.025" rgba="0.7 0.6 0.45 1"/>'
    for wall in scene.walls():
        cx, cy, wide, deep, yaw = wall.block
        place, sides = f"{cx} {cy} {WALL_HEIGHT / 2}", f"{wide} {deep} {WALL_HEIGHT / 2}"
        facing = f"{math.cos(yaw / 2)} 0 0 {math.sin(yaw / 2)}"
        yield f'<geom type="box" pos="{place}" quat="{facing}" size="{sides}" rgba="0.9 0.88 0.82 1"/>'
    for thing in scene.objects:
        turn = about_z(thing.yaw)
        for part in parts_of(thing.cls, thing.size, thing.rgb):
            at = turn @ np.array(part.position) + np.array(thing.position)
            x, y, z, w = quaternion(turn @ matrix(part.orientation))
            size = part.half if part.kind == "box" else (part.radius, part.length / 2, 0.0)
            yield (
                f'<geom type="{_KINDS[part.kind]}" pos="{at[0]} {at[1]} {at[2]}" quat="{w} {x} {y} {z}" '
                f'size="{size[0]} {size[1]} {size[2]}" rgba="{" ".join(map(str, part.rgba))}"/>'
            )


class Drawn:
    """A home in MuJoCo, drawn through EGL."""

    def __init__(self, scene: Scene, *, shadow: bool) -> None:
        """Build it."""
        os.environ.setdefault("MUJOCO_GL", "egl")
        self._mujoco: Any = import_module("mujoco")
        b = scene.bounds
        light = f'<light pos="{(b.x0 + b.x1) / 2} {(b.y0 + b.y1) / 2} 9" dir="0.3 -0.4 -1" directional="true"/>'
        text = f"""<mujoco><visual><global offwidth="2048" offheight="2048"/><map znear="0.005"/></visual>
            <worldbody>{light}{"".join(_geoms(scene))}</worldbody></mujoco>"""
        self._model = self._mujoco.MjModel.from_xml_string(text)
        self._data = self._mujoco.MjData(self._model)
        self._shadow = shadow
        self._renderers: dict[tuple[int, int], Any] = {}

    def picture(self, camera: Camera, size: tuple[int, int]) -> np.ndarray:
        """Colours (height, width, 3)."""
        mujoco = self._mujoco
        if size not in self._renderers:
            self._renderers[size] = mujoco.Renderer(self._model, size[1], size[0])
        renderer = self._renderers[size]
        self._model.vis.global_.fovy = camera.fov
        mujoco.mj_forward(self._model, self._data)
        view, line = mujoco.MjvCamera(), np.array(camera.target) - np.array(camera.eye)
        view.lookat[:], view.distance = camera.target, float(np.linalg.norm(line))
        view.azimuth = float(np.degrees(np.arctan2(line[1], line[0])))
        view.elevation = float(np.degrees(np.arcsin(line[2] / view.distance)))
        renderer.update_scene(self._data, view)
        renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self._shadow
        return np.asarray(renderer.render())
