"""Settings, methods, measures of success and statistics. Names load when first used: methods need the graphs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.lazy import lazy_names

if TYPE_CHECKING:
    from evaluation.counts import count, pool
    from evaluation.methods import METHODS, find_method, known_methods, register
    from evaluation.settings import SETTINGS, episode, schedule
    from evaluation.success import Measure

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
    "METHODS": "evaluation.methods",
    "SETTINGS": "evaluation.settings",
    "Measure": "evaluation.success",
    "count": "evaluation.counts",
    "find_method": "evaluation.methods",
    "known_methods": "evaluation.methods",
    "pool": "evaluation.counts",
    "register": "evaluation.methods",
    "episode": "evaluation.settings",
    "schedule": "evaluation.settings",
}

__getattr__ = lazy_names(__name__, _HOMES)
