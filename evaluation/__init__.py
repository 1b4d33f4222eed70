"""Settings, methods, baselines, measures, grids and statistics.

Its names load when first used, since the methods need the graphs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from coopera.core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.evaluation.counts import count, pool
    from coopera.evaluation.measuring import MeasureSpec, find_measure, known_measures, register_measure
    from coopera.evaluation.methods import METHODS, find_method, known_methods, register
    from coopera.evaluation.settings import SETTINGS, episode, schedule
    from coopera.evaluation.success import Measure

__all__ = [
    "METHODS",
    "SETTINGS",
    "Measure",
    "MeasureSpec",
    "count",
    "episode",
    "find_measure",
    "find_method",
    "known_measures",
    "known_methods",
    "pool",
    "register",
    "register_measure",
    "schedule",
]

_HOMES = {
    "METHODS": "coopera.evaluation.methods",
    "SETTINGS": "coopera.evaluation.settings",
    "Measure": "coopera.evaluation.success",
    "MeasureSpec": "coopera.evaluation.measuring",
    "count": "coopera.evaluation.counts",
    "find_measure": "coopera.evaluation.measuring",
    "find_method": "coopera.evaluation.methods",
    "known_measures": "coopera.evaluation.measuring",
    "known_methods": "coopera.evaluation.methods",
    "pool": "coopera.evaluation.counts",
    "register": "coopera.evaluation.methods",
    "register_measure": "coopera.evaluation.measuring",
    "episode": "coopera.evaluation.settings",
    "schedule": "coopera.evaluation.settings",
}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
