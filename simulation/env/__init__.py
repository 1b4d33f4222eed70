"""A home with a person who lives in it, as an environment for learners: Gymnasium's and PettingZoo's interfaces.

`HomeEnv` lets a learner be the robot; in `HomeParallelEnv` another one is the person. Both need the extra `gym`. What
the person does of each hour is a `Life`: planned by hand, or lived by coopera's own people (`coopera.make_env`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.simulation.env.gym import HomeEnv
    from coopera.simulation.env.life import Life, Planned
    from coopera.simulation.env.parallel import HomeParallelEnv

__all__ = ["HomeEnv", "HomeParallelEnv", "Life", "Planned"]

_ROOMS = {
    "HomeEnv": "coopera.simulation.env.gym",
    "HomeParallelEnv": "coopera.simulation.env.parallel",
    "Life": "coopera.simulation.env.life",
    "Planned": "coopera.simulation.env.life",
}

__getattr__, __dir__ = lazy_names(__name__, _ROOMS)
