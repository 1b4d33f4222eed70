"""The rooms, the floor and the walls of a foreign home: from its regions, and from the mesh of its stage."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np

from coopera.simulation.homes.floorplan import Bounds, Wall
from coopera.simulation.homes.glb import Array, Mesh
from coopera.simulation.homes.polygon import fault, tidy
from coopera.simulation.homes.scene import Room
from coopera.simulation.making.habitat.files import Folder
from coopera.simulation.making.habitat.names import slug
from coopera.simulation.making.habitat.poses import Box, stage_mesh
from coopera.simulation.making.habitat.schema import Region
from coopera.simulation.making.habitat.walls import walls_of
from coopera.simulation.making.report import Report

STOREY = 1.0
"""Floors that differ by more than this, in metres, are different storeys."""
_LEVEL = 0.05
_LEAST_FLOOR = 0.2
"""The floor is the lowest level that has so much of the area of the rectangle around the stage."""


class Ground(NamedTuple):
    """Rooms where regions tell them, walls, the height of the floor, and the rectangle around the stage's floor."""

    rooms: list[Room]
    walls: list[Wall]
    floor: float
    edge: Bounds | None

    def around(self, boxes: list[Box]) -> Room:
        """The one room of a home without regions: the stage's floor, and room around all its boxes."""
        x, y = ([box.position[axis] for box in boxes] for axis in (0, 1))
        edge = Bounds(min(x) - 1.0, min(y) - 1.0, max(x) + 1.0, max(y) + 1.0) if boxes else self.edge
        assert edge is not None
        if self.edge is not None and boxes:
            inner = edge.grown(-1.0)
            edge = Bounds(
                *(min(a, b) for a, b in zip(inner[:2], self.edge[:2], strict=True)),
                *(max(a, b) for a, b in zip(inner[2:], self.edge[2:], strict=True)),
            )
        x0, y0, x1, y1 = (round(side, 4) for side in edge)
        return Room(name="home", kind="home", x0=x0, y0=y0, x1=x1, y1=y1)


def ground_of(folder: Folder, id: str, report: Report) -> Ground:
    """Rooms, walls and floor of a scene."""
    regions = folder.regions(id)
    mesh = _stage(folder, id, report)
    level = _floor_of(mesh) if mesh is not None else None
    if regions:
        floor = _ground_floor(regions)
    else:
        floor = level[0] if level is not None else 0.0
        told = "that of the stage" if level is not None else "at 0 m"
        report.guessed.append(f"rooms: no file tells regions, so all is one room, its floor {told} ({floor:.2f} m)")
    rooms = _rooms(regions, floor, report)
    walls = walls_of(mesh, floor) if mesh is not None else []
    return Ground(rooms, walls, floor, level[1] if level is not None else None)


def _stage(folder: Folder, id: str, report: Report) -> Mesh | None:
    template, placed = folder.stage(id), folder.scene(id).stage_instance
    if template is None or placed is None:
        report.left_out.append("stage_instance: there is no stage, and so there are no walls")
        return None
    mesh = stage_mesh(template, placed)
    return mesh if len(mesh.triangles) else None


def _floor_of(mesh: Mesh) -> tuple[float, Bounds] | None:
    """The height of a stage's floor, and the rectangle around it; None where the stage is too small to live in.

    It is the lowest of the wide levels that face up, or the lowest point of a stage without floors.
    """
    low, high = mesh.corners.min(axis=0), mesh.corners.max(axis=0)
    a, b, c = (mesh.corners[mesh.triangles[:, i]] for i in range(3))
    normal: Array = np.cross(b - a, c - a) / 2
    up = normal[:, 2] if normal[:, 2].max(initial=0.0) > 0 else -normal[:, 2]
    level = up > 0.95 * np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
    height = np.stack([a, b, c])[:, level, 2].mean(axis=0)
    bins, number = np.unique(np.round(height / _LEVEL), return_inverse=True)
    areas = np.bincount(number.ravel(), up[level], minlength=len(bins))
    wide = np.flatnonzero(areas >= _LEAST_FLOOR * float(np.prod((high - low)[:2])))
    floor = float(low[2])
    if len(wide):
        own = number.ravel() == wide[0]
        floor = float(np.average(height[own], weights=up[level][own]))
        points = mesh.corners[mesh.triangles[np.flatnonzero(level)[own]]].reshape(-1, 3)
        low, high = points.min(axis=0), points.max(axis=0)
    if min((high - low)[:2]) < STOREY:
        return None
    return round(floor, 4), Bounds(*map(float, (*low[:2], *high[:2])))


def _ground_floor(regions: list[Region]) -> float:
    """Height of the storey with most regions (ties: the lowest); 0 without regions."""
    heights = [region.floor for region in regions]
    if not heights:
        return 0.0
    return min(heights, key=lambda height: (-sum(abs(height - other) < STOREY for other in heights), height))


def _rooms(regions: list[Region], floor: float, report: Report) -> list[Room]:
    """The regions of one storey; small ones first, since a point belongs to the first room."""
    rooms: list[Room] = []
    count: Counter[str] = Counter()
    for region in regions:
        if abs(region.floor - floor) >= STOREY:
            report.left_out.append(f"{region.title}: the region is on another storey")
            continue
        x0, x1, y0, y1 = (round(side, 4) for side in (region.x0, region.x1, -region.z1, -region.z0))
        if min(x1 - x0, y1 - y0) < 0.8:
            report.left_out.append(f"{region.title}: the region is narrower than 0.8 m")
            continue
        kind = slug(region.title.partition("_")[0] or region.title, " ") or "room"
        kind = kind.strip(" 0123456789")[:50].strip() or "room"
        count[kind] += 1
        name = kind if count[kind] == 1 else f"{kind} {count[kind]}"
        loop = [(round(x, 4), round(-z, 4)) for x, _, z in region.poly_loop]
        corners = tidy(loop) if loop else []
        wrong = fault(corners) if corners else ""
        if wrong:
            report.guessed.append(f"{region.title}: its outline {wrong}, so it is the rectangle around it")
        square = wrong or {*corners} <= {(x, y) for x in (x0, x1) for y in (y0, y1)}
        outline = {"x0": x0, "y0": y0, "x1": x1, "y1": y1} if square else {"polygon": corners}
        rooms.append(Room.model_validate({"name": name, "kind": kind, **outline}))
    return sorted(rooms, key=lambda room: room.area)
