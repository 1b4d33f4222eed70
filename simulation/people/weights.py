"""Which parts of the body carry a point of its skin: shares that change smoothly across each joint."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.bodies.humanoid import SHIN, SIDES, THIGH, UPPER_ARM
from coopera.simulation.people.fields import Array
from coopera.simulation.people.figure import Near

PARTS: tuple[str, ...] = (
    "pelvis",
    "chest",
    "neck",
    "head",
    *(f"{side}_{part}" for side in SIDES for part in ("shoulder", "elbow", "hand", "hip", "knee", "ankle")),
)
"""The parts that a vertex may follow, named as in `humanoid.forward`'s frames; `Skin.parts` counts in this order."""


def ramp(values: Array, low: float, high: float) -> Array:
    """From 0 at `low` to 1 at `high`, flat at both ends."""
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    found: Array = share * share * (3 - 2 * share)
    return found


def shares(near: Near, between: float = 0.02) -> Array:
    """The share of each of `PARTS` in points (N, 16); `between` is how widely the legs are blended (metres)."""
    found = np.zeros((len(near.points), len(PARTS)))
    trunk = near.trunk
    free = np.ones(len(near.points))
    for side in SIDES:
        sign = 1.0 if side == "left" else -1.0
        arm = np.minimum(near.limb(side, "shoulder"), near.limb(side, "elbow"))
        along = -near.local(f"{side}_shoulder")[:, 2]
        of_arm = ramp(along, -0.035, 0.095) * ramp(trunk - arm, -0.045, 0.03) * (near.points[:, 1] * sign > 0)
        bent = ramp((along - UPPER_ARM - near.local(f"{side}_elbow")[:, 2]) / 2, -0.045, 0.045)
        _give(found, f"{side}_shoulder", of_arm * (1 - bent))
        _give(found, f"{side}_elbow", of_arm * bent)
        along = -near.local(f"{side}_hip")[:, 2]
        own = ramp(near.points[:, 1] * sign, -between, between)
        of_leg = ramp(along, -0.035, 0.105) * own * (1 - of_arm)
        below = -near.local(f"{side}_knee")[:, 2]
        bent = ramp((along - THIGH + below) / 2, -0.055, 0.055)
        foot = ramp(below - SHIN, -0.045, 0.010)
        _give(found, f"{side}_hip", of_leg * (1 - bent))
        _give(found, f"{side}_knee", of_leg * bent * (1 - foot))
        _give(found, f"{side}_ankle", of_leg * bent * foot)
        free = free - of_arm - of_leg
    free = np.maximum(free, 0.0)
    local = near.local("neck")
    wide = np.sqrt(local[:, 0] ** 2 + local[:, 1] ** 2)
    neck = ramp(local[:, 2], -0.015, 0.075) * (1 - ramp(wide, 0.07, 0.12))
    chest = ramp(near.points[:, 2], 0.12, 0.35)
    _give(found, "neck", free * neck)
    _give(found, "chest", free * (1 - neck) * chest)
    _give(found, "pelvis", free * (1 - neck) * (1 - chest))
    return found


def _give(found: Array, part: str, share: Array) -> None:
    found[:, PARTS.index(part)] += share


def strongest(found: Array) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """The four parts with the largest shares (N, 4), and their weights (N, 4), which sum to 1."""
    order = np.argsort(-found, axis=1, kind="stable")[:, :4]
    weights = np.take_along_axis(found, order, axis=1)
    weights /= weights.sum(axis=1, keepdims=True)
    return order.astype(np.uint8), weights.astype(np.float32)
