"""Settings, methods, measures of success and statistics."""

from evaluation.methods import METHODS
from evaluation.settings import SETTINGS, schedule
from evaluation.success import Measure, count, pool

__all__ = ["METHODS", "SETTINGS", "Measure", "count", "pool", "schedule"]
