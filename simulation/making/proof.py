"""Prove that a home can be lived in: both bodies, with their own skills, take every thing from where it lies."""

from __future__ import annotations

from collections.abc import Iterator

from coopera.core.errors import SimulationError
from coopera.simulation.homes.scene import Scene
from coopera.simulation.ways.home_check import check
from coopera.simulation.world import World


def prove(scene: Scene) -> list[str]:
    """All problems of a home: those that `check` sees in its plan, and each thing that a body cannot walk to and take.

    Needs a few seconds for a large home, since every grasp is planned with the arm kept clear of furniture.
    """
    problems = check(scene)
    seen = {problem.removeprefix("Nobody can reach ").partition(" in the ")[0] for problem in problems}
    try:
        return [*problems, *_not_taken(scene, seen)]
    except SimulationError as err:  # nobody can stand anywhere, as check has said, or there is no room for both
        return problems if str(err) in problems else [*problems, str(err)]


def _not_taken(scene: Scene, seen: set[str]) -> Iterator[str]:
    with World(scene) as world:
        start = world.snapshot()
        for thing in scene.movable:
            for agent in world.state.agents:
                result = world.pick(agent, thing.name)
                world.restore(start)
                if not result.ok and thing.name not in seen:
                    yield f"{thing.name} in the {thing.room}: {result.reason}"
