"""The skin of a body: a mesh in a rest pose, whose vertices follow the parts of `humanoid.forward`'s frames.

A vertex follows up to four parts, each by a weight: linear blend skinning. The rest pose is given as frames, too; a
part carries a vertex as the part has moved and turned since then. All lengths are metres, all colours from 0 to 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.bodies.appearance import Appearance, Outfit
from coopera.simulation.bodies.humanoid import SIDES, SIZE, SLICES, Frames, forward

Floats = NDArray[np.float32]

PARTS: tuple[str, ...] = (
    "pelvis",
    "chest",
    "neck",
    "head",
    *(f"{side}_{part}" for side in SIDES for part in ("shoulder", "elbow", "hand", "hip", "knee", "ankle")),
)
"""The parts that a vertex may follow, by the names of `humanoid.forward`'s frames; `Skin.parts` counts in this order."""
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


def carriers(rest: Frames, frames: Frames) -> Floats:
    """What carries a vertex from rest to now, for each of `PARTS`: (16, 3, 4), a turn and then a shift."""
    found = np.empty((len(PARTS), 3, 4), dtype=np.float32)
    for number, part in enumerate(PARTS):
        turn = _turn(frames, part) @ _turn(rest, part).T
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


def _turn(frames: Frames, part: str) -> NDArray[np.float64]:
    return frames.turn[part]


_CHAINS = (
    ("pelvis", "chest", 0.16),
    ("chest", "neck", 0.15),
    ("neck", "head", 0.06),
    ("head", None, 0.1),
    *((f"{side}_{a}", f"{side}_{b}" if b else None, r) for side in ("right", "left") for a, b, r in (
        ("shoulder", "elbow", 0.05), ("elbow", "hand", 0.04), ("hand", None, 0.05),
        ("hip", "knee", 0.08), ("knee", "ankle", 0.06), ("ankle", None, 0.06))),
)  # fmt: skip


@lru_cache(maxsize=64)
def skinned(appearance: Appearance, outfit: Outfit) -> Skin:
    """The skin of a person in an outfit: made once in a process."""
    pose = np.zeros(SIZE)
    for where in SLICES.values():
        if where.stop - where.start == 4:
            pose[where] = (0.0, 0.0, 0.0, 1.0)
    rest = forward(pose)
    longs, rounds = np.meshgrid(np.linspace(0, np.pi, 9), np.linspace(0, 2 * np.pi, 12, endpoint=False), indexing="ij")
    ball = np.stack((np.sin(longs) * np.cos(rounds), np.sin(longs) * np.sin(rounds), np.cos(longs)), -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(8), np.arange(12), indexing="ij")
    a, b, c, d = (i * 12 + j, (i + 1) * 12 + j, (i + 1) * 12 + (j + 1) % 12, i * 12 + (j + 1) % 12)
    quad = np.stack((a, b, c, a, c, d), -1).reshape(-1, 3)
    found: list[list[np.ndarray]] = [[], [], [], [], []]
    for k, (part, to, radius) in enumerate(_CHAINS):
        start = rest.place[part]
        end = start if to is None else rest.place[to]
        middle, half = (start + end) / 2, np.linalg.norm(end - start) / 2 + radius * 0.7
        vertices = ball * (radius, radius, half) + middle
        colour = (
            appearance.skin
            if part in ("head", "neck") or part.endswith("hand")
            else (appearance.bottom if part.endswith(("hip", "knee", "pelvis")) else appearance.top)
        )
        for group, values in zip(
            found,
            (
                vertices,
                ball,
                np.tile(colour, (len(ball), 1)),
                np.full(len(ball), PARTS.index(part)),
                quad + k * len(ball),
            ),
            strict=True,
        ):
            group.append(values)
    vertices, normals, colours, parts, faces = (np.concatenate(group) for group in found)
    weights = np.zeros((len(vertices), 4), dtype=np.float32)
    weights[:, 0] = 1.0
    return Skin(
        vertices.astype(np.float32),
        normals.astype(np.float32),
        colours.astype(np.float32),
        np.full(len(vertices), MATERIALS.index("cloth"), dtype=np.uint8),
        np.repeat(parts[:, None], 4, axis=1).astype(np.uint8),
        weights,
        faces.astype(np.uint32),
        rest,
    )
