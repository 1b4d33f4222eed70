"""Recognises a motion from joints alone: the library's poses are compared with those seen, in their order in time.

The input is joint positions, as a 3D pose estimator gives them: some joints are hidden, all are noisy, and the body's
place and heading are unknown. So two poses are compared by their distance after the best shift along the floor and the
best turn about the vertical (Procrustes analysis without scale). A motion explains the instants if its poses follow
each other at its own pace, from any phase. A walking pose may explain an instant instead, since people walk to what
they do. The played motion is not an argument.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coopera.core.lazy import made_once
from coopera.simulation.bodies.humanoid import blend, forward
from coopera.simulation.bodies.humanoid_reach import carrying, reaching, standing
from coopera.simulation.motions.library import Library, Motion
from coopera.simulation.motions.poses import Setting, clip, pose_at
from coopera.simulation.shapes.rotations import Array
from coopera.simulation.sight.walks import walking

PARTS = (
    "head",
    *(f"{side}_{part}" for part in ("shoulder", "elbow", "hand", "hip", "knee", "ankle") for side in ("right", "left")),
)
"""The joints of a skeleton, in order: 13."""
HANDS = [PARTS.index("right_hand"), PARTS.index("left_hand")]
FEWEST = 4
"""An instant at which fewer joints are seen tells nothing."""
TIDYING = "put things away on a shelf"
"""What taking and putting things is recognised as."""
_TOLD = 0.15
"""Share of what walking leaves unexplained that a motion must explain (of the mean square distance)."""
_SOLVED, _STEPS = 8, 16
_WORKTOPS = {"stand": (0.6, 0.8, 1.0), "sit": (None, 0.75)}
_SUPPORTS = {"sit": (0.45,), "lie": (0.5, 0.0)}
_TARGETS = ((0.5, 0.1), (0.5, 0.45), (0.55, 0.75), (0.6, 0.95), (0.5, 1.2), (0.45, 1.5))


class Take(NamedTuple):
    """A motion in one setting: its skeletons, evenly spread over a period of seconds; period 0: in any order."""

    motion: Motion
    skeletons: Array
    period: float


def skeleton(pose: Array) -> Array:
    """Where a pose's joints are, in the body frame; shape (13, 3), metres."""
    places = forward(pose).place
    return np.array([places[part] for part in PARTS])


class PoseMatcher:
    """The poses of a library, computed once (a second or so), and what they are compared by."""

    def __init__(self, library: Library) -> None:
        takes = [take for motion in library.motions for take in _takes(motion)]
        if TIDYING in library:
            takes.append(Take(library[TIDYING], _reaches(), 0.0))
        self._come = _coming()
        self._takes = takes
        self._skeletons = np.concatenate([take.skeletons for take in takes])
        sizes = np.array([len(take.skeletons) for take in takes])
        self._take = np.repeat(np.arange(len(takes)), sizes)
        self._start = np.repeat(np.cumsum(sizes) - sizes, sizes)
        self._size = np.repeat(sizes, sizes)
        self._pace = np.repeat([len(t.skeletons) / t.period if t.period else 0.0 for t in takes], sizes)

    def match(self, joints: Array, seconds: Array) -> Motion | None:
        """Name the motion that explains some instants best; ties go to the first of the library.

        Args:
            joints: Shape (n, 13, 3), metres, z above the floor; joints that are not seen are NaN.
            seconds: When the instants are; shape (n,), rising.

        Returns:
            None if too little of the body is seen, or nothing of it but coming and going.
        """
        enough = np.isfinite(joints).all(axis=2).sum(axis=1) >= FEWEST
        if not enough.any():
            return None
        joints, seconds = joints[enough], seconds[enough]
        coming = distances(joints, self._come).min(axis=1)
        found = distances(joints, self._skeletons)
        for index, take in enumerate(self._takes):
            if not take.period:
                rows = self._take == index
                found[:, rows] = found[:, rows].min(axis=1, keepdims=True)
        steps = np.rint((seconds - seconds[0])[:, None] * self._pace).astype(np.int64)
        rows = np.arange(len(self._start)) - self._start
        there = self._start + (rows + steps) % self._size
        cost = np.minimum(np.take_along_axis(found, there, axis=1), coming[:, None]).mean(axis=0)
        best = int(np.argmin(np.round(cost, 7)))
        if cost[best] > (1 - _TOLD) * coming.mean():
            return None
        return self._takes[int(self._take[best])].motion


