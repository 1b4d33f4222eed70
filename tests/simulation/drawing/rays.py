"""Rays against the triangles that are drawn, in plain numpy: what a picture must agree with."""

from __future__ import annotations

import numpy as np

from coopera.simulation.drawing.house import WALL_HEIGHT
from coopera.simulation.drawing.lens import Camera
from coopera.simulation.drawing.scenery import BODY_BITS, Scenery
from coopera.simulation.drawing.view import View

_AT_ONCE = 4_000_000


def triangles(scenery: Scenery, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """All triangles (n, 3, 3) before a camera, whatever the room, and their tags (n,)."""
    ahead = np.array(camera.target) - np.array(camera.eye)
    above = camera.eye[2] > WALL_HEIGHT
    corners, tags = [], []
    for batch in (scenery.fixed, scenery.moving()):
        for piece in batch.pieces:
            corner = np.where(ahead > 0, piece.high, piece.low)
            if not (above and piece.above) and float((corner - camera.eye) @ ahead) > 0:
                faces = batch.faces.reshape(-1)[piece.first : piece.first + piece.length].reshape(-1, 3)
                corners.append(batch.vertices["at"][faces])
                tags.append(batch.vertices["tag"][faces[:, 0]])
    return np.concatenate(corners).astype(float), np.concatenate(tags)


def first_hits(eye: np.ndarray, lines: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far along each line (n, 3) the first triangle is, in its lengths, and which; infinite and -1 for none.

    Moeller and Trumbore (1997), from both sides.
    """
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    away, which = np.full(len(lines), np.inf), np.full(len(lines), -1)
    start = eye - a
    across = np.cross(start, ab)
    step = max(_AT_ONCE // len(corners), 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        for i in range(0, len(lines), step):
            some = lines[i : i + step]
            # the determinant and the three coordinates are triple products, of which the lines are a factor each
            scale = 1.0 / (some @ np.cross(ac, ab).T)
            u = (some @ np.cross(ac, start).T) * scale
            v = (some @ across.T) * scale
            along = (across * ac).sum(axis=1) * scale
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (along > 0)
            along = np.where(hit, along, np.inf)
            nearest = along.argmin(axis=1)
            rows = np.arange(len(some))
            away[i : i + step] = along[rows, nearest]
            which[i : i + step] = np.where(np.isfinite(along[rows, nearest]), nearest, -1)
    return away, which


def agreement(view: View, scenery: Scenery, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compare a view with rays through pixels drawn at random.

    Returns:
        By how many metres each depth differs, whether each class is that of the ray, and whether each body is.
    """
    rng = np.random.default_rng(seed)
    height, width = view.depth.shape
    y, x = rng.integers(height, size=count), rng.integers(width, size=count)
    pixels = np.stack((x + 0.5, y + 0.5, np.ones(count)), axis=1)
    lines = pixels @ np.linalg.inv(view.intrinsics).T @ view.extrinsics[:3, :3]
    corners, tags = triangles(scenery, view.camera)
    away, which = first_hits(np.array(view.camera.eye), lines, corners)
    tag = np.where(which >= 0, tags[which], 0)
    depth = view.depth[y, x]
    both = np.isinf(depth) & np.isinf(away)
    with np.errstate(invalid="ignore"):
        off = np.where(both, 0.0, np.abs(depth - away))
    body = (tag & ((1 << BODY_BITS) - 1)) - 1
    return off, view.classes[y, x] == tag >> BODY_BITS, view.instances[y, x] == body
