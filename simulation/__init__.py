"""The simulated home: homes as data, bodies, motions, acts, cameras and percepts, behind one `World`.

pybullet is imported only by the modules that use it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.simulation.goals.judging import holds, met
    from coopera.simulation.goals.reading import read_goal
    from coopera.simulation.homes.scene import Scene, list_scenes, load_scene
    from coopera.simulation.state.agents import PersonAgent, RobotAgent
    from coopera.simulation.world import World

__all__ = [
    "PersonAgent",
    "RobotAgent",
    "Scene",
    "World",
    "holds",
    "list_scenes",
    "load_scene",
    "met",
    "read_goal",
]

_HOMES = {
    "PersonAgent": "coopera.simulation.state.agents",
    "RobotAgent": "coopera.simulation.state.agents",
    "Scene": "coopera.simulation.homes.scene",
    "list_scenes": "coopera.simulation.homes.scene",
    "load_scene": "coopera.simulation.homes.scene",
    "World": "coopera.simulation.world",
    "holds": "coopera.simulation.goals.judging",
    "met": "coopera.simulation.goals.judging",
    "read_goal": "coopera.simulation.goals.reading",
}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
