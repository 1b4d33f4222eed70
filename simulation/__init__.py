"""The home: scenes, bodies, motions, navigation, skills, cameras. pybullet is imported only where it is used."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

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


def __getattr__(name: str) -> Any:
    """Import a public name's module on first use, so that `import simulation` stays light."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
