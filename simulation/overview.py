"""A picture of a whole home from above, as of a doll's house: the roof is off and the rooms can be told apart."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from simulation.build import build
from simulation.engine import pybullet
from simulation.scene import Scene

_FOV = 46.0
_LEAN = 0.34
"""How far the camera stands to the south, as a share of its height."""


def overview(scene: Scene, width: int = 960, height: int = 720) -> NDArray[np.uint8]:
    """Render a home in its initial state from above, leaning to the south; colours (height, width, 3)."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        build(scene, client)
        b = scene.bounds
        wide, deep = b.x1 - b.x0, b.y1 - b.y0
        middle = ((b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2, 0.0)
        half = math.tan(math.radians(_FOV / 2))
        high = 2.4 + max((deep + 1.0) / 2 / half, (wide + 1.0) / 2 / half * height / width)
        eye = (middle[0], middle[1] - _LEAN * high, high)
        view = pybullet.computeViewMatrix(eye, middle, (0.0, 1.0, 0.0))
        lens = pybullet.computeProjectionMatrixFOV(_FOV, width / height, 1.0, 4 * high)
        _, _, colours, _, _ = pybullet.getCameraImage(
            width,
            height,
            view,
            lens,
            shadow=0,
            lightDirection=(3.0, -4.0, 10.0),
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=client,
        )
    finally:
        pybullet.disconnect(client)
    return np.asarray(colours, dtype=np.uint8).reshape(height, width, 4)[:, :, :3]
