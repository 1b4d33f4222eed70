"""The home: scenes, bodies, motions, navigation, skills, cameras. pybullet is imported only where it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.lazy import lazy_names

if TYPE_CHECKING:
    from simulation.scene import Scene, list_scenes, load_scene
    from simulation.world import World

__all__ = ["Scene", "World", "list_scenes", "load_scene"]

_HOMES = {
    "Scene": "simulation.scene",
    "list_scenes": "simulation.scene",
    "load_scene": "simulation.scene",
    "World": "simulation.world",
}

__getattr__ = lazy_names(__name__, _HOMES)
