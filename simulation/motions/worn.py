"""Where a thing is that somebody wears: its place and turn in the body frame."""

from __future__ import annotations

from coopera.simulation.bodies.humanoid import forward
from coopera.simulation.motions.holding import AHEAD
from coopera.simulation.shapes.kit import Size
from coopera.simulation.shapes.rotations import Array

_WORN = {"hat": 0.05, "headphones": -0.06}
"""What is worn on the head, and its base above the head's middle (metres)."""


def worn_at(pose: Array, cls: str, size: Size) -> tuple[Array, Array] | None:
    """Place and turn of a worn thing in the body frame; None for what is not shown on a body: all but hats and such."""
    if cls not in _WORN:
        return None
    frames = forward(pose)
    return frames.point("head", 0.0, 0.0, _WORN[cls]), frames.turn["head"] @ AHEAD
