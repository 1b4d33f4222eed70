"""Where a thing is that somebody wears, or puts on: its place and turn in the body frame."""

from __future__ import annotations

import numpy as np

from coopera.simulation.bodies.humanoid import ANKLE, Frames, forward
from coopera.simulation.motions.library import Hold
from coopera.simulation.shapes.kit import Size
from coopera.simulation.shapes.rotations import Array

_WORN = {"hat": 0.05, "headphones": -0.06}
"""What is worn on the head, and its base above the head's middle (metres)."""
FLAT = 0.1
"""What is no higher than this is flat, such as a towel or a cloth."""
_WAIST = -0.28
"""The lower hem of what is on the torso, from the chest's middle."""
_TOES = 0.05
"""The middle of a foot is this far ahead of its ankle."""
AHEAD = np.array(((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
"""A thing whose front looks away from the body."""
_BEHIND = np.array(((0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
"""A flat thing upright behind the head."""


def worn_at(pose: Array, cls: str, size: Size) -> tuple[Array, Array] | None:
    """Place and turn of a worn thing in the body frame; None for what is not shown on a body: all but hats and such."""
    if cls not in _WORN:
        return None
    frames = forward(pose)
    return frames.point("head", 0.0, 0.0, _WORN[cls]), frames.turn["head"] @ AHEAD


def on_body(frames: Frames, hold: Hold, size: Size) -> tuple[Array, Array] | None:
    """The same of what is on the head, the torso or the feet while a motion is done; None for what is held otherwise.

    On the head are headphones, or a flat thing behind it, such as a towel.
    """
    if hold == "head" and size[2] < FLAT:
        return frames.point("head", -0.08, 0.0, 0.05), frames.turn["head"] @ _BEHIND
    if hold == "head":
        return frames.point("head", 0.0, 0.0, 0.11 - 0.5 * size[2]), frames.turn["head"] @ AHEAD
    if hold == "torso":
        return frames.point("chest", 0.0, 0.0, _WAIST), frames.turn["chest"] @ AHEAD
    if hold == "feet":
        ankles = (frames.place["right_ankle"] + frames.place["left_ankle"]) / 2
        return ankles + np.array((_TOES, 0.0, -ANKLE)), AHEAD
    return None
