"""The skin of a body: a mesh in a rest pose, whose vertices follow the parts of `humanoid.forward`'s frames.

A vertex follows up to four parts, each by a weight: linear blend skinning. The rest pose is given as frames, too; a
part carries a vertex as the part has moved and turned since then. All lengths are metres, all colours from 0 to 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.bodies.humanoid import Frames
from coopera.simulation.people.appearance import Appearance, Outfit
from coopera.simulation.people.assembly import Parts, dressed
from coopera.simulation.people.smplx_model import modelled
from coopera.simulation.people.weights import PARTS

Floats = NDArray[np.float32]

MATERIALS: tuple[str, ...] = ("skin", "hair", "cloth", "shoe", "eye", "glasses")
"""What a vertex may be made of; `Skin.material` counts in this order."""


@dataclass(frozen=True, slots=True, eq=False)
class Skin:
    """A body's mesh at rest, in the frame of the pelvis (x forward, y left, z up); faces run counter-clockwise."""

    vertices: Floats
    """(V, 3)."""
    normals: Floats
    """(V, 3), of length 1."""
    colours: Floats
    """(V, 3), from 0 to 1."""
    material: NDArray[np.uint8]
    """(V,), counting in `MATERIALS`."""
    parts: NDArray[np.uint8]
    """(V, 4), counting in `PARTS`."""
    weights: Floats
    """(V, 4), summing to 1."""
    faces: NDArray[np.uint32]
    """(F, 3), counting the vertices."""
    rest: Frames
    """The frames of the rest pose, with the pelvis at the origin."""


@lru_cache(maxsize=64)
def skinned(appearance: Appearance, outfit: Outfit) -> Skin:
    """The skin of a person in an outfit: made once in a process, in some tenths of a second.

    Raises:
        ConfigError: If the person has a body model, whose file cannot be used.
    """
    clothes = appearance.wears(outfit)
    if appearance.model is None:
        made: Parts = dressed(appearance, clothes)
    else:
        made = modelled(appearance, clothes, appearance.model)
    return Skin(
        vertices=made.vertices.astype(np.float32),
        normals=made.normals.astype(np.float32),
        colours=made.colours.astype(np.float32),
        material=np.array([MATERIALS.index(name) for name in made.materials], dtype=np.uint8)[made.material],
        parts=made.parts,
        weights=made.weights,
        faces=made.faces.astype(np.uint32),
        rest=made.rest,
    )


def carriers(rest: Frames, frames: Frames) -> Floats:
    """What carries a vertex from rest to now, for each of `PARTS`: (16, 3, 4), a turn and then a shift."""
    found = np.empty((len(PARTS), 3, 4), dtype=np.float32)
    for number, part in enumerate(PARTS):
        turn = frames.turn[part] @ rest.turn[part].T
        found[number, :, :3] = turn
        found[number, :, 3] = frames.place[part] - turn @ rest.place[part]
    return found


def posed(skin: Skin, frames: Frames) -> tuple[Floats, Floats]:
    """The vertices (V, 3) and normals (V, 3) of a skin in the frame in which the frames are given."""
    blended = np.einsum("vk,vkij->vij", skin.weights, carriers(skin.rest, frames)[skin.parts], optimize=True)
    vertices = np.einsum("vij,vj->vi", blended[:, :, :3], skin.vertices) + blended[:, :, 3]
    normals = np.einsum("vij,vj->vi", blended[:, :, :3], skin.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-6)
    return vertices.astype(np.float32), normals.astype(np.float32)
