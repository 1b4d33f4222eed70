"""Whether an arm has room: its points against the parts of furniture and the walls."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.homes.catalogue import solids
from coopera.simulation.homes.scene import Scene, SceneObject
from coopera.simulation.shapes.rotations import Array

_THICK = 0.045
"""Half the thickness of an arm, in metres."""
_FINGERS = 0.015
_HAND = 0.16
"""Points this near to the grasped point belong to the hand, which touches what the thing stands on."""
_WALL = 2.4
_SLACK = 1e-6


class Elbowroom:
    """The solid parts of a home's furniture, as boxes turned about z, and its walls; small things yield."""

    def __init__(self, scene: Scene) -> None:
        """Gather the parts: about 20 ms for a home of 140 pieces."""
        self.names: list[str] = []
        rows: list[tuple[float, ...]] = []
        for thing in scene.fixed:
            for solid in solids(thing):
                self.names.append(thing.name)
                rows.append((*thing.to_world(*solid.middle), *solid.half, thing.yaw))
        for wall in scene.walls():
            x, y, half_x, half_y, yaw = wall.block
            self.names.append("wall")
            rows.append((x, y, _WALL / 2, half_x, half_y, _WALL / 2, yaw))
        self._boxes = np.array(rows).reshape(-1, 7)
        self._round = np.hypot(self._boxes[:, 3], self._boxes[:, 4]) + _THICK + _SLACK

    def hit(self, arm: Array, grasp: Array, on: SceneObject | None) -> str | None:
        """Name what an arm would run into, "wall" for a wall; None where it has room.

        Args:
            arm: Points along it, in the world; shape (n, 3).
            grasp: Where the hand is.
            on: The furniture that the hand reaches onto. One with a closed front (its parts fill the place itself,
                as in a fridge) is taken to be open.
        """
        near = self._near(arm, grasp)
        boxes = self._boxes[near]
        hand = np.linalg.norm(arm - grasp, axis=1) < _HAND
        inside = _inside(arm, boxes, np.where(hand, _FINGERS, _THICK)[:, None])
        own = np.array([on is not None and self.names[i] == on.name for i in near], dtype=bool)
        if own.any():
            inside[np.ix_(hand, own)] = False
            if _inside(grasp[None], boxes[own], np.zeros((1, 1))).any():
                inside[:, own] = False
        found = np.flatnonzero(inside.any(axis=0))
        return self.names[near[found[0]]] if len(found) else None

    def _near(self, arm: Array, grasp: Array) -> NDArray[np.int64]:
        """Which parts have any chance of being touched: those around which a circle meets the arm's rectangle."""
        low, high = np.minimum(arm.min(axis=0), grasp), np.maximum(arm.max(axis=0), grasp)
        x, y = self._boxes[:, 0], self._boxes[:, 1]
        away_x, away_y = np.maximum(low[0] - x, x - high[0]), np.maximum(low[1] - y, y - high[1])
        within_reach = np.hypot(x - arm[0, 0], y - arm[0, 1]) < 3.0
        return np.flatnonzero((np.maximum(away_x, away_y) < self._round) & within_reach)


def _inside(points: Array, boxes: Array, margin: Array) -> NDArray[np.bool_]:
    """Which points lie in which boxes grown by each point's margin; shapes (n, 3), (m, 7) and (n, 1) to (n, m)."""
    cos, sin = np.cos(boxes[:, 6]), np.sin(boxes[:, 6])
    dx, dy = points[:, :1] - boxes[:, 0], points[:, 1:2] - boxes[:, 1]
    within = np.abs(dx * cos + dy * sin) < boxes[:, 3] + margin
    within &= np.abs(dy * cos - dx * sin) < boxes[:, 4] + margin
    within &= np.abs(points[:, 2:] - boxes[:, 2]) < boxes[:, 5] + margin
    return np.asarray(within)
