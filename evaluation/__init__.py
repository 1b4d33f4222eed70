"""Settings, methods, baselines, measures, grids and statistics.

Its names load when first used, since the methods need the graphs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.evaluation.counts import count, pool
    from coopera.evaluation.methods import METHODS, find_method, known_methods, register
    from coopera.evaluation.settings import SETTINGS, episode, schedule
    from coopera.evaluation.success import Measure

__all__ = [
    "METHODS",
    "SETTINGS",
    "Measure",
    "count",
    "episode",
    "find_method",
    "known_methods",
    "pool",
    "register",
    "schedule",
]

_HOMES = {
    "METHODS": "coopera.evaluation.methods",
    "SETTINGS": "coopera.evaluation.settings",
    "Measure": "coopera.evaluation.success",
    "count": "coopera.evaluation.counts",
    "find_method": "coopera.evaluation.methods",
    "known_methods": "coopera.evaluation.methods",
    "pool": "coopera.evaluation.counts",
    "register": "coopera.evaluation.methods",
    "episode": "coopera.evaluation.settings",
    "schedule": "coopera.evaluation.settings",
}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
