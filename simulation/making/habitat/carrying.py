"""What carries the movable things of a foreign home, whose files say only where each of them is."""

from __future__ import annotations

from coopera.simulation.homes.catalogue import Surface, surfaces
from coopera.simulation.homes.scene import SceneObject

ON_FLOOR = 0.06
"""What begins no higher than this above the floor stands on it (metres)."""
_NEAR = 0.03
_EXACT = 0.002
_EDGE = 0.05
_MOVED = 0.25
"""No thing is moved farther than this to lie on something (metres)."""


def put_on(thing: SceneObject, carriers: list[SceneObject]) -> SceneObject | None:
    """A thing where something carries it, as near as may be to where the file puts it; None where nothing does.

    What is measured on meshes is exact and files are not: a thing may be sunk into its shelf, or hover above it.
    """
    if thing.position[2] <= ON_FLOOR:
        return thing
    found: list[tuple[float, int, SceneObject, tuple[float, float, float]]] = []
    for carrier in carriers:
        x, y = carrier.to_local(*thing.xy)
        if abs(x) > carrier.size[0] / 2 + _EDGE or abs(y) > carrier.size[1] / 2 + _EDGE:
            continue
        for surface in surfaces(carrier):
            aside, place = _onto(surface, x, y)
            lifted = carrier.position[2] + surface.z - thing.position[2]
            if (aside <= _EDGE and abs(lifted) <= _MOVED) or (abs(lifted) <= _NEAR and aside <= _MOVED):
                there = carrier.to_world(*place, surface.z)
                found.append((abs(lifted) + aside, carrier.id, carrier, there))
    if not found:
        return None
    _, _, carrier, there = min(found, key=lambda row: row[:2])
    x, y, z = (round(part, 4) for part in there)
    if abs(z - thing.position[2]) <= _EXACT:
        z = thing.position[2]
    if abs(x - thing.xy[0]) + abs(y - thing.xy[1]) <= _EXACT:
        x, y = thing.xy
    return thing.model_copy(update={"on": carrier.name, "room": carrier.room, "position": (x, y, z)})


def _onto(surface: Surface, x: float, y: float) -> tuple[float, tuple[float, float]]:
    """How far a point of the carrier's frame is beside a surface, and the nearest point on it."""
    there = min(max(x, surface.x0), surface.x1), min(max(y, surface.y0), surface.y1)
    return max(abs(there[0] - x), abs(there[1] - y)), there
