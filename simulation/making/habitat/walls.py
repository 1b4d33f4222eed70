"""Find the walls of a home in the mesh of its stage, by cutting it a little above the floor."""

from __future__ import annotations

from typing import Literal

import numpy as np

from coopera.simulation.homes.floorplan import Wall, merge
from coopera.simulation.homes.glb import Array, Mesh

CUT = 0.3
"""Height of the cut above the floor in metres: over skirtings and sills of doors, below those of windows."""
SHORTEST = 0.1
_STRAIGHT = 0.03


def walls_of(mesh: Mesh, floor: float) -> tuple[list[Wall], int]:
    """Return the walls that run along x or y, and how many cuts do not.

    Args:
        mesh: The stage in our frame (Z up).
        floor: Height of the storey in metres.
    """
    lines: dict[tuple[Literal["x", "y"], float], list[tuple[float, float]]] = {}
    slanted = 0
    for a, b in _cuts(mesh, floor + CUT):
        span = np.abs(b - a)
        if span.max() < 1e-3:
            continue
        axis: Literal["x", "y"] = "x" if span[0] > span[1] else "y"
        along, across = (0, 1) if axis == "x" else (1, 0)
        if span[across] > _STRAIGHT * span[along]:
            slanted += 1
            continue
        at = round(float(a[across] + b[across]) / 2, 2)
        lines.setdefault((axis, at), []).append(tuple(sorted((float(a[along]), float(b[along])))))  # type: ignore[arg-type]
    walls = [
        Wall(axis, at, round(start, 3), round(end, 3))
        for (axis, at), spans in sorted(lines.items())
        for start, end in merge(spans)
        if end - start >= SHORTEST
    ]
    return walls, slanted


def _cuts(mesh: Mesh, height: float) -> list[tuple[Array, Array]]:
    """Where triangles meet a level: pairs of points on the floor plan."""
    triangles = mesh.corners[mesh.triangles]
    above = triangles[:, :, 2] > height
    crossing = above.any(axis=1) & ~above.all(axis=1)
    cuts = []
    for corners, over in zip(triangles[crossing], above[crossing], strict=True):
        alone = int(np.flatnonzero(over == (over.sum() == 1))[0])
        ends = []
        for other in ((alone + 1) % 3, (alone + 2) % 3):
            p, q = corners[alone], corners[other]
            share = (height - p[2]) / (q[2] - p[2])
            ends.append(p[:2] + share * (q[:2] - p[:2]))
        cuts.append((ends[0], ends[1]))
    return cuts
