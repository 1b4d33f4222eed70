"""The LangGraph state machines: the person's hour, the robot's hour, the day, the study."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.lazy import lazy_names

if TYPE_CHECKING:
    from graphs.day import build_day_graph, first_day
    from graphs.human import build_human_graph
    from graphs.method import Method
    from graphs.robot import build_robot_graph
    from graphs.services import HumanContext, RobotContext, Services
    from graphs.study import STATE_TYPES, build_study_graph

__all__ = [
    "STATE_TYPES",
    "HumanContext",
    "Method",
    "RobotContext",
    "Services",
    "build_day_graph",
    "build_human_graph",
    "build_robot_graph",
    "build_study_graph",
    "first_day",
]

_HOMES = {
    "STATE_TYPES": "graphs.study",
    "HumanContext": "graphs.services",
    "Method": "graphs.method",
    "RobotContext": "graphs.services",
    "Services": "graphs.services",
    "build_day_graph": "graphs.day",
    "build_human_graph": "graphs.human",
    "build_robot_graph": "graphs.robot",
    "build_study_graph": "graphs.study",
    "first_day": "graphs.day",
}

__getattr__ = lazy_names(__name__, _HOMES)