@made_once()
def matcher(library: Library) -> PoseMatcher:
    """The matcher of a library, made once."""
    return PoseMatcher(library)


def distances(joints: Array, skeletons: Array) -> Array:
    """Mean square distance of seen joints after the best shift along the floor and the best turn about the vertical.

    Args:
        joints: Shape (n, j, 3); joints that are not seen are NaN.
        skeletons: Shape (m, j, 3).

    Returns:
        Shape (n, m), square metres.
    """
    seen = np.isfinite(joints).all(axis=2)
    mask = seen.astype(np.float64)
    count = mask.sum(axis=1, keepdims=True)
    x, y, z = (np.where(seen, joints[:, :, axis], 0.0) for axis in range(3))
    x, y = (np.where(seen, flat - flat.sum(axis=1, keepdims=True) / count, 0.0) for flat in (x, y))
    qx, qy, qz = (skeletons[:, :, axis].T for axis in range(3))
    spread = mask @ (skeletons**2).sum(axis=2).T - ((mask @ qx) ** 2 + (mask @ qy) ** 2) / count
    own = (x**2 + y**2 + z**2).sum(axis=1, keepdims=True)
    fit = z @ qz + np.hypot(x @ qx + y @ qy, y @ qx - x @ qy)
    return np.asarray(np.maximum(own + spread - 2 * fit, 0.0) / count)


def _takes(motion: Motion) -> list[Take]:
    """A motion in each setting in which it looks different."""
    keys = motion.keys
    if keys.clip is not None:
        recorded = clip(keys.clip)
        steps = min(max(round(recorded.seconds / 0.1), _STEPS), 4 * _STEPS)
        moments = np.arange(steps) * recorded.seconds / steps
        return [Take(motion, np.array([skeleton(recorded.at(float(t))) for t in moments]), recorded.seconds)]
    works = any(path is not None and "surface" in path.frames for path in (keys.right, keys.left))
    heights = _WORKTOPS.get(motion.posture, (None,)) if works else (None,)
    supports = _SUPPORTS.get(motion.posture, (0.0,))
    settings = [Setting(support, height, motion.posture) for support in supports for height in heights]
    if motion.posture == "sit":
        settings.append(Setting(0.0, None, "stand"))  # where there is no seat
    found = []
    for setting in settings:
        moments = np.arange(_SOLVED) * keys.period / _SOLVED
        solved = np.array([skeleton(pose_at(motion, float(t), setting)) for t in moments])
        between = (solved + np.roll(solved, -1, axis=0)) / 2
        found.append(Take(motion, np.stack((solved, between), axis=1).reshape(_STEPS, *solved.shape[1:]), keys.period))
    return found


def _coming() -> Array:
    """Skeletons of somebody who walks or has just come, with free hands or with something in one."""
    strides = np.linspace(0.0, clip("walk").travel, _STEPS, endpoint=False)
    poses = [walking(float(gone), carries) for carries in (False, True) for gone in strides]
    return np.array([skeleton(pose) for pose in (*poses, standing(), carrying())])


def _reaches() -> Array:
    """Skeletons of somebody who bends to a thing on the floor, on a table, on a shelf."""
    found = []
    for ahead, height in _TARGETS:
        bent = reaching(np.array((ahead, -0.1, height)))
        if bent is not None:
            found += [skeleton(bent), skeleton(blend(standing(), bent, 0.5))]
    return np.array(found)
