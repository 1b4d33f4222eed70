"""Settings, methods, measures of success and statistics. Names load when first used: methods need the graphs."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from evaluation.methods import METHODS
    from evaluation.settings import SETTINGS, schedule
    from evaluation.success import Measure, count, pool

__all__ = ["METHODS", "SETTINGS", "Measure", "count", "pool", "schedule"]

_HOMES = {
    "METHODS": "evaluation.methods",
    "SETTINGS": "evaluation.settings",
    "Measure": "evaluation.success",
    "count": "evaluation.success",
    "pool": "evaluation.success",
    "schedule": "evaluation.settings",
}


def __getattr__(name: str) -> Any:
    """Load a public name on first use."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
