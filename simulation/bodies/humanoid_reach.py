"""How the person gets a hand to a thing: leaning, stooping and crouching as far as needed."""

from __future__ import annotations

import math

from coopera.simulation.bodies.humanoid import REACH, STANDING, Aim, Side, at_rest, solve
from coopera.simulation.shapes.rotations import Array

_CLOSE = 0.03
"""A hand that gets this near to a thing has it (metres)."""
_STEPS = 12


def reaching(target: Array, *, support: float = 0.0) -> Array | None:
    """Find a standing pose whose right hand is at a point of the body frame; the least stooped one that gets there.

    Args:
        target: The point, in the body frame (metres).
        support: Height of what the person stands on.

    Returns:
        The pose, or None if the point is out of reach.
    """
    side: Side = "right"
    for step in range(_STEPS + 1):
        effort = step / _STEPS
        drop = effort * min(max(1.05 - float(target[2]), 0.0), 0.5)
        aim = Aim(
            pelvis=(-0.16 * effort, 0.0, support + STANDING - 0.01 - drop),
            hips=(52.0 * effort, 0.0, 0.0),
            chest=(8.0 + 26.0 * effort, 12.0 * effort, 0.0),
            neck=(12.0 * (1 - effort), 0.0, 0.0),
            hands={side: target},
            knees=0.1 + 0.3 * effort,
        )
        shoulder = aim.frames().place[f"{side}_shoulder"]
        if math.dist(shoulder, target) <= REACH + _CLOSE:
            return solve(aim)[0]
    return None


def carrying(support: float = 0.0) -> Array:
    """The pose of someone who stands with a thing held in front of them in the right hand."""
    aim = Aim(pelvis=(0.0, 0.0, support + STANDING - 0.01))
    frames = aim.frames()
    aim.hands["right"] = frames.point("chest", 0.34, -0.16, -0.06)
    aim.hands["left"] = at_rest(frames, "left")
    return solve(aim)[0]


def standing() -> Array:
    """The pose of someone who stands with hanging arms."""
    return solve(Aim(pelvis=(0.0, 0.0, STANDING - 0.01)))[0]
