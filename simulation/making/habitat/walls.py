"""Find the walls of a home in the mesh of its stage, by cutting it a little above the floor."""

from __future__ import annotations

import numpy as np

from coopera.simulation.homes.floorplan import Line, Wall, merge, wall_between, wall_on
from coopera.simulation.homes.glb import Array, Mesh

CUT = 0.3
"""Height of the cut above the floor in metres: over skirtings and sills of doors, below those of windows."""
SHORTEST = 0.1
_STRAIGHT = 0.03


def walls_of(mesh: Mesh, floor: float) -> list[Wall]:
    """Return the walls of a stage; pieces of one line that meet are one wall.

    Args:
        mesh: The stage in our frame (Z up).
        floor: Height of the storey in metres.
    """
    lines: dict[Line, list[tuple[float, float]]] = {}
    for a, b in _cuts(mesh, floor + CUT):
        if np.abs(b - a).max() < 1e-3:
            continue
        wall = wall_between((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))
        line = wall.line
        if abs(line.slope) <= _STRAIGHT:
            line = Line(wall.axis, wall.at + wall.rise / 2)
        lines.setdefault(Line(line.axis, round(line.at, 2), round(line.slope, 3)), []).append((wall.start, wall.end))
    return [
        wall_on(line, round(start, 3), round(end, 3))
        for line, spans in sorted(lines.items())
        for start, end in merge(spans)
        if end - start >= SHORTEST
    ]


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
