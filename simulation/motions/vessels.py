"""How a vessel is tipped to pour from it: where it is grasped, how far it is tipped, and where its lip then is.

A vessel's own frame is that of its recipe: base at z = 0, handle towards +x and spout towards -x, if any. Held in the
right hand it has the spout to the left. Lengths are metres.
"""

from __future__ import annotations

import math

import numpy as np

from coopera.simulation.shapes.kit import Size
from coopera.simulation.shapes.rotations import Array

_WIDE = 0.13
"""What is wider than this has a handle and a spout; a narrower thing is a bottle, or a carton."""
_SPOUTED, _BOTTLE = math.radians(58), math.radians(104)
"""How far each is tipped to empty it."""
_BELOW_LIP = 0.1
"""A bottle is grasped this far below its lip."""
OVER = 0.155
"""Height of the lip above the surface on which the vessel stands that one pours into."""


def grasp(size: Size) -> Array:
    """Where a vessel is held, seen from the middle of its base: ahead, to the left, up."""
    width, depth, high = size
    if width > _WIDE:
        return np.array((0.0, -width / 2, 0.55 * high))
    return np.array((-0.02 - 0.3 * depth, 0.0, max(high - _BELOW_LIP, 0.3 * high)))


def tipped(size: Size, share: float) -> Array:
    """The turn of a vessel that is tipped to the left by a share of what empties it, in the body frame."""
    angle = share * (_SPOUTED if size[0] > _WIDE else _BOTTLE)
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array(((1.0, 0.0, 0.0), (0.0, cos, sin), (0.0, -sin, cos)))


def lip(size: Size) -> Array:
    """Where its lip is when it is tipped all the way, seen from the hand."""
    width, _, high = size
    edge = np.array((0.0, width / 2, (0.8 if width > _WIDE else 1.0) * high))
    found: Array = tipped(size, 1.0) @ (edge - grasp(size))
    return found
